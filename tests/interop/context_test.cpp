// SPDX-License-Identifier: MIT
#include "quincunx_gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <utility>

#include "skip.h"

namespace quincunx::gl {
namespace {

void expect_usable(const Context& context) {
  EXPECT_EQ(eglGetCurrentContext(), context.context());
  GLint major = 0;
  GLint minor = 0;
  GLint profile = GL_CONTEXT_CORE_PROFILE_BIT;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  const bool desktop = context.info().api == Api::kGl45;
  if (desktop) glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_GE(major * 10 + minor, desktop ? 45 : 31);
  EXPECT_EQ(epoxy_is_desktop_gl(), desktop);
  EXPECT_EQ(capabilities().api, context.info().api);
  EXPECT_EQ(capabilities().version, major * 10 + minor);
  EXPECT_TRUE(profile & GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_FALSE(context.info().renderer.empty());
  EXPECT_FALSE(context.info().vendor.empty());
  EXPECT_FALSE(context.info().version.empty());
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST(Context, SurfacelessPlatform) {
  auto context = Context::create(Platform::kSurfaceless);
  if (!context.ok()) QUINCUNX_SKIP(context.status().message());
  EXPECT_EQ(context->info().platform, Platform::kSurfaceless);
  expect_usable(context.value());
}

TEST(Context, DevicePlatform) {
  auto context = Context::create(Platform::kDevice);
  if (!context.ok()) QUINCUNX_SKIP(context.status().message());
  EXPECT_EQ(context->info().platform, Platform::kDevice);
  expect_usable(context.value());
}

TEST(Context, OpenGlEsOnEveryPlatform) {
  for (const Platform platform : {Platform::kSurfaceless, Platform::kDevice, Platform::kAuto}) {
    auto context = Context::create(platform, Api::kEs3);
    if (!context.ok()) QUINCUNX_SKIP(context.status().message());
    EXPECT_EQ(context->info().api, Api::kEs3);
    if (platform != Platform::kAuto) {
      EXPECT_EQ(context->info().platform, platform);
    }
    expect_usable(context.value());
    // That of a window, which someone else has made.
    auto borrowed = Context::create(Platform::kCurrent);
    ASSERT_TRUE(borrowed.ok()) << borrowed.status().message();
    EXPECT_EQ(borrowed->info().api, Api::kEs3);
  }
}

TEST(Context, CapabilitiesAreThoseOfTheCurrentContext) {
  auto desktop = Context::create();
  auto es = Context::create(Platform::kAuto, Api::kEs3);
  ASSERT_TRUE(desktop.ok() && es.ok());
  EXPECT_FALSE(capabilities().reads_depth);
  ASSERT_TRUE(desktop->make_current().ok());
  expect_usable(desktop.value());
  EXPECT_TRUE(capabilities().reads_depth);
  EXPECT_TRUE(capabilities().clip_control);
  ASSERT_TRUE(es->make_current().ok());
  expect_usable(es.value());
}

TEST(Context, AutoTakesADeviceOnlyForAGpu) {
  auto context = Context::create();
  ASSERT_TRUE(context.ok()) << context.status().message();
  expect_usable(context.value());
  if (context->info().software) {
    EXPECT_EQ(context->info().platform, Platform::kSurfaceless);
  } else {
    EXPECT_EQ(context->info().platform, Platform::kDevice);
  }
}

TEST(Context, LlvmpipeIsKnownAsSoftware) {
  auto context = Context::create();
  ASSERT_TRUE(context.ok()) << context.status().message();
  const bool llvmpipe = context->info().renderer.find("llvmpipe") != std::string::npos;
  if (!llvmpipe) QUINCUNX_SKIP("this machine renders with " + context->info().renderer);
  EXPECT_TRUE(context->info().software);
}

// Both live on one EGL display; the end of the first must not end the second.
TEST(Context, TwoContextsOfOneDisplayLiveApart) {
  auto second = [] {
    auto first = Context::create();
    EXPECT_TRUE(first.ok()) << first.status().message();
    return Context::create();
  }();
  ASSERT_TRUE(second.ok()) << second.status().message();
  expect_usable(second.value());
  // The loader answers for a context that is current already, so take it off first.
  ASSERT_EQ(eglMakeCurrent(second->display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT),
            EGLBoolean{EGL_TRUE});
  const Status again = second->make_current();
  ASSERT_TRUE(again.ok()) << again.message();
  expect_usable(second.value());
}

TEST(Context, MakeCurrentSwitches) {
  auto first = Context::create();
  auto second = Context::create();
  ASSERT_TRUE(first.ok() && second.ok());
  expect_usable(second.value());
  ASSERT_TRUE(first->make_current().ok());
  expect_usable(first.value());
}

TEST(Context, MovedContextIsTheSame) {
  auto created = Context::create();
  ASSERT_TRUE(created.ok()) << created.status().message();
  void* const raw = created->context();
  Context moved = std::move(created).value();
  EXPECT_EQ(moved.context(), raw);
  expect_usable(moved);
}

TEST(Context, LeavesNothingCurrentBehind) {
  { auto context = Context::create(); }
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
}

}  // namespace
}  // namespace quincunx::gl
