// SPDX-License-Identifier: MIT
// The bridge: which backend is chosen and what is refused, each with one sentence that helps; the picture that it
// brings back; and that a steady frame makes nothing new.
#include <epoxy/egl.h>

#include <algorithm>
#include <cstring>

#include "cl_interposer.h"
#include "gl_call_counter.h"
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
  const Status status = refusal({.target_extent = {0, 16}, .output_extent = {16, -2}, .slots = 1});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(contains(status.message(), "target_extent is 0x16")) << status.message();
  EXPECT_TRUE(contains(status.message(), "output_extent is 16x-2")) << status.message();
  EXPECT_TRUE(contains(status.message(), "slots is 1")) << status.message();
  EXPECT_EQ(std::count(status.message().begin(), status.message().end(), '\n'), 0);
}

TEST_F(BridgeSettingsTest, EachBadFieldAloneIsRefused) {
  EXPECT_FALSE(
      contains(refusal({.target_extent = {1 << 20, 16}, .output_extent = {16, 16}}).message(), "output"));
  EXPECT_FALSE(
      contains(refusal({.target_extent = {16, 16}, .output_extent = {16, 1 << 20}}).message(), "target"));
  EXPECT_TRUE(contains(refusal({.target_extent = {16, 16}, .output_extent = {16, 16}, .slots = 17}).message(),
                       "slots is 17"));
  EXPECT_TRUE(contains(
      refusal({.target_extent = {16, 16}, .output_extent = {16, 16}, .colour = PixelFormat::kRGBA32F})
          .message(),
      "colour is RGBA32F and must be RGBA8 or RGBA16F"));
}

TEST_F(BridgeSettingsTest, AContextThatIsNotCurrentIsRefused) {
  ASSERT_EQ(eglMakeCurrent(context_->display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT),
            EGLBoolean{EGL_TRUE});
  const Status status = refusal({.target_extent = {16, 16}, .output_extent = {16, 16}});
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(contains(status.message(), "make_current()")) << status.message();
  ASSERT_TRUE(context_->make_current().ok());
}

TEST_F(BridgeSettingsTest, CopyIsTakenWhereItIsAskedFor) {
  auto bridge = Bridge::create(
      *context_, *device_, {.interop = Interop::kCopy, .target_extent = {16, 16}, .output_extent = {16, 16}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kCopy);
  EXPECT_EQ(bridge.value()->storage(), Storage::kBuffer);
  EXPECT_EQ(bridge.value()->reason(), "copying was asked for");
}

TEST_F(BridgeSettingsTest, GlIsRefusedWhereTheDeviceDoesNotShare) {
  if (device_->info().gl_sharing) QUINCUNX_SKIP("this device shares with OpenGL");
  const Status status =
      refusal({.interop = Interop::kGl, .target_extent = {16, 16}, .output_extent = {16, 16}});
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_TRUE(contains(status.message(), device_->info().name)) << status.message();
  EXPECT_TRUE(contains(status.message(), "cl_khr_gl_sharing")) << status.message();
  EXPECT_TRUE(contains(status.message(), "use 'copy' or 'auto'")) << status.message();
}

TEST_F(BridgeSettingsTest, AutoFallsBackAndSaysWhy) {
  if (device_->info().gl_sharing || device_->info().imports_opaque_fds)
    QUINCUNX_SKIP("this device shares with OpenGL");
  auto bridge = Bridge::create(*context_, *device_, {.target_extent = {16, 16}, .output_extent = {16, 16}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kCopy);
  EXPECT_TRUE(contains(bridge.value()->reason(), "cl_khr_gl_sharing")) << bridge.value()->reason();
}

TEST_F(BridgeSettingsTest, OpenDeviceInsistsOnGlOrFallsBack) {
  if (device_->info().gl_sharing) QUINCUNX_SKIP("this device shares with OpenGL");
  for (const std::string& selector : {std::string(), std::to_string(device_->info().index)}) {
    const auto gl = open_device(*context_, selector, Interop::kGl);
    ASSERT_FALSE(gl.ok());
    EXPECT_EQ(gl.status().code(), StatusCode::kUnsupported);
    EXPECT_TRUE(contains(gl.status().message(), "cl_khr_gl_sharing")) << gl.status().message();
    const auto any = open_device(*context_, selector, Interop::kAuto);
    ASSERT_TRUE(any.ok()) << any.status().message();
    EXPECT_EQ(any->info().name, device_->info().name);
  }
  for (const Interop interop : {Interop::kAuto, Interop::kGl, Interop::kExternal, Interop::kCopy}) {
    EXPECT_EQ(open_device(*context_, "no such device", interop).status().code(),
              StatusCode::kInvalidArgument);
  }
}

TEST(InteropName, IsTheOptionsWord) {
  EXPECT_STREQ(name_of(Interop::kAuto), "auto");
  EXPECT_STREQ(name_of(Interop::kGl), "gl");
  EXPECT_STREQ(name_of(Interop::kExternal), "external");
  EXPECT_STREQ(name_of(Interop::kCopy), "copy");
}

// Checks that texels written by OpenCL arrive in GL's texture and at the caller byte for byte.
class PresentTest : public InteropTest {
 protected:
  void expect_exact(Extent output, Transfer transfer);
};

Bytes read_texture(GLuint texture, Extent extent) {
  Bytes texels(static_cast<std::size_t>(extent.area()) * 4);
  glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(texels.size()),
                    texels.data());
  return texels;
}

void PresentTest::expect_exact(Extent output, Transfer transfer) {
  HostCopy bridge(*device_, {.target_extent = {8, 8}, .output_extent = output}, "test", transfer);
  ImageView first;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    auto view = bridge.begin_present();
    ASSERT_TRUE(view.ok()) << view.status().message();
    EXPECT_EQ(view->extent, output);
    EXPECT_EQ(view->format, PixelFormat::kRGBA8);
    if (seed == 1) first = view.value();
    EXPECT_EQ(view->memory, first.memory);
    EXPECT_EQ(view->row_pitch(), static_cast<std::size_t>(output.width) * 4);
    const Bytes picture = random_texels(PixelFormat::kRGBA8, output, seed);
    // A device copy that is only enqueued, as a dispatch is: present() has to wait for it.
    auto source = device_->allocate(output, PixelFormat::kRGBA8);
    ASSERT_TRUE(source.ok()) << source.status().message();
    upload(source->view(), picture);
    ASSERT_EQ(clEnqueueCopyBuffer(device_->queue(), source->view().memory, view->memory, 0, view->offset,
                                  picture.size(), 0, nullptr, nullptr),
              CL_SUCCESS);
    const Status status = bridge.present();
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(std::memcmp(bridge.presented_pixels(), picture.data(), picture.size()), 0);
    EXPECT_TRUE(read_texture(bridge.presented_texture(), output) == picture);
    EXPECT_EQ(bridge.traffic().bytes_out, picture.size());
  }
}

constexpr std::array<Extent, 5> kOutputs = {Extent{1, 1}, Extent{7, 5}, Extent{257, 129}, Extent{1280, 720},
                                            Extent{1279, 719}};

TEST_F(PresentTest, HostMemoryInPlace) {
  if (!device_->info().host_unified_memory) QUINCUNX_SKIP("this device's memory is not the host's");
  for (const Extent output : kOutputs)
    expect_exact(output, Transfer::kZeroCopy);
}

TEST_F(PresentTest, CopiedFromTheDevice) {
  for (const Extent output : kOutputs)
    expect_exact(output, Transfer::kExplicit);
}

TEST_F(PresentTest, WithoutABeginningIsRefused) {
  auto bridge = Bridge::create(*context_, *device_, {.target_extent = {8, 8}, .output_extent = {8, 8}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  const Status status = bridge.value()->present();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("begin_present()"), std::string::npos) << status.message();
  ASSERT_TRUE(bridge.value()->begin_present().ok());
  EXPECT_TRUE(bridge.value()->present().ok());
  EXPECT_FALSE(bridge.value()->present().ok());
}

// A steady frame makes nothing new and never waits for the whole queue, whatever the viewport does.
class SteadyFrameTest : public InteropTest {
 protected:
  static void run_frame(Bridge& bridge, int frame) {
    const int slot = frame % bridge.slots();
    const Extent render = {20 + frame % 40, 50 - frame % 30};
    auto targets = bridge.begin_draw(slot, render);
    ASSERT_TRUE(targets.ok()) << targets.status().message();
    targets.value()->clear(render);
    ASSERT_TRUE(bridge.submit(slot).ok());
    auto inputs = bridge.acquire(slot);
    ASSERT_TRUE(inputs.ok()) << inputs.status().message();
    ASSERT_TRUE(bridge.begin_present().ok());
    ASSERT_TRUE(bridge.present().ok());
  }
};

TEST_F(SteadyFrameTest, AllocatesNothingAndDrainsNoQueue) {
  for (const Transfer transfer : transfers()) {
    HostCopy bridge(*device_, all_planes({64, 64}, {48, 40}), "test", transfer);
    for (int frame = 0; frame < 4; ++frame)
      run_frame(bridge, frame);
    glFinish();
    const CallCounter<&epoxy_glCreateBuffers> buffers;
    const CallCounter<&epoxy_glBufferStorage> storages;
    const CallCounter<&epoxy_glMapBufferRange> maps;
    const CallCounter<&epoxy_glCreateTextures> textures;
    const CallCounter<&epoxy_glTexStorage2D> texture_storages;
    const CallCounter<&epoxy_glCreateFramebuffers> framebuffers;
    const CallCounter<&epoxy_glFinish> finishes;
    cl_counts() = {};
    constexpr int kFrames = 60;
    for (int frame = 4; frame < 4 + kFrames; ++frame)
      run_frame(bridge, frame);
    EXPECT_EQ(buffers.count() + storages.count() + maps.count(), 0);
    EXPECT_EQ(textures.count() + texture_storages.count() + framebuffers.count(), 0);
    EXPECT_EQ(finishes.count(), 0);
    EXPECT_EQ(cl_counts().creations, 0);
    EXPECT_EQ(cl_counts().blocking_waits, 0);
  }
}

// The counters themselves: a bridge that is made does count.
TEST_F(SteadyFrameTest, MakingABridgeIsCounted) {
  { const HostCopy warm(*device_, all_planes({8, 8}, {8, 8}), "test", Transfer::kZeroCopy); }
  const CallCounter<&epoxy_glBufferStorage> storages;
  const CallCounter<&epoxy_glTexStorage2D> textures;
  cl_counts() = {};
  const HostCopy bridge(*device_, all_planes({8, 8}, {8, 8}), "test", Transfer::kZeroCopy);
  EXPECT_EQ(storages.count(), bridge.slots() + 1);  // one for each slot, one for the picture
  EXPECT_EQ(textures.count(), 5);                   // four targets, one picture
  EXPECT_EQ(cl_counts().creations, bridge.slots() + 1);
}

}  // namespace

}  // namespace quincunx::gl::testing
