// SPDX-License-Identifier: MIT
#include "quincunx/detail_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace quincunx {
namespace {

DetailFollower make(const DetailSettings& settings) {
  Result<DetailFollower> follower = DetailFollower::create(settings);
  EXPECT_TRUE(follower.ok()) << follower.status().message();
  return std::move(follower).value();
}

// Levels 0 to 5 for areas 1 to .5 in steps of .1, left .075 beyond their middle.
constexpr DetailSettings kSixLevels = {.levels = 6, .full_area = 1, .least_area = 0.5, .rest_frames = 0};

TEST(DetailFollower, LevelsFollowTheArea) {
  DetailFollower follower = make(kSixLevels);
  EXPECT_EQ(follower.level(), 0);
  EXPECT_EQ(follower.share(), 1);
  EXPECT_EQ(follower.observe(0.93), 0);
  EXPECT_EQ(follower.observe(0.92), 1);
  EXPECT_EQ(follower.observe(0.97), 1);
  EXPECT_EQ(follower.observe(0.98), 0);
  for (int frame = 0; frame < 20; ++frame)
    follower.observe(0.01);
  EXPECT_EQ(follower.level(), 5);
  EXPECT_EQ(follower.share(), 0);
  for (int frame = 0; frame < 20; ++frame)
    follower.observe(2);
  EXPECT_EQ(follower.level(), 0);
}

TEST(DetailFollower, OneLevelAtATimeAndThenRest) {
  DetailSettings settings = kSixLevels;
  settings.rest_frames = 3;
  DetailFollower follower = make(settings);
  const int expected[] = {1, 1, 1, 1, 2, 2, 2, 2, 3};
  for (const int level : expected)
    EXPECT_EQ(follower.observe(0.5), level);
}

TEST(DetailFollower, SmallMovesOfTheResolutionChangeNothing) {
  DetailFollower follower = make(kSixLevels);
  for (int frame = 0; frame < 10; ++frame)
    follower.observe(0.7);
  const int level = follower.level();
  for (int frame = 0; frame < 100; ++frame)
    EXPECT_EQ(follower.observe(0.7 + 0.04 * std::sin(frame)), level);
}

TEST(DetailFollower, BadAreasChangeNothing) {
  DetailFollower follower = make(kSixLevels);
  for (int frame = 0; frame < 10; ++frame)
    follower.observe(0.7);
  for (const double bad : {0.0, -1.0, std::nan(""), 1.0 / 0.0})
    EXPECT_EQ(follower.observe(bad), 3);
}

TEST(DetailFollower, BadSettingsNameTheField) {
  const auto refused = [](const std::function<void(DetailSettings&)>& change, const char* field) {
    DetailSettings settings;
    change(settings);
    const Result<DetailFollower> follower = DetailFollower::create(settings);
    ASSERT_FALSE(follower.ok()) << field;
    EXPECT_EQ(follower.status().message().rfind(field, 0), 0u) << follower.status().message();
  };
  for (const int bad : {-1, 0, 1, 65})
    refused([bad](DetailSettings& s) { s.levels = bad; }, "levels");
  for (const double bad : {0.0, -1.0, 5.0, std::nan("")}) {
    refused([bad](DetailSettings& s) { s.full_area = bad; }, "full_area");
  }
  for (const double bad : {0.0, -1.0, 0.8, std::nan("")}) {
    refused([bad](DetailSettings& s) { s.least_area = bad; }, "least_area");
  }
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    refused([bad](DetailSettings& s) { s.hysteresis = bad; }, "hysteresis");
  }
  refused([](DetailSettings& s) { s.rest_frames = -1; }, "rest_frames");
}

TEST(DualOutput, GrowsWhenTheRenderExtentFillsIt) {
  const ResolutionLadder outputs =
      ResolutionLadder::create({.output = {3840, 2160}, .min_scale = 0.5, .order = AxisOrder::kBoth}).value();
  EXPECT_EQ(dual_output(outputs, {960, 540}).value(), (Extent{1920, 1080}));
  EXPECT_EQ(dual_output(outputs, {1536, 864}).value(), (Extent{1920, 1080})) << "exactly .8 per axis";
  // 1538 * 864 / .64 = 2076300 pixels: more than 1922 x 1080, and the rung after that is 1922 x 1082.
  EXPECT_EQ(dual_output(outputs, {1538, 864}).value(), (Extent{1922, 1082}));
  EXPECT_EQ(dual_output(outputs, {3072, 1728}).value(), (Extent{3840, 2160}));
  EXPECT_EQ(dual_output(outputs, {3840, 2160}).value(), (Extent{3840, 2160}));
  EXPECT_FALSE(dual_output(outputs, {0, 10}).ok());
  for (const double bad : {0.0, -1.0, 1.1, std::nan("")})
    EXPECT_FALSE(dual_output(outputs, {64, 64}, bad).ok());
}

TEST(DualOutput, RisesWithTheRenderExtent) {
  const ResolutionLadder outputs = ResolutionLadder::create({.output = {640, 360}}).value();
  std::int64_t before = 0;
  for (int rung = 0; rung < outputs.size(); ++rung) {
    const Extent output = dual_output(outputs, outputs[rung]).value();
    EXPECT_GE(output.area(), before);
    EXPECT_GE(output.area(), outputs[rung].area());
    before = output.area();
  }
}

}  // namespace
}  // namespace quincunx
