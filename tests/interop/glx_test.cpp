// SPDX-License-Identifier: MIT
// The bridge in a context of GLX, as GLFW's and SDL's are on X11: on a display of its own (Xvfb).
#include <CL/cl_gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstdlib>

#include "cl_interposer.h"
#include "interop_fixture.h"
#include "skip.h"
#include "xvfb.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {40, 30};
constexpr Extent kRender = {21, 13};
constexpr Extent kOutput = {16, 12};

class GlxTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!quincunx::testing::is_installed("Xvfb")) QUINCUNX_SKIP("Xvfb is not installed");
    server_ = std::make_unique<quincunx::testing::Xvfb>(folder_);
    setenv("DISPLAY", server_->name().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    ASSERT_TRUE(glfwInit());
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    window_ = glfwCreateWindow(16, 16, "test", nullptr, nullptr);
    ASSERT_NE(window_, nullptr);
    glfwMakeContextCurrent(window_);
  }

  void TearDown() override {
    if (server_ == nullptr) return;
    if (glfwGetCurrentContext() != nullptr) {
      EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
    glfwTerminate();
  }

  quincunx::testing::TemporaryFolder folder_;
  std::unique_ptr<quincunx::testing::Xvfb> server_;
  GLFWwindow* window_ = nullptr;
};

// Draws a frame into slot 0 and hands it over.
SharedFrame carry(Bridge& bridge, const std::vector<Plane>& planes) {
  auto targets = bridge.begin_draw(0, kRender);
  EXPECT_TRUE(targets.ok()) << targets.status().message();
  for (const Plane& plane : planes)
    fill_plane(*targets.value(), plane, random_texels(plane.format, kTarget, 7));
  EXPECT_TRUE(bridge.submit(0).ok());
  auto frame = bridge.acquire(0);
  EXPECT_TRUE(frame.ok()) << frame.status().message();
  return frame.value();
}

TEST_F(GlxTest, FramesAreCopiedByteForByte) {
  auto context = Context::create(Platform::kCurrent);
  ASSERT_TRUE(context.ok()) << context.status().message();
  EXPECT_EQ(context->info().system, WindowSystem::kGlx);
  EXPECT_TRUE(context->make_current().ok());
  auto device = open_device(context.value(), "", Interop::kCopy);
  ASSERT_TRUE(device.ok()) << device.status().message();
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  auto bridge = Bridge::create(context.value(), device.value(), settings);
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  const std::vector<Plane> planes = planes_of(settings);
  SharedFrame frame = carry(*bridge.value(), planes);
  for (const Plane& plane : planes) {
    const std::size_t texel = bytes_per_pixel(plane.format);
    Bytes seen(static_cast<std::size_t>(kRender.area()) * texel);
    ASSERT_TRUE(device->download(view_of(frame, plane.kind), kRender, seen.data()).ok());
    EXPECT_TRUE(seen == crop(random_texels(plane.format, kTarget, 7), kTarget, kRender, texel));
  }
}

// The OpenCL context is told of GLX's display and context, and textures change owner.
TEST_F(GlxTest, TexturesAreShared) {
  const PretendSharing driver(false);
  auto context = Context::create(Platform::kCurrent);
  ASSERT_TRUE(context.ok()) << context.status().message();
  auto device = open_device(context.value(), "", Interop::kGl);
  ASSERT_TRUE(device.ok()) << device.status().message();
  std::array<cl_context_properties, 16> told = {};
  ASSERT_EQ(clGetContextInfo(device->context(), CL_CONTEXT_PROPERTIES, sizeof(told), told.data(), nullptr),
            CL_SUCCESS);
  const auto value = [&told](cl_context_properties name) -> cl_context_properties {
    for (std::size_t i = 0; i + 1 < told.size() && told[i] != 0; i += 2) {
      if (told[i] == name) return told[i + 1];
    }
    return 0;
  };
  EXPECT_EQ(value(CL_GLX_DISPLAY_KHR), reinterpret_cast<cl_context_properties>(context->display()));
  EXPECT_EQ(value(CL_GL_CONTEXT_KHR), reinterpret_cast<cl_context_properties>(context->context()));
  EXPECT_EQ(value(CL_EGL_DISPLAY_KHR), 0);
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  auto bridge = Bridge::create(context.value(), device.value(), settings);
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  EXPECT_EQ(bridge.value()->kind(), Interop::kGl);
  carry(*bridge.value(), planes_of(settings));
  EXPECT_EQ(acquired_textures(), static_cast<int>(planes_of(settings).size()));
}

// Where older engines draw. Mesa does not tell there what a texture was made for.
TEST_F(GlxTest, TexturesAreImportedInACompatibilityProfile) {
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  ASSERT_TRUE(profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT);
  auto context = Context::create(Platform::kCurrent).value();
  auto device = open_device(context, "", Interop::kCopy).value();
  auto bridge =
      Bridge::create(context, device, {.target_extent = kTarget, .output_extent = kOutput, .imports = true});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  const Bytes texels = finite_texels(PixelFormat::kRGBA16F, kTarget, 3);
  GLuint colour = 0, cube = 0;
  glGenTextures(1, &colour);
  glBindTexture(GL_TEXTURE_2D, colour);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, kTarget.width, kTarget.height, 0, GL_RGBA, GL_HALF_FLOAT,
               texels.data());
  glGenTextures(1, &cube);
  glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
  const auto frame = bridge.value()->import({.colour = colour}, kRender);
  ASSERT_TRUE(frame.ok()) << frame.status().message();
  Bytes seen(static_cast<std::size_t>(kRender.area()) * 8);
  ASSERT_TRUE(device.download(frame->colour, kRender, seen.data()).ok());
  EXPECT_TRUE(seen == crop(texels, kTarget, kRender, 8));
  EXPECT_EQ(bridge.value()->import({.colour = cube}, kRender).status().message(),
            "FrameTextures: colour is no GL_TEXTURE_2D");
}

TEST_F(GlxTest, AContextThatIsNotCurrentIsRefusedInWords) {
  auto context = Context::create(Platform::kCurrent);
  ASSERT_TRUE(context.ok()) << context.status().message();
  glfwMakeContextCurrent(nullptr);
  EXPECT_EQ(context->make_current().message(), "the window's OpenGL context is not current on this thread");
  const auto none = Context::create(Platform::kCurrent);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.status().message().find("no EGL or GLX context is current on this thread"),
            std::string::npos)
      << none.status().message();
}

}  // namespace
}  // namespace quincunx::gl::testing
