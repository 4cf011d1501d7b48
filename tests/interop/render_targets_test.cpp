// SPDX-License-Identifier: MIT
#include "quincunx_gl/render_targets.h"

#include <stdexcept>

#include "interop_fixture.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {37, 23};

class RenderTargetsTest : public InteropTest {};

GLint internal_format(GLuint texture) {
  GLint format = 0;
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
  return format;
}

TEST_F(RenderTargetsTest, HaveTheFormatsAndSizeOfTheContract) {
  const RenderTargets targets = RenderTargets::create({.target_extent = kTarget}).value();
  EXPECT_EQ(targets.extent(), kTarget);
  EXPECT_EQ(internal_format(targets.colour()), GL_RGBA16F);
  EXPECT_EQ(internal_format(targets.depth()), GL_DEPTH_COMPONENT32F);
  EXPECT_EQ(internal_format(targets.velocity()), GL_RG16F);
  EXPECT_EQ(internal_format(targets.reactive()), GL_R8);
  for (const GLuint texture : {targets.colour(), targets.depth(), targets.velocity(), targets.reactive()}) {
    GLint width = 0;
    GLint height = 0;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &width);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &height);
    EXPECT_EQ(width, kTarget.width);
    EXPECT_EQ(height, kTarget.height);
  }
}

TEST_F(RenderTargetsTest, WhatIsNotNeededIsNotMade) {
  const RenderTargets targets =
      RenderTargets::create({.target_extent = kTarget, .velocity = false, .reactive = true}).value();
  EXPECT_EQ(targets.velocity(), 0u);
  ASSERT_NE(targets.reactive(), 0u);
  GLint second = -1;
  GLint third = -1;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.framebuffer());
  glGetIntegerv(GL_DRAW_BUFFER1, &second);
  glGetIntegerv(GL_DRAW_BUFFER2, &third);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  EXPECT_EQ(second, GL_NONE);
  EXPECT_EQ(third, GL_COLOR_ATTACHMENT2);
}

TEST_F(RenderTargetsTest, ImpossibleSizesAreRefused) {
  EXPECT_EQ(RenderTargets::create({.target_extent = {0, 4}}).status().code(), StatusCode::kInvalidArgument);
  EXPECT_FALSE(RenderTargets::create({.target_extent = {4, -1}}).ok());
  EXPECT_FALSE(RenderTargets::create({.target_extent = {1 << 24, 4}}).ok());
}

// Scissor and write masks of whoever drew before must not keep the clear from doing its work. Finite values:
// a partial clear on llvmpipe rewrites whole 4x4 blocks and makes signalling NaN beside the rectangle quiet.
TEST_F(RenderTargetsTest, ClearTouchesTheViewportOnlyAndDepthWhole) {
  const RenderTargets targets = RenderTargets::create({.target_extent = kTarget}).value();
  const std::vector<Plane> planes = planes_of(all_planes(kTarget, kTarget));
  constexpr std::array<GLint, 4> kBox = {3, 4, 5, 6};
  for (const Extent render : {Extent{1, 1}, Extent{7, 5}, Extent{36, 23}, kTarget}) {
    for (const Plane& plane : planes)
      fill_plane(targets, plane, finite_texels(plane.format, kTarget, 7));
    glEnable(GL_SCISSOR_TEST);
    glScissor(kBox[0], kBox[1], kBox[2], kBox[3]);
    glDepthMask(GL_FALSE);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    targets.clear(render);

    std::array<GLint, 4> box = {};
    glGetIntegerv(GL_SCISSOR_BOX, box.data());
    EXPECT_EQ(box, kBox);
    EXPECT_TRUE(glIsEnabled(GL_SCISSOR_TEST));
    glDisable(GL_SCISSOR_TEST);
    for (const Plane& plane : planes) {
      const Bytes before = finite_texels(plane.format, kTarget, 7);
      const Extent cleared = plane.kind == PlaneKind::kDepth ? kTarget : render;
      const Bytes expected =
          overlay(before, Bytes(before.size(), 0), kTarget, cleared, bytes_per_pixel(plane.format));
      EXPECT_EQ(read_plane(targets, plane), expected)
          << "plane " << static_cast<int>(plane.kind) << ", viewport " << render.width << "x"
          << render.height;
    }
  }
}

}  // namespace
}  // namespace quincunx::gl::testing
