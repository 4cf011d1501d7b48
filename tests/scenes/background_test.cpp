// SPDX-License-Identifier: MIT
// Scenes in which a renderer hands over other things than surfaces on a sky: a background without velocity or without
// anything, and faults of one frame.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catalog/scene_catalog.h"
#include "render/truth.h"
#include "render_fixture.h"
#include "scene.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kSize{160, 90};
constexpr double kFrame = 1.0 / 60;

using BackgroundTest = RenderTest;

// Part of the pixels.
template <typename Condition>
double part(const Picture& picture, const Condition& holds) {
  int count = 0;
  for (std::size_t i = 0; i < picture.depth.size(); ++i)
    count += holds(i) ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(picture.depth.size());
}

TEST_F(BackgroundTest, ABackdropHasNoVelocityThoughTheCameraTurns) {
  Scene scene = open_scene("backdrop").value();
  const auto draw_it = [&] {
    Renderer renderer = renderer_of(scene);
    return draw(renderer, view_of_size(kSize, {}, kFrame, 0), kSize);
  };
  const Picture said = draw_it();
  scene.sky.has_velocity = true;
  const Picture true_one = draw_it();
  EXPECT_EQ(said.colour, true_one.colour);
  EXPECT_EQ(said.depth, true_one.depth);
  const auto is_sky = [&](std::size_t i) { return said.depth[i] == 0; };
  const auto moves = [](const Picture& picture, std::size_t i) {
    return std::hypot(picture.velocity[2 * i], picture.velocity[2 * i + 1]) > 0.3f / kSize.width;
  };
  EXPECT_GT(part(said, is_sky), 0.3);
  EXPECT_LT(part(said, is_sky), 0.9);
  for (std::size_t i = 0; i < said.depth.size(); ++i) {
    EXPECT_TRUE(is_sky(i) || said.velocity[2 * i] == true_one.velocity[2 * i]);
    EXPECT_FALSE(is_sky(i) && moves(said, i));
    EXPECT_FALSE(is_sky(i) && !moves(true_one, i)) << "a third of a pixel a frame";
  }
}

TEST_F(BackgroundTest, ACutoutIsTransparentWhereNothingIs) {
  const Scene scene = open_scene("cutout").value();
  EXPECT_FALSE(needs_of(scene).background);
  Renderer renderer = renderer_of(scene);
  const Picture picture = draw(renderer, view_of_size(kSize), kSize);
  for (std::size_t i = 0; i < picture.depth.size(); ++i)
    ASSERT_EQ(picture.colour[4 * i + 3], picture.depth[i] > 0 ? 1 : 0);
  const double empty = part(picture, [&](std::size_t i) { return picture.depth[i] == 0; });
  EXPECT_GT(empty, 0.3);
  EXPECT_LT(empty, 0.9);
  const auto truth = render_truth(renderer, {.output = kSize, .samples = 4}, 0);
  ASSERT_TRUE(truth.ok()) << truth.status().message();
  int partly = 0;
  for (std::size_t i = 0; i < truth->size(); i += 4) {
    const float alpha = truth.value()[i + 3];
    if (alpha == 0) {
      EXPECT_EQ(truth.value()[i + 1], 0);
    }
    partly += alpha > 0.1f && alpha < 0.9f ? 1 : 0;
  }
  EXPECT_GT(partly, 100);
}

TEST_F(BackgroundTest, FaultsLastOneFrameAndTruthHasNone) {
  Scene scene = open_scene("faults").value();
  Renderer renderer = renderer_of(scene);
  scene.faults.clear();
  Renderer sound = renderer_of(scene);
  const int side = static_cast<int>(std::lround(0.03f * kSize.height));
  for (int frame = 0; frame < 8; ++frame) {
    const FrameView view = view_of_size(kSize, {}, frame * kFrame, (frame - 1) * kFrame);
    const Picture picture = draw(renderer, view, kSize);
    const Picture wanted = draw(sound, view, kSize);
    EXPECT_EQ(picture.depth, wanted.depth);
    EXPECT_EQ(picture.velocity, wanted.velocity);
    const auto red = [](const Picture& p, std::size_t i) { return p.colour[4 * i]; };
    const double block = static_cast<double>(side * side) / static_cast<double>(kSize.area());
    const double expected = frame % 6 == 1 ? block : 0;
    for (const float value : {50.0f, -5.0f, std::numeric_limits<float>::infinity()}) {
      EXPECT_NEAR(part(picture, [&](std::size_t i) { return red(picture, i) == value; }), expected,
                  0.5 * block)
          << frame << ", " << value;
    }
    if (expected == 0) {
      EXPECT_EQ(picture.colour, wanted.colour) << frame;
      continue;
    }
    const TruthSettings settings{.output = kSize, .samples = 1};
    const auto truth = render_truth(renderer, settings, view.seconds);
    ASSERT_TRUE(truth.ok()) << truth.status().message();
    EXPECT_EQ(truth.value(), render_truth(sound, settings, view.seconds).value());
  }
}

TEST_F(BackgroundTest, AFaultStaysWithinTheViewport) {
  Scene scene = open_scene("faults").value();
  scene.faults = {{.seconds = 0, .place = {0.95f, 0.9f}, .side = 0.5f, .value = 50}};
  Renderer renderer = renderer_of(scene);
  const gl::RenderTargets targets = gl::RenderTargets::create({kSize, true, true}).value();
  fill_with(targets, 0.25f);
  const Extent render{100, 60};
  ASSERT_TRUE(renderer.draw(targets, view_of_size(render, {}, 0, -kFrame)).ok());
  const Picture picture = read_back(targets);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool inside = x < render.width && y < render.height;
      if (!inside) {
        ASSERT_EQ(picture.rgb(x, y), glm::vec3(0.25f)) << x << ", " << y;
      } else if (x >= 95 && y >= 54) {
        ASSERT_EQ(picture.rgb(x, y), glm::vec3(50)) << x << ", " << y;
      }
    }
  }
}

TEST(Faults, OutsideOfPictureOrSceneAreRefused) {
  Scene scene;
  scene.duration = 2;
  scene.camera = fixed_camera({0, 0, 0}, {0, 0, -1});
  const auto refused = [&](const Fault& fault) {
    scene.faults = {fault};
    const Status status = check_scene(scene);
    return !status.ok() && status.message().find("fault 0") != std::string::npos;
  };
  EXPECT_FALSE(refused({.seconds = 1.9, .place = {0.9f, 0}, .side = 0.5f, .value = 1}));
  EXPECT_TRUE(refused({.seconds = 2, .place = {0.9f, 0}, .side = 0.5f, .value = 1}));
  EXPECT_TRUE(refused({.seconds = 0, .place = {-0.1f, 0}, .side = 0.5f, .value = 1}));
  EXPECT_TRUE(refused({.seconds = 0, .place = {0, 0}, .side = NAN, .value = 1}));
}

TEST(Faults, ComeBackWithTheScene) {
  Scene scene;
  scene.duration = 2;
  Fault fault;
  fault.seconds = 0.5;
  EXPECT_TRUE(shows(scene, fault, 0.4, 0.5));
  EXPECT_FALSE(shows(scene, fault, 0.5, 0.6));
  EXPECT_FALSE(shows(scene, fault, 0.5, 0.5)) << "a moment by itself";
  EXPECT_TRUE(shows(scene, fault, 2.45, 2.55));
  EXPECT_TRUE(shows(scene, fault, -1.55, -1.45));
}

}  // namespace
}  // namespace quincunx::scenes::testing
