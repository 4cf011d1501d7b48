// SPDX-License-Identifier: MIT
// When the method changes, and how.
#include "method_choice.h"

#include <gtest/gtest.h>

namespace quincunx {
namespace {

constexpr MethodChoice::Settings kSettings = {.hysteresis = 0.05, .rest_ms = 1000, .fade_frames = 4};
constexpr double kFrameMs = 20;

class MethodChanges : public ::testing::Test {
 protected:
  using Situation = MethodChoice::Situation;

  // Frames in which method `best` would save `gain`.
  void run(int frames, std::size_t best, double gain, Situation now = {.both_fit = true}) {
    for (int i = 0; i < frames; ++i) {
      now.next_frame = ++frame_;
      now.frame_ms = kFrameMs;
      now.best = best;
      now.gain = gain;
      choice_.advance(now);
      now.cut = false;
    }
  }
  void grow_old() { run(100, 0, 0); }

  MethodChoice choice_{kSettings, 0};
  std::uint64_t frame_ = 0;
};

TEST_F(MethodChanges, AGainWithinTheHysteresisIsLetBe) {
  grow_old();
  run(500, 1, 0.04);
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, AGainHasToLastFourFrames) {
  grow_old();
  for (int i = 0; i < 100; ++i) {
    run(3, 1, 0.2);
    run(1, 0, 0);
  }
  EXPECT_EQ(choice_.method(), 0u);
  run(4, 1, 0.2);
  EXPECT_EQ(choice_.method(), 1u);
}

TEST_F(MethodChanges, AChangeIsFadedInEvenly) {
  grow_old();
  run(4, 1, 0.2);
  for (int step = 1; step <= 4; ++step) {
    ASSERT_EQ(choice_.fading_from(), 0u);
    ASSERT_NEAR(choice_.weight(), step / 5.0, 1e-12);
    run(1, 0, 0.9);  // nothing turns back on the way
  }
  EXPECT_FALSE(choice_.fading_from());
  EXPECT_EQ(choice_.weight(), 1);
  EXPECT_EQ(choice_.method(), 1u);
}

TEST_F(MethodChanges, OneChangeASecond) {
  grow_old();
  run(4, 1, 0.2);
  ASSERT_EQ(choice_.method(), 1u);
  run(49, 0, 0.2);
  EXPECT_EQ(choice_.method(), 1u);
  run(1, 0, 0.2);
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, WhatMustBeDoesNotWaitForRest) {
  grow_old();
  run(4, 1, 0.2);
  run(12, 2, 0, {.must = true, .both_fit = false});
  EXPECT_EQ(choice_.method(), 2u);
  EXPECT_FALSE(choice_.fading_from());
}

TEST_F(MethodChanges, HeldFramesChangeNothing) {
  grow_old();
  run(50, 1, 0.5, {.held = true, .both_fit = true});
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, FastMotionAndTooLittleTimeNeedNoFade) {
  grow_old();
  run(4, 1, 0.2, {.masked = true, .both_fit = true});
  EXPECT_EQ(choice_.method(), 1u);
  EXPECT_FALSE(choice_.fading_from());
  run(60, 0, 0.2, {.both_fit = false});
  EXPECT_EQ(choice_.method(), 0u);
  EXPECT_FALSE(choice_.fading_from());
}

TEST_F(MethodChanges, AYoungShotMayChangeOnceAtOnce) {
  grow_old();
  run(4, 1, 0.2);
  run(10, 1, 0);
  run(1, 2, 0.2, {.both_fit = true, .cut = true});
  run(1, 2, 0.2);
  EXPECT_EQ(choice_.method(), 2u);
  EXPECT_FALSE(choice_.fading_from());
  run(8, 0, 0.2);
  EXPECT_EQ(choice_.method(), 2u);
}

TEST_F(MethodChanges, ACutEndsAFade) {
  grow_old();
  run(5, 1, 0.2);
  ASSERT_TRUE(choice_.fading_from());
  run(1, 1, 0, {.both_fit = true, .cut = true});
  EXPECT_FALSE(choice_.fading_from());
  EXPECT_EQ(choice_.weight(), 1);
}

TEST_F(MethodChanges, LostFramesShortenAFade) {
  grow_old();
  run(4, 1, 0.2);
  frame_ += 10;
  run(1, 1, 0);
  EXPECT_FALSE(choice_.fading_from());
}

}  // namespace
}  // namespace quincunx
