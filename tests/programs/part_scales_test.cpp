// SPDX-License-Identifier: MIT
// A part's controller on simulated costs, and a scene's detail.
#include "frames/part_scales.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace quincunx::scenes {
namespace {

constexpr Extent kWhole{2048, 2048};
constexpr int kStep = 128;

// A part whose whole costs `full_ms`, a fifth of it whatever its resolution, and varies by a few percent.
struct Load {
  double full_ms;
  std::mt19937 random{5};

  double operator()(Extent extent) {
    const double area = static_cast<double>(extent.area()) / static_cast<double>(kWhole.area());
    return full_ms * (0.2 + 0.8 * area) * std::uniform_real_distribution<>(0.97, 1.03)(random);
  }
};

// Mean time of the last frames of a run in which each `every`th frame is timed.
double held_ms(PartController& controller, Load load, int every, std::uint64_t first = 0) {
  constexpr std::uint64_t kFrames = 400, kCounted = 100;
  double sum = 0;
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    const Extent extent = controller.next();
    const double ms = load(extent);
    if (frame % static_cast<std::uint64_t>(every) == 0) controller.learn(first + frame, extent, ms);
    if (frame >= kFrames - kCounted) sum += ms / kCounted;
  }
  return sum;
}

PartController controller_for(double budget_ms) {
  return PartController::create(kWhole, kStep, budget_ms).value();
}

TEST(PartController, HoldsItsBudgetWhetherEveryFrameIsTimedOrOneOfFour) {
  for (const int every : {1, 4}) {
    PartController controller = controller_for(2);
    const double ms = held_ms(controller, {5}, every);
    EXPECT_LT(ms, 2.1) << every;
    EXPECT_GT(ms, 1.6) << every;
    EXPECT_LT(controller.next().width, kWhole.width);
  }
}

TEST(PartController, FollowsALoadThatGrowsAndShrinks) {
  PartController controller = controller_for(2);
  held_ms(controller, {5}, 4);
  const Extent loaded = controller.next();
  EXPECT_LT(held_ms(controller, {8}, 4, 400), 2.2);
  EXPECT_LT(controller.next().area(), loaded.area());
  held_ms(controller, {1.5}, 4, 800);
  EXPECT_EQ(controller.next(), kWhole) << "there is room for all of it";
}

TEST(PartController, StaysAtTheWholeUntilItLearnsAndAtTheLeastWhereNothingFits) {
  PartController controller = controller_for(0.1);
  EXPECT_EQ(controller.next(), kWhole);
  held_ms(controller, {5}, 1);
  EXPECT_EQ(controller.next(), (Extent{kStep, kStep}));
}

TEST(PartController, WhatIsNoTimeChangesNothing) {
  PartController controller = controller_for(2);
  controller.learn(5, kWhole, 4);
  const Extent chosen = controller.next();
  for (const double ms : {0.0, -1.0, std::nan(""), 1e9}) {
    controller.learn(6, kWhole, ms);
    EXPECT_EQ(controller.next(), chosen) << ms;
  }
  controller.learn(4, kWhole, 40);  // late
  EXPECT_EQ(controller.next(), chosen);
}

TEST(PartController, RefusesWhatIsNoPart) {
  EXPECT_FALSE(PartController::create({0, 5}, 2, 1).ok());
  EXPECT_FALSE(PartController::create(kWhole, 0, 1).ok());
  EXPECT_FALSE(PartController::create(kWhole, 2, 0).ok());
  EXPECT_FALSE(PartController::create(kWhole, 2, std::nan("")).ok());
}

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

}  // namespace
}  // namespace quincunx::scenes
