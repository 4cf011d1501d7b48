// SPDX-License-Identifier: MIT
#include "quincunx/output_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace quincunx {
namespace {

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
  EXPECT_EQ(half.observe(at(.3)), half.least());
  // Steps of 80 pixels: of the height, four fit into the half.
  EXPECT_EQ(half.least(), (Extent{640, 400}));
}

// Of every viewport the output, once at rest, is the smallest step that it fills to .64 at most, or a step above.
TEST(OutputFollower, AViewportFillsTheOutputNoMoreThanItMay) {
  for (double scale = .3; scale <= .8; scale += .01) {
    OutputFollower outputs = follower({.hysteresis = 0});
    const Extent render = at(scale);
    const Extent output = outputs.observe(render);
    const double filled = static_cast<double>(render.area()) / static_cast<double>(output.area());
    EXPECT_LE(filled, .64 + 1e-9) << scale;
    if (output != outputs.least()) {
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
  EXPECT_NE(message({.display = kDisplay, .most_filled = 1.5}).find("most_filled"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .hysteresis = 1}).find("hysteresis"), std::string::npos);
  EXPECT_NE(message({.display = kDisplay, .rest_frames = -1}).find("rest_frames"), std::string::npos);
}

}  // namespace
}  // namespace quincunx
