// SPDX-License-Identifier: MIT
// Views of a part of the picture: the same as that part of a view of the whole.
#include <cmath>

#include "render_fixture.h"

namespace quincunx::scenes {
namespace {

using testing::draw;
using testing::Picture;
using testing::RenderTest;

constexpr Extent kWhole = {128, 96};
constexpr Rectangle kPart = {40, 16, 64, 48};

ViewWindow window_of(const Rectangle& part) {
  const glm::dvec2 whole(kWhole.width, kWhole.height);
  return {glm::dvec2(part.x, part.y) / whole, glm::dvec2(part.width, part.height) / whole};
}

// A plate that slides and turns before the sky.
Scene plate_scene() {
  Scene scene;
  scene.textures.push_back(testing::smooth_texture(3, 40));
  Material material = testing::unlit({1, 1, 1, 1});
  material.base_colour_texture.texture = 0;
  scene.materials.push_back(material);
  scene.meshes.push_back(testing::plate({1.4f, .8f}, 0));
  scene.instances.push_back({0, glm::mat4(1),
                             [](double seconds) {
                               glm::mat4 matrix(1);
                               matrix[3] = glm::vec4(.3 * seconds, .1 * seconds, -.4 * seconds, 1);
                               return matrix;
                             },
                             "plate"});
  scene.camera = testing::fixed_camera({.4f, .3f, 3}, {0, 0, 0});
  return scene;
}

class WindowView : public RenderTest {};

FrameView part_view(const FrameView& whole, const Rectangle& part, const Rectangle& previous) {
  FrameView view = whole;
  view.render = {part.width, part.height};
  view.aspect = static_cast<float>(kWhole.width) / static_cast<float>(kWhole.height);
  view.window = window_of(part);
  view.previous_window = window_of(previous);
  return view;
}

// Jittered alike; but for pixels that an edge crosses, where rounding decides, everything agrees.
TEST_F(WindowView, IsThatPartOfTheWhole) {
  Renderer renderer = testing::renderer_of(plate_scene());
  const FrameView whole = testing::view_of_size(kWhole, {.3f, -.2f}, 1, .9);
  const Rectangle before = {37, 18, 64, 48};  // the region has moved by (3, -2) pixels
  const Picture all = draw(renderer, whole, kWhole);
  const Picture part = draw(renderer, part_view(whole, kPart, before), {kPart.width, kPart.height});
  int off = 0;
  int moving = 0;
  for (int y = 0; y < kPart.height; ++y) {
    for (int x = 0; x < kPart.width; ++x) {
      const int at_x = kPart.x + x;
      const int at_y = kPart.y + y;
      const float depth = part.depth[part.index(x, y)];
      const bool same = glm::distance(part.rgb(x, y), all.rgb(at_x, at_y)) < .01f &&
                        std::abs(depth - all.depth[all.index(at_x, at_y)]) < 1e-5f;
      off += same ? 0 : 1;
      if (!same) continue;
      moving += depth > 0 ? 1 : 0;
      // In pixels: relative to the region, which has itself moved.
      const glm::vec2 of_part = part.v(x, y) * glm::vec2(kPart.width, kPart.height);
      const glm::vec2 of_whole = all.v(at_x, at_y) * glm::vec2(kWhole.width, kWhole.height);
      EXPECT_NEAR(of_part.x, of_whole.x - 3, .02f) << x << ", " << y;
      EXPECT_NEAR(of_part.y, of_whole.y + 2, .02f) << x << ", " << y;
    }
  }
  EXPECT_LE(off, 24);
  EXPECT_GT(moving, 800);
}

// The camera's motion between two regions is that of the sky.
TEST_F(WindowView, TheCamerasMotionHoldsTheRegionsOwn) {
  Renderer renderer = testing::renderer_of(plate_scene());
  const FrameView still = part_view(testing::view_of_size(kWhole), kPart, kPart);
  const CameraMotion none = renderer.camera_motion(still);
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(none.clip_to_previous_clip[static_cast<std::size_t>(i)], i % 5 == 0 ? 1 : 0);
  const CameraMotion moved =
      renderer.camera_motion(part_view(testing::view_of_size(kWhole), kPart, {36, 16, 64, 48}));
  // ndc.x of the previous frame's region: 4 of its 64 pixels further right.
  const auto& m = moved.clip_to_previous_clip;
  const double depth = .2;
  const double x = m[8] * depth + m[12];
  const double w = m[11] * depth + m[15];
  EXPECT_NEAR(x / w, 2 * 4 / 64.0, 1e-5);
}

TEST_F(WindowView, AnEmptyWindowIsRefused) {
  Renderer renderer = testing::renderer_of(plate_scene());
  const gl::RenderTargets targets =
      gl::RenderTargets::create({.target_extent = kWhole, .velocity = true, .reactive = true}).value();
  FrameView view = testing::view_of_size(kWhole);
  view.window.size.x = 0;
  const Status status = renderer.draw(targets, view);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.message(), "FrameView::window and previous_window must be finite and not empty");
}

}  // namespace
}  // namespace quincunx::scenes
