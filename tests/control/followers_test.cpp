// SPDX-License-Identifier: MIT
// Followers of the controller: detail that is left out, and the output's resolution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "quincunx/control/detail_follower.h"
#include "quincunx/control/output_follower.h"

namespace quincunx {
namespace {

DetailFollower make(const DetailSettings& settings) {
  Result<DetailFollower> follower = DetailFollower::create(settings);
  EXPECT_TRUE(follower.ok()) << follower.status().message();
  return std::move(follower).value();
}

// Levels 0 to 5 for areas 1 to .5 in steps of .1, left .075 beyond their middle.
constexpr DetailSettings kSixLevels = {.levels = 6, .full_area = 1, .min_area = 0.5, .rest_frames = 0};

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
    refused([bad](DetailSettings& s) { s.min_area = bad; }, "min_area");
  }
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    refused([bad](DetailSettings& s) { s.hysteresis = bad; }, "hysteresis");
  }
  refused([](DetailSettings& s) { s.rest_frames = -1; }, "rest_frames");
}

TEST(DualOutput, GrowsWhenTheRenderExtentFillsIt) {
  const ResolutionLadder outputs =
      ResolutionLadder::create({.output_extent = {3840, 2160}, .min_scale = 0.5, .order = AxisOrder::kBoth})
          .value();
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
  const ResolutionLadder outputs = ResolutionLadder::create({.output_extent = {640, 360}}).value();
  std::int64_t before = 0;
  for (int rung = 0; rung < outputs.size(); ++rung) {
    const Extent output = dual_output(outputs, outputs[rung]).value();
    EXPECT_GE(output.area(), before);
    EXPECT_GE(output.area(), outputs[rung].area());
    before = output.area();
  }
}

constexpr Extent kDisplay{1280, 720};

Extent at(double scale) {
  return {static_cast<int>(std::lround(kDisplay.width * scale)),
          static_cast<int>(std::lround(kDisplay.height * scale))};
}

OutputFollower follower(OutputSettings settings = {}) {
  settings.display = kDisplay;
  return OutputFollower::create(settings).value();
}

TEST(OutputFollower, FollowsTheFirstFrameAtOnce) {
  OutputFollower full = follower();
  EXPECT_EQ(full.output(), kDisplay);
  EXPECT_EQ(full.observe(kDisplay), kDisplay);
  OutputFollower half = follower();
  EXPECT_EQ(half.observe(at(.3)), half.min_output());
  // Steps of 80 pixels: of the height, four fit into the half.
  EXPECT_EQ(half.min_output(), (Extent{640, 400}));
}

// For every viewport the output, once at rest, is the smallest step that it fills to .64 at most, or a step above.
TEST(OutputFollower, AViewportFillsTheOutputNoMoreThanItMay) {
  for (double scale = .3; scale <= .8; scale += .01) {
    OutputFollower outputs = follower({.hysteresis = 0});
    const Extent render = at(scale);
    const Extent output = outputs.observe(render);
    const double filled = static_cast<double>(render.area()) / static_cast<double>(output.area());
    EXPECT_LE(filled, .64 + 1e-9) << scale;
    if (output != outputs.min_output()) {
      EXPECT_GE(filled, .64 * .8) << scale;
    }
  }
}

TEST(OutputFollower, RestsAfterAChange) {
  OutputFollower outputs = follower({.rest_frames = 5});
  const Extent low = outputs.observe(at(.5));
  const Extent larger = at(.6);
  ASSERT_LT(larger.area(), low.area());
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(outputs.observe(larger), low) << i;
  EXPECT_GT(outputs.observe(larger).area(), low.area());
}

TEST(OutputFollower, AViewportThatOutgrowsTheOutputEndsItsRest) {
  OutputFollower outputs = follower({.rest_frames = 5});
  const Extent low = outputs.observe(at(.5));
  ASSERT_LT(low.area(), kDisplay.area());
  EXPECT_EQ(outputs.observe(low), low);
  EXPECT_EQ(outputs.observe(kDisplay), kDisplay);
  EXPECT_EQ(outputs.observe(at(.5)), kDisplay) << "and the rest begins anew";
}

// A viewport that goes to and fro by less than the hysteresis keeps its output.
TEST(OutputFollower, DoesNotFlutter) {
  OutputFollower outputs = follower({.rest_frames = 0});
  outputs.observe(at(.62));
  const Extent kept = outputs.observe(at(.60));
  for (int i = 0; i < 100; ++i)
    ASSERT_EQ(outputs.observe(at(i % 2 == 0 ? .62 : .60)), kept) << i;
  EXPECT_LT(outputs.observe(at(.5)).area(), kept.area());
}

TEST(OutputFollower, MovesInFewSteps) {
  OutputFollower outputs = follower({.hysteresis = 0, .rest_frames = 0});
  Extent before = outputs.observe(at(.3));
  int changes = 0;
  for (double scale = .3; scale <= 1; scale += .002) {
    const Extent now = outputs.observe(at(scale));
    EXPECT_GE(now.area(), before.area());
    changes += now != before ? 1 : 0;
    before = now;
  }
  EXPECT_EQ(before, kDisplay);
  EXPECT_GE(changes, 4);
  EXPECT_LE(changes, 16);
}

TEST(OutputFollower, AnEmptyViewportChangesNothing) {
  OutputFollower outputs = follower();
  const Extent before = outputs.observe(at(.5));
  EXPECT_EQ(outputs.observe({0, 100}), before);
}

TEST(OutputFollower, RefusesWhatIsOutOfRange) {
  const auto message = [](OutputSettings settings) {
    const auto made = OutputFollower::create(settings);
    return made.ok() ? std::string() : std::string(made.status().message());
  };
  EXPECT_EQ(message({.display = kDisplay}), "");
  EXPECT_NE(message({.display = {0, 720}}).find("output"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .min_scale = 0}).find("min_scale"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .steps = 0}).find("steps"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .max_filled = 1.5}).find("max_filled"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .hysteresis = 1}).find("hysteresis"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .rest_frames = -1}).find("rest_frames"), std::string::npos);
}

}  // namespace

}  // namespace quincunx
