// SPDX-License-Identifier: MIT
#include "quincunx/predictive_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace quincunx {
namespace {

using Controller = std::unique_ptr<ResolutionController>;

constexpr LadderSettings kLadder = {.output = {1920, 1080}};
constexpr double kTarget = 16;

// Plays frames of a load, a quarter of which is fixed, with the queue always full.
class Player {
 public:
  explicit Player(PredictiveSettings settings = {}) {
    settings.ladder = kLadder;
    settings.target_ms = kTarget;
    queued_ = settings.buffers - 1;
    Result<Controller> made = make_predictive_controller(settings);
    EXPECT_TRUE(made.ok()) << made.status().message();
    controller_ = std::move(made).value();
  }

  // Draws the next frame: `level` is its time at the output resolution.
  double draw(double level, FrameTiming known = {}) {
    known.frame = ++frame_;
    known.render = controller_->next();
    known.gpu_ms = level * (0.25 + 0.75 * area());
    if (known.queued == FrameTiming::kUnknownQueue) known.queued = queued_;
    EXPECT_TRUE(controller_->observe(known).ok());
    return known.gpu_ms;
  }
  void settle(double level, int frames = 300) {
    for (int frame = 0; frame < frames; ++frame)
      draw(level);
  }
  double area() const { return controller_->ladder().area_fraction(controller_->next()); }
  double time_next(double level) const { return level * (0.25 + 0.75 * area()); }
  ResolutionController& operator*() { return *controller_; }

 private:
  Controller controller_;
  std::uint64_t frame_ = 0;
  int queued_ = 0;
};

TEST(PredictiveController, SettlesJustBelowTheTargetAndStays) {
  Player player;
  player.settle(24);
  EXPECT_LE(player.time_next(24), kTarget);
  EXPECT_GE(player.time_next(24), 0.985 * kTarget);
  const Extent settled = (*player).next();
  for (int frame = 0; frame < 1200; ++frame) {
    player.draw(24);
    ASSERT_EQ((*player).next(), settled) << frame;
  }
}

TEST(PredictiveController, FirstFrameTooSlowIsAnsweredAtOnce) {
  Player player;
  player.draw(30);
  EXPECT_LE(player.time_next(30), kTarget);
}

TEST(PredictiveController, OneSlowFrameIsRiddenOutWhileThereIsSlack) {
  Player player;
  player.settle(24);
  const double before = player.area();
  player.draw(34);
  EXPECT_EQ(player.area(), before);
  player.settle(24, 10);
  EXPECT_NEAR(player.area(), before, 0.03 * before);
}

TEST(PredictiveController, TwoSlowFramesAreAStep) {
  Player player;
  player.settle(20);
  player.draw(28);
  player.draw(28);
  EXPECT_LE(player.time_next(28), kTarget);
}

TEST(PredictiveController, OneSlowFrameIsAnsweredWhereTheNextWouldMiss) {
  Player player;
  player.settle(20);
  const double before = player.area();
  player.draw(38, {.queued = 1});  // nearly all the slack is gone; a second such frame would miss a refresh
  EXPECT_LT(player.area(), before);
}

TEST(PredictiveController, WithTwoBuffersOneSlowFrameIsAnswered) {
  Player player({.buffers = 2});
  player.settle(20);
  const double before = player.area();
  EXPECT_LE(player.time_next(20), kTarget);
  player.draw(28);
  EXPECT_LT(player.area(), before);
  EXPECT_LE(player.time_next(28), kTarget);
}

TEST(PredictiveController, RisesWithinFiveFrames) {
  Player player;
  player.settle(30);
  for (int frame = 0; frame < 5; ++frame)
    player.draw(18);
  EXPECT_GE(player.time_next(18), 0.95 * kTarget);
  EXPECT_LE(player.time_next(18), kTarget);
}

TEST(PredictiveController, InfeasibleLoadLeavesNoWindUp) {
  Player player;
  player.settle(20);
  for (int frame = 0; frame < 600; ++frame)
    player.draw(100, {.queued = 1, .missed_vsyncs = 2});
  EXPECT_EQ((*player).rung(), 0);
  for (int frame = 0; frame < 12; ++frame)
    player.draw(20);
  EXPECT_GE(player.time_next(20), 0.95 * kTarget);
  EXPECT_LE(player.time_next(20), kTarget);
}

TEST(PredictiveController, ProcessorBoundFramesHold) {
  Player player;
  player.settle(24);
  const Extent before = (*player).next();
  for (int frame = 0; frame < 60; ++frame) {
    player.draw(18, {.cpu_ms = 25, .interval_ms = 25, .queued = 1});
    ASSERT_EQ((*player).next(), before) << frame;
  }
  player.settle(18, 40);
  EXPECT_GT((*player).next().area(), before.area());
}

TEST(PredictiveController, FollowingTheProcessorIsOptIn) {
  Player player({.cpu_bound = CpuBound::kFollow});
  player.settle(24);
  const double spiked = player.area();
  player.draw(24, {.cpu_ms = 40, .interval_ms = 40, .queued = 1});  // a spike of the processor alone
  EXPECT_LE(player.area(), spiked);
  for (int frame = 0; frame < 60; ++frame)
    player.draw(24, {.cpu_ms = 22, .interval_ms = 22, .queued = 1});
  EXPECT_GT(player.time_next(24), 1.2 * kTarget);
  EXPECT_LE(player.time_next(24), 22);
  player.settle(24, 60);
  EXPECT_LE(player.time_next(24), kTarget);
}

TEST(PredictiveController, BlurLowersTheLimitOnlyIfAsked) {
  Player unaware;
  Player aware({.blur_aware = {.enabled = true}});
  for (int frame = 0; frame < 200; ++frame) {
    unaware.draw(10, {.blur_px = 40});
    aware.draw(10, {.blur_px = 40});
  }
  EXPECT_EQ(unaware.area(), 1);
  EXPECT_LE(aware.area(), 0.71 * 0.71);
  EXPECT_GT(aware.area(), 0.5);
  aware.settle(10, 100);
  EXPECT_EQ(aware.area(), 1);
}

TEST(PredictiveController, CalibrationMakesTheFirstMoveExact) {
  Result<CostTable> table = CostTable::create();
  ASSERT_TRUE(table.ok());
  for (const double area : {0.25, 0.5, 1.0})
    ASSERT_TRUE(table->record(0, area, 10 * (0.6 + 0.4 * area)).ok());
  const auto first_move = [](const PredictiveSettings& settings) {
    const Controller controller = std::move(make_predictive_controller(settings)).value();
    EXPECT_TRUE(controller->observe({.frame = 1, .render = {1920, 1080}, .gpu_ms = 18, .queued = 2}).ok());
    return 18 * (0.6 + 0.4 * controller->ladder().area_fraction(controller->next()));
  };
  const PredictiveSettings guessed = {.ladder = kLadder, .target_ms = kTarget};
  PredictiveSettings calibrated = guessed;
  calibrated.calibration = table.value();
  EXPECT_GT(first_move(guessed), kTarget);
  EXPECT_LE(first_move(calibrated), kTarget);
  EXPECT_GE(first_move(calibrated), 0.9 * kTarget);
}

// Frames under way were sized before the answer; the controller counts what they will still cost.
TEST(PredictiveController, LateTimersCountFramesUnderWay) {
  const auto area_after_step = [](int latency) {
    const Controller controller =
        std::move(make_predictive_controller({.ladder = kLadder, .target_ms = kTarget})).value();
    std::uint64_t frame = 0;
    const auto draw = [&](double level, int queued) {
      const double area = controller->ladder().area_fraction(controller->next());
      ++frame;
      EXPECT_TRUE(controller
                      ->observe({.frame = frame,
                                 .next_frame = frame + static_cast<std::uint64_t>(latency),
                                 .render = controller->next(),
                                 .gpu_ms = level * (0.25 + 0.75 * area),
                                 .queued = queued})
                      .ok());
    };
    for (int count = 0; count < 300; ++count)
      draw(20, 2);
    draw(27, 1);  // 1.35 targets: one more fits the slack, three do not
    return controller->ladder().area_fraction(controller->next());
  };
  EXPECT_LT(area_after_step(3), area_after_step(1));
}

TEST(PredictiveController, TargetCanChange) {
  Player player;
  player.settle(24);
  ASSERT_TRUE((*player).set_target_ms(2 * kTarget).ok());
  player.settle(24, 30);
  EXPECT_EQ(player.area(), 1);
  ASSERT_TRUE((*player).set_target_ms(kTarget).ok());
  player.settle(24, 10);
  EXPECT_LE(player.time_next(24), kTarget);
}

TEST(PredictiveController, BadSettingsNameTheField) {
  const auto refused = [](const std::function<void(PredictiveSettings&)>& change, const char* field) {
    PredictiveSettings settings = {.ladder = kLadder};
    change(settings);
    const Result<Controller> controller = make_predictive_controller(settings);
    ASSERT_FALSE(controller.ok()) << field;
    EXPECT_EQ(controller.status().code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(controller.status().message().rfind(field, 0), 0u) << controller.status().message();
  };
  const double nan = std::nan("");
  for (const double bad : {0.0, -1.0, nan, 1.0 / 0.0}) {
    refused([bad](PredictiveSettings& s) { s.target_ms = bad; }, "target_ms");
    refused([bad](PredictiveSettings& s) { s.blur_aware.full_px = bad; }, "blur_aware");
    refused([bad](PredictiveSettings& s) { s.blur_aware.lowest_scale = bad; }, "blur_aware.lowest_scale");
  }
  for (const double bad : {-0.1, 0.95, nan}) {
    refused([bad](PredictiveSettings& s) { s.fixed_part = bad; }, "fixed_part");
  }
  for (const int bad : {-1, 0, 1, 9})
    refused([bad](PredictiveSettings& s) { s.buffers = bad; }, "buffers");
  refused([](PredictiveSettings& s) { s.ladder.max_scale = 0.1; }, "max_scale");
}

}  // namespace
}  // namespace quincunx
