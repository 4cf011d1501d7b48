// SPDX-License-Identifier: MIT
// Which backend is chosen and what is refused, each with one sentence that helps.
#include <epoxy/egl.h>

#include <algorithm>

#include "interop_fixture.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

class BridgeSettingsTest : public InteropTest {
 protected:
  Status refusal(const BridgeSettings& settings) {
    auto bridge = Bridge::create(*context_, *device_, settings);
    EXPECT_FALSE(bridge.ok());
    return bridge.status();
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(BridgeSettingsTest, EveryBadFieldIsNamed) {
  const Status status = refusal({.target = {0, 16}, .output = {16, -2}, .slots = 1});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(contains(status.message(), "target is 0x16")) << status.message();
  EXPECT_TRUE(contains(status.message(), "output is 16x-2")) << status.message();
  EXPECT_TRUE(contains(status.message(), "slots is 1")) << status.message();
  EXPECT_EQ(std::count(status.message().begin(), status.message().end(), '\n'), 0);
}

TEST_F(BridgeSettingsTest, EachBadFieldAloneIsRefused) {
  EXPECT_FALSE(contains(refusal({.target = {1 << 20, 16}, .output = {16, 16}}).message(), "output"));
  EXPECT_FALSE(contains(refusal({.target = {16, 16}, .output = {16, 1 << 20}}).message(), "target"));
  EXPECT_TRUE(
      contains(refusal({.target = {16, 16}, .output = {16, 16}, .slots = 17}).message(), "slots is 17"));
  EXPECT_TRUE(
      contains(refusal({.target = {16, 16}, .output = {16, 16}, .colour = PixelFormat::kRGBA32F}).message(),
               "colour is RGBA32F and must be RGBA8 or RGBA16F"));
}

TEST_F(BridgeSettingsTest, AContextThatIsNotCurrentIsRefused) {
  ASSERT_EQ(eglMakeCurrent(context_->display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT),
            EGLBoolean{EGL_TRUE});
  const Status status = refusal({.target = {16, 16}, .output = {16, 16}});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(contains(status.message(), "make_current()")) << status.message();
  ASSERT_TRUE(context_->make_current().ok());
}

TEST_F(BridgeSettingsTest, CopyIsTakenWhereItIsAskedFor) {
  auto bridge = Bridge::create(*context_, *device_,
                               {.interop = Interop::kCopy, .target = {16, 16}, .output = {16, 16}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kCopy);
  EXPECT_EQ(bridge.value()->storage(), Storage::kBuffer);
  EXPECT_EQ(bridge.value()->reason(), "copying was asked for");
}

TEST_F(BridgeSettingsTest, GlIsRefusedWhereTheDeviceDoesNotShare) {
  if (device_->info().gl_sharing) QUINCUNX_SKIP("this device shares with OpenGL");
  const Status status = refusal({.interop = Interop::kGl, .target = {16, 16}, .output = {16, 16}});
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_TRUE(contains(status.message(), device_->info().name)) << status.message();
  EXPECT_TRUE(contains(status.message(), "cl_khr_gl_sharing")) << status.message();
  EXPECT_TRUE(contains(status.message(), "use 'copy' or 'auto'")) << status.message();
}

TEST_F(BridgeSettingsTest, AutoFallsBackAndSaysWhy) {
  if (device_->info().gl_sharing) QUINCUNX_SKIP("this device shares with OpenGL");
  auto bridge = Bridge::create(*context_, *device_, {.target = {16, 16}, .output = {16, 16}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kCopy);
  EXPECT_TRUE(contains(bridge.value()->reason(), "cl_khr_gl_sharing")) << bridge.value()->reason();
}

TEST_F(BridgeSettingsTest, OpenDeviceInsistsOnGlOrFallsBack) {
  if (device_->info().gl_sharing) QUINCUNX_SKIP("this device shares with OpenGL");
  for (const char* selector : {"", "cpu"}) {
    const auto gl = open_device(*context_, selector, Interop::kGl);
    ASSERT_FALSE(gl.ok());
    EXPECT_EQ(gl.status().code(), StatusCode::kUnsupported);
    EXPECT_TRUE(contains(gl.status().message(), "cl_khr_gl_sharing")) << gl.status().message();
    const auto any = open_device(*context_, selector, Interop::kAuto);
    ASSERT_TRUE(any.ok()) << any.status().message();
    EXPECT_EQ(any->info().name, device_->info().name);
  }
  for (const Interop interop : {Interop::kAuto, Interop::kGl, Interop::kCopy}) {
    EXPECT_EQ(open_device(*context_, "no such device", interop).status().code(),
              StatusCode::kInvalidArgument);
  }
}

TEST(InteropName, IsTheOptionsWord) {
  EXPECT_STREQ(name_of(Interop::kAuto), "auto");
  EXPECT_STREQ(name_of(Interop::kGl), "gl");
  EXPECT_STREQ(name_of(Interop::kCopy), "copy");
}

}  // namespace
}  // namespace quincunx::gl::testing
