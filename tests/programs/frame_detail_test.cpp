// SPDX-License-Identifier: MIT
// What follows the resolution or limits it, without a device.
#include "programs/frame_detail.h"

#include <gtest/gtest.h>

#include <cmath>

#include "programs/camera_streak.h"

namespace quincunx::scenes {
namespace {

FrameView view_at(int frame) {
  FrameView view;
  view.seconds = frame / 50.0;
  view.previous_seconds = (frame - 1) / 50.0;
  return view;
}

TEST(FrameDetail, IsWholeAtFullResolution) {
  FrameDetail detail = FrameDetail::create().value();
  for (int frame = 0; frame < 100; ++frame) {
    FrameView view = view_at(frame);
    detail.follow(1, view);
    EXPECT_EQ(view.least_size, 0);
    EXPECT_EQ(view.shadow_age, 0);
  }
}

TEST(FrameDetail, FollowsTheResolutionDownAndUp) {
  FrameDetail detail = FrameDetail::create().value();
  FrameView view;
  for (int frame = 0; frame < 200; ++frame) {
    view = view_at(frame);
    detail.follow(0.25, view);
  }
  EXPECT_EQ(detail.level(), 3);
  EXPECT_FLOAT_EQ(view.least_size, 0.024f);
  EXPECT_GT(view.shadow_age, 3.0 / 50) << "kept for three frames";
  EXPECT_LT(view.shadow_age, 4.0 / 50);
  for (int frame = 200; frame < 400; ++frame) {
    view = view_at(frame);
    detail.follow(1, view);
  }
  EXPECT_EQ(detail.level(), 0);
  EXPECT_EQ(view.least_size, 0);
}

TEST(CameraStreak, IsNothingForACameraThatStandsStill) {
  EXPECT_EQ(camera_streak_px({}, 0.1f, {1280, 720}, 1), 0);
}

TEST(CameraStreak, OfAShiftIsTheShift) {
  CameraMotion motion;
  motion.clip_to_previous_clip[12] = 0.1f;  // every point was a twentieth of the width further right
  // Single precision: a few roundings of values up to 1.
  EXPECT_NEAR(camera_streak_px(motion, 0.1f, {1000, 500}, 0.5f), 0.5 * 0.05 * 1000, 1e-3);
}

TEST(CameraStreak, LeavesOutWhatWasBehindTheCamera) {
  CameraMotion motion;
  motion.clip_to_previous_clip[15] = -1;
  EXPECT_EQ(camera_streak_px(motion, 0.1f, {1000, 500}, 1), 0);
  motion.clip_to_previous_clip[15] = std::nanf("");
  EXPECT_EQ(camera_streak_px(motion, 0.1f, {1000, 500}, 1), 0);
}

}  // namespace
}  // namespace quincunx::scenes
