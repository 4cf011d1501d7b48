// SPDX-License-Identifier: MIT
// The part of the shadow map that is in use: what it shows, and that nothing else of the map is ever seen.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "render/scene_layout.h"
#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{160, 90};

glm::mat4 at(float x, float y, float z) {
  return glm::translate(glm::mat4(1), glm::vec3(x, y, z));
}
glm::mat4 lying(const glm::mat4& place) {
  return glm::rotate(place, -1.5707963f, glm::vec3(1, 0, 0));
}

// A white floor under slats, which move or stand still; the floor goes on far beyond the shadow map.
Scene slats_scene(bool moving) {
  Scene scene;
  Material white;
  white.base_colour = {1, 1, 1, 1};
  scene.materials = {white};
  scene.meshes = {plate({40, 40}, 0), plate({0.08f, 2}, 0, 24)};
  scene.instances.push_back({0, lying(glm::mat4(1)), {}});
  for (int i = -4; i <= 4; ++i) {
    const auto x = static_cast<float>(i) * 0.45f;
    const auto place = [x](double t) { return lying(at(x + static_cast<float>(t), 1, 0)); };
    scene.instances.push_back({1, place(0), moving ? Motion(place) : Motion()});
  }
  scene.sun.direction = {0.1f, -1, 0.05f};
  scene.sun.irradiance = glm::vec3(3);
  scene.camera = fixed_camera({0, 5, 6}, {0, 0, 0}, 0.8f);
  return scene;
}

FrameView view_at(float scale, double seconds = 0) {
  FrameView view = view_of_size(kSize, {}, seconds, seconds);
  view.shadow_scale = scale;
  return view;
}

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.colour.size(); ++i)
    sum += std::abs(static_cast<double>(a.colour[i]) - static_cast<double>(b.colour[i]));
  return sum / static_cast<double>(a.colour.size());
}

class ShadowScaleTest : public RenderTest {
 protected:
  static Picture fresh(const Scene& scene, const FrameView& view) {
    Renderer renderer = renderer_of(scene);
    return draw(renderer, view, kSize);
  }
};

TEST_F(ShadowScaleTest, TheSideIsEvenAndTheScaleAsNearAsItCanBe) {
  EXPECT_EQ(shadow_side(1), kShadowTexels);
  EXPECT_EQ(shadow_side(0.5f), kShadowTexels / 2);
  EXPECT_EQ(shadow_side(kLeastPartScale), 128);
  for (float scale = kLeastPartScale; scale <= 1; scale += 0.0173f) {
    EXPECT_EQ(shadow_side(scale) % 2, 0) << scale;
    EXPECT_NEAR(shadow_side(scale), scale * kShadowTexels, 1) << scale;
  }
}

// Of a map that is drawn at another scale in each frame nothing is left of the frames before.
TEST_F(ShadowScaleTest, WhatEarlierFramesLeftInTheMapChangesNoBit) {
  for (const bool moving : {false, true}) {
    const Scene scene = slats_scene(moving);
    Renderer renderer = renderer_of(scene);
    std::mt19937 random(moving ? 1 : 2);
    std::uniform_real_distribution<float> scales(kLeastPartScale, 1);
    for (int frame = 0; frame < 8; ++frame) {
      const FrameView view = view_at(frame == 1 ? 1 : scales(random), 0.07 * frame);
      const Picture picture = draw(renderer, view, kSize);
      EXPECT_EQ(picture.colour, fresh(scene, view).colour)
          << "frame " << frame << ", scale " << view.shadow_scale << ", moving " << moving;
    }
  }
}

TEST_F(ShadowScaleTest, ASmallerMapIsACoarserOneOfTheSameShadows) {
  const Scene scene = slats_scene(true);
  const Picture whole = fresh(scene, view_at(1));
  double before = 0;
  for (const float scale : {0.5f, 0.25f, 0.125f}) {
    const double difference = mean_difference(whole, fresh(scene, view_at(scale)));
    EXPECT_GT(difference, before) << scale;
    before = difference;
  }
  // A texel at .5 is a pixel wide at most here: the slats' shadows lie where they lie.
  Scene lit = scene;
  lit.sun.casts_shadows = false;
  const double shadows = mean_difference(whole, fresh(lit, view_at(1)));
  EXPECT_LT(mean_difference(whole, fresh(scene, view_at(0.5f))), shadows / 8);
}

// The border of the whole map is lit; so must be what lies next to a part of it.
TEST_F(ShadowScaleTest, BeyondTheMapThereIsLightAtEachScale) {
  for (const bool moving : {false, true}) {
    Scene scene = slats_scene(moving);
    scene.camera = fixed_camera({12, 8, 12}, {0, 0, 0}, 1.2f);
    Renderer renderer = renderer_of(scene);
    draw(renderer, view_at(1), kSize);  // fills the map
    Scene lit = scene;
    lit.sun.casts_shadows = false;
    const Picture light = fresh(lit, view_at(1));
    const Picture shaded = draw(renderer, view_at(1), kSize);
    for (const float scale : {0.9f, 0.5f, 0.3f, 0.0625f}) {
      const Picture picture = draw(renderer, view_at(scale), kSize);
      // Shadows reach over their edges by no more than a few of the coarse texels.
      const int far = kSize.width / 4;
      int beyond = 0;
      for (int y = 0; y < kSize.height; ++y) {
        bool near = false;
        for (int x = 0; x < kSize.width; ++x)
          near = near || shaded.rgb(x, y) != light.rgb(x, y);
        for (int x = 0; x < kSize.width; ++x) {
          if (near || (x > far && x < kSize.width - far)) continue;
          ++beyond;
          ASSERT_EQ(picture.rgb(x, y), light.rgb(x, y)) << x << ", " << y << ", scale " << scale;
        }
      }
      EXPECT_GT(beyond, 1000) << "the picture must show what lies beyond the map";
    }
  }
}

TEST_F(ShadowScaleTest, AScaleOutOfItsRangeIsRefused) {
  Renderer renderer = renderer_of(slats_scene(false));
  const gl::RenderTargets targets({.target = kSize});
  for (const float scale : {0.0f, 0.06f, 1.01f, -1.0f, std::nanf("")}) {
    const Status status = renderer.draw(targets, view_at(scale));
    ASSERT_FALSE(status.ok()) << scale;
    EXPECT_NE(status.message().find("shadow_scale"), std::string::npos) << status.message();
  }
}

}  // namespace
}  // namespace quincunx::scenes::testing
