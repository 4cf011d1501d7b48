// SPDX-License-Identifier: MIT
// The regions of a picture: of made-up depth and motion, of scenes, and in the figures of a method.
#include "bench/speed_error/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <string>

#include "bench/speed_error/bench_quality.h"
#include "frames/frame_source.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::bench {
namespace {

constexpr Extent kSize{20, 12};
constexpr float kFar = 0.1f;
constexpr float kNear = 0.5f;

std::vector<float> everywhere(float depth) {
  return std::vector<float>(static_cast<std::size_t>(kSize.area()), depth);
}

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x);
}

void fill(std::vector<float>& depth, int left, int top, int width, int height, float value) {
  for (int y = top; y < top + height; ++y)
    std::fill_n(depth.begin() + static_cast<std::ptrdiff_t>(at(left, y)), width, value);
}

std::vector<std::uint8_t> thin_in(const std::vector<float>& nearest) {
  return thin_pixels(kSize, nearest);
}

std::ptrdiff_t count(const std::vector<std::uint8_t>& mask) {
  return std::count(mask.begin(), mask.end(), 1);
}

TEST(Regions, ThinIsWhatFillsNoBlockOfFourPixels) {
  for (const float behind : {0.0f, kFar}) {  // nothing but the sky, or a wall
    std::vector<float> depth = everywhere(behind);
    fill(depth, 8, 0, 3, kSize.height, kNear);
    const auto thin = thin_in(depth);
    EXPECT_EQ(count(thin), 3 * kSize.height);
    EXPECT_EQ(thin[at(9, 5)], 1);
    fill(depth, 11, 0, 1, kSize.height, kNear);
    EXPECT_EQ(count(thin_in(depth)), 0) << "four wide";
  }
  std::vector<float> depth = everywhere(kFar);
  fill(depth, 3, 3, 4, 4, kNear);  // a block, and a wire that sticks out of it
  fill(depth, 7, 5, 8, 1, kNear);
  EXPECT_EQ(count(thin_in(depth)), 8);
}

TEST(Regions, ASlantedEdgeAndASlopeAreNotThin) {
  std::vector<float> depth = everywhere(kFar);
  for (int y = 0; y < kSize.height; ++y)
    fill(depth, 0, y, 5 + y, 1, kNear);
  EXPECT_EQ(count(thin_in(depth)), 0);
  for (int y = 0; y < kSize.height; ++y)  // ground that rises to a horizon, each row a tenth farther
    fill(depth, 0, y, kSize.width, 1, 0.02f * std::pow(1.1f, static_cast<float>(y)));
  EXPECT_EQ(count(thin_in(depth)), 0);
}

TEST(Regions, NothingIsThinBecauseThePictureEnds) {
  std::vector<float> depth = everywhere(kFar);
  fill(depth, 0, 0, 2, kSize.height, kNear);
  fill(depth, kSize.width - 2, 0, 2, kSize.height, kNear);
  EXPECT_EQ(count(thin_in(depth)), 0);
}

TEST(Regions, BehindIsWhatLiesFartherWithinFourPixels) {
  std::vector<float> depth = everywhere(kFar);
  fill(depth, 9, 0, 1, kSize.height, kNear);
  fill(depth, 12, 0, 8, kSize.height, 0.9f);  // nearer than the wire
  const auto behind = behind_thin_pixels(kSize, depth, thin_in(depth));
  for (int x = 0; x < kSize.width; ++x)
    EXPECT_EQ(behind[at(x, 4)], x >= 5 && x < 12 && x != 9 ? 1 : 0) << x;
}

TEST(Regions, EdgesOfMotionAreNearWhereMotionsMeet) {
  Geometry geometry{kSize, everywhere(kFar), std::vector<Vec2>(everywhere(0).size())};
  const auto edges_where_right_half_moves = [&](float pixels) {
    for (std::size_t i = 0; i < geometry.velocity.size(); ++i) {
      const bool right = i % static_cast<std::size_t>(kSize.width) >= 10;
      geometry.velocity[i] = {right ? pixels / kSize.width : 0, 0};
    }
    return edges_of_motion(geometry);
  };
  EXPECT_EQ(count(edges_where_right_half_moves(0.4f)), 0);
  const auto edges = edges_where_right_half_moves(0.6f);
  EXPECT_EQ(count(edges), 6 * kSize.height);
  EXPECT_EQ(edges[at(7, 0)], 1);
  EXPECT_EQ(edges[at(12, 11)], 1);
  // Turning or growing surfaces have no edge within.
  for (std::size_t i = 0; i < geometry.velocity.size(); ++i)
    geometry.velocity[i] = {
        0.3f * static_cast<float>(i % static_cast<std::size_t>(kSize.width)) / kSize.width, 0};
  EXPECT_EQ(count(edges_of_motion(geometry)), 0);
}

TEST(Regions, EachPixelIsInTheFirstThatHolds) {
  std::vector<float> depth = everywhere(kFar);
  fill(depth, 5, 0, 1, kSize.height, kNear);
  Geometry geometry{kSize, depth, std::vector<Vec2>(depth.size())};
  for (int y = 0; y < kSize.height; ++y)
    geometry.velocity[at(13, y)] = {1, 0};
  std::vector<std::uint8_t> disoccluded(depth.size(), 0);
  for (const int x : {4, 5, 11, 18})
    disoccluded[at(x, 6)] = 1;
  const auto regions = regions_of(geometry, depth, disoccluded);
  EXPECT_EQ(regions[at(5, 6)], Region::kThin);
  EXPECT_EQ(regions[at(4, 6)], Region::kBehindThin);
  EXPECT_EQ(regions[at(11, 6)], Region::kDisoccluded);
  EXPECT_EQ(regions[at(18, 6)], Region::kDisoccluded);
  EXPECT_EQ(regions[at(11, 5)], Region::kEdge);
  EXPECT_EQ(regions[at(18, 5)], Region::kRest);
}

TEST(Regions, AnErrorCountsWhereItIs) {
  FrameMasks masks;
  masks.disoccluded.assign(everywhere(0).size(), 0);
  masks.regions.assign(masks.disoccluded.size(), Region::kRest);
  std::vector<float> rgba(masks.regions.size() * 4, 0.0f);
  const tools::MeasuredPicture truth(kSize, rgba);
  for (const int x : {3, 4}) {
    masks.regions[at(x, 2)] = Region::kThin;
    masks.disoccluded[at(x, 2)] = 1;
  }
  std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(4 * at(3, 2)), 3,
              1.0f);  // one of the two: 0.5 of white
  QualityTally tally;
  tally.add({kSize, rgba}, truth, nullptr, masks);
  const Quality quality = tally.quality();
  const double squared = std::pow(1.055 * std::pow(0.5, 1 / 2.4) - 0.055, 2) / 2;
  const auto psnr = [&](Region region) { return quality.region_psnr[static_cast<std::size_t>(region)]; };
  EXPECT_NEAR(psnr(Region::kThin).value(), -10 * std::log10(squared), 1e-5);
  EXPECT_NEAR(quality.ghosting.value(), std::sqrt(squared), 1e-7);
  EXPECT_EQ(psnr(Region::kRest), kHighestRegionPsnr) << "no error";
  EXPECT_FALSE(psnr(Region::kEdge).has_value()) << "no pixel";
}

std::unique_ptr<scenes::FrameSource> stage_of(const char* scene, Extent output) {
  scenes::FrameSourceSettings settings;
  settings.scene = scene;
  settings.sequence.output = output;
  settings.sequence.frames = 1;
  auto stage = scenes::FrameSource::create(settings);
  EXPECT_TRUE(stage.ok()) << stage.status().message();
  return stage.ok() ? std::move(stage).value() : nullptr;
}

TEST(Geometry, TheSkyMovesAsTheCameraTurnsWhateverTheSceneSays) {
  constexpr Extent kOutput{160, 90};
  const auto stage = stage_of("backdrop", kOutput);
  ASSERT_NE(stage, nullptr);
  scenes::Scene honest = stage->scene();
  ASSERT_FALSE(honest.sky.has_velocity);
  honest.sky.has_velocity = true;
  auto renderer = scenes::Renderer::create(honest);
  ASSERT_TRUE(renderer.ok()) << renderer.status().message();
  const gl::RenderTargets targets =
      gl::RenderTargets::create({.target_extent = kOutput, .velocity = true, .reactive = false}).value();
  const auto drawn = geometry_at(stage->renderer(), targets, 1.0 / 60, 0);
  scenes::FrameView view;
  view.render = kOutput;
  view.seconds = 1.0 / 60;
  ASSERT_TRUE(renderer->draw(targets, view).ok());
  const gl::TargetPixels pixels =
      gl::read_targets(targets, kOutput).value();  // what the honest sky has written
  ASSERT_TRUE(drawn.ok()) << drawn.status().message();
  ASSERT_EQ(drawn->velocity.size(), pixels.depth.size());
  constexpr float kHalfRounding = 4e-6f;  // a step of velocities below 1/128: drivers may cut off
  int sky = 0;
  for (std::size_t i = 0; i < pixels.depth.size(); ++i) {
    const Vec2 v = drawn->velocity[i];
    ASSERT_NEAR(v.x, glm::unpackHalf1x16(pixels.velocity[2 * i]), kHalfRounding) << i;
    ASSERT_NEAR(v.y, glm::unpackHalf1x16(pixels.velocity[2 * i + 1]), kHalfRounding) << i;
    sky += drawn->depth[i] == 0 && std::abs(v.x) > 0.001f ? 1 : 0;
  }
  EXPECT_GT(sky, 3000);
}

struct ThinScene {
  const char* name;
  double thin;  // at least this part of the pixels
  double behind;
};

// The scenes that are there for thin things have them before something else, which is most of the picture.
class ThinSceneTest : public ::testing::TestWithParam<ThinScene> {};

TEST_P(ThinSceneTest, ShowsWhatItIsFor) {
  const auto stage = stage_of(GetParam().name, {320, 180});
  ASSERT_NE(stage, nullptr);
  const Conditions conditions{
      .output = {320, 180}, .frames = 1, .warm_up = 24, .history_warm_up = {}, .fps = 60};
  const auto masks = masks_of_frames(stage->renderer(), stage->scene(), conditions);
  ASSERT_TRUE(masks.ok()) << masks.status().message();
  ASSERT_EQ(masks->size(), 1u);
  const auto part = [&](Region region) {
    const auto& regions = masks->front().regions;
    return static_cast<double>(std::count(regions.begin(), regions.end(), region)) /
           static_cast<double>(regions.size());
  };
  EXPECT_GT(part(Region::kThin), GetParam().thin);
  EXPECT_GT(part(Region::kBehindThin), GetParam().behind);
  EXPECT_LT(part(Region::kThin), 0.35);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ThinSceneTest,
                         ::testing::ValuesIn(std::to_array<ThinScene>(
                             {{"cables", 0.03, 0.1}, {"wires", 0.05, 0.1}, {"fence", 0.1, 0.1}})),
                         [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace quincunx::bench
