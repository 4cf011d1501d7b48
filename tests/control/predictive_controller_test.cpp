// SPDX-License-Identifier: MIT
// The parts of the predictive controller against values computed by hand, and the whole on loads that are played.
#include "quincunx/control/predictive_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "predictive_model.h"

namespace quincunx {
namespace {

TEST(CostModel, AreaForIsTheInverseOfWork) {
  const CostModel model(0.25);
  EXPECT_DOUBLE_EQ(model.work(1), 1);
  EXPECT_DOUBLE_EQ(model.work(0.5), 0.625);
  EXPECT_DOUBLE_EQ(model.area_for(0.625), 0.5);
}

TEST(CostModel, LearnsTheFixedPartFromPairs) {
  CostModel model(0.25);
  // t = 20 (.5 + .5 p): 20 at 1, 15 at .5. Slope 10, level 20: b = .5 with weight .25, against .25 with .004.
  model.learn(1, 20);
  EXPECT_EQ(model.fixed_part(), 0.25);
  model.learn(0.5, 15);
  EXPECT_DOUBLE_EQ(model.fixed_part(), (0.25 * 0.5 + 0.004 * 0.25) / 0.254);
  const double before = model.fixed_part();
  model.learn(0.49, 3);  // too similar an area
  EXPECT_EQ(model.fixed_part(), before);
  model.learn(0.9, 2);  // more pixels in less time: the load has changed
  EXPECT_EQ(model.fixed_part(), before);
}

TEST(CostModel, APairFurtherApartThanAnyLadderIsForgotten) {
  CostModel model(0.25);
  model.learn(1, 10);
  model.learn(1e6, 11);
  EXPECT_GT(model.fixed_part(), 0.89);
  for (int pair = 0; pair < 20; ++pair) {
    model.learn(1, 20);
    model.learn(0.5, 12.5);
  }
  EXPECT_NEAR(model.fixed_part(), 0.25, 0.001);
}

TEST(CostModel, DoubtAsksForLessAndVanishes) {
  CostModel model(0.25);
  // Half the work from area 1, with b = .4 in place of .25: (.5 - .4) / .6.
  EXPECT_DOUBLE_EQ(model.cautious_area_for(0.5, 1), (0.5 - 0.4) / 0.6);
  EXPECT_LT(model.cautious_area_for(0.5, 1), model.area_for(0.5));
  for (int pair = 0; pair < 10; ++pair) {
    model.learn(1, 20);
    model.learn(0.5, 12.5);
  }
  EXPECT_NEAR(model.cautious_area_for(0.5, 1), model.area_for(0.5), 1e-6);
}

TEST(LevelTracker, IgnoresOneOutlierAndFollowsTwo) {
  LevelTracker tracker;
  for (int frame = 0; frame < 20; ++frame)
    tracker.observe(0.5, 10);
  EXPECT_DOUBLE_EQ(tracker.level(), 20);
  tracker.observe(0.5, 15);
  EXPECT_DOUBLE_EQ(tracker.level(), 20);
  EXPECT_DOUBLE_EQ(tracker.suspect(), 30);
  tracker.observe(0.5, 10);
  EXPECT_EQ(tracker.suspect(), 0);
  tracker.observe(0.5, 15);
  tracker.observe(0.5, 16);
  EXPECT_DOUBLE_EQ(tracker.level(), 32) << "the larger of the two";
  EXPECT_EQ(tracker.suspect(), 0);
  tracker.observe(0.5, 9);
  tracker.observe(0.5, 8);
  EXPECT_DOUBLE_EQ(tracker.level(), 18) << "the larger of the two, downwards as well";
}

TEST(LevelTracker, ResidualsWithinTheNoiseMoveItSlowly) {
  LevelTracker tracker;
  tracker.observe(1, 10);
  tracker.observe(1, 10.1);  // the first residual is all trend: rate 1
  EXPECT_DOUBLE_EQ(tracker.level(), 10.1);
  tracker.observe(1, 10.1);
  // trend .93 * .07 * .01, magnitude the same: still rate 1, but no residual.
  EXPECT_DOUBLE_EQ(tracker.level(), 10.1);
  EXPECT_NEAR(tracker.trend(), 0.93 * 0.07 * 0.01, 1e-12);
  // sigma: .01, then towards 1.25 * .01, then towards 0, each by .04.
  EXPECT_NEAR(tracker.sigma(), (0.01 + 0.04 * (0.0125 - 0.01)) * 0.96, 1e-12);
}

TEST(LevelTracker, OutliersCountInTheMeanLevelAndAsExcess) {
  LevelTracker tracker;
  for (int frame = 0; frame < 400; ++frame)
    tracker.observe(1, frame % 4 == 3 ? 13 : 10);
  EXPECT_NEAR(tracker.level(), 10, 1e-9);
  EXPECT_NEAR(tracker.mean_level(), 10.75, 0.1);  // (10 * 3 + 13) / 4
  EXPECT_NEAR(tracker.recurring_excess(), 3, 1e-9);
  LevelTracker once;
  for (int frame = 0; frame < 100; ++frame)
    once.observe(1, frame == 50 ? 13 : 10);
  EXPECT_EQ(once.recurring_excess(), 0);
}

constexpr double kRefresh = 10;

TEST(PresentationBacklog, AddsTimesAndTakesAwayRefreshes) {
  PresentationBacklog backlog(3);
  EXPECT_EQ(backlog.slack(kRefresh), 10);
  const auto observe = [&](double gpu_ms, int queued = -1, double interval_ms = 0, double cpu_ms = 0,
                           int missed = 0) {
    backlog.observe({gpu_ms, cpu_ms, interval_ms, queued, missed}, kRefresh);
    return backlog.now();
  };
  EXPECT_EQ(observe(9), 0);
  EXPECT_EQ(observe(12), 2);
  EXPECT_EQ(observe(13), 5);
  EXPECT_EQ(observe(9), 4);
  EXPECT_EQ(observe(17), 1) << "11 is a missed refresh";
  EXPECT_EQ(observe(12, -1, 20), 2) << "an interval longer than the 17 before: it waited for the display";
  EXPECT_EQ(observe(10, -1, 20, 20), 10) << "it waited for the processor: the queue ran empty";
}

TEST(PresentationBacklog, QueueBoundsIt) {
  PresentationBacklog backlog(3);
  const auto observe = [&](double gpu_ms, int queued, int missed = 0) {
    backlog.observe({gpu_ms, 0, 0, queued, missed}, kRefresh);
    return backlog.now();
  };
  EXPECT_EQ(observe(9, 1), 10) << "the worst until the queue is seen full";
  EXPECT_EQ(observe(9, 2), 0);
  EXPECT_EQ(observe(12, 1), 2);
  EXPECT_EQ(observe(9, 2), 0) << "full again, whatever was computed";
  EXPECT_EQ(observe(12, 1, 1), 10) << "a miss that could not be foreseen: the worst again";
  EXPECT_EQ(observe(9, 2), 0);
}

TEST(PresentationBacklog, MoreBuffersMoreSlack) {
  PresentationBacklog backlog(4);
  EXPECT_EQ(backlog.slack(kRefresh), 20);
  const auto observe = [&](double gpu_ms, int queued) {
    backlog.observe({gpu_ms, 0, 0, queued, 0}, kRefresh);
    return backlog.now();
  };
  EXPECT_EQ(observe(9, 3), 0);
  EXPECT_EQ(observe(25, 1), 15);
  EXPECT_EQ(observe(9, 2), 10) << "two waiting: between 0 and 10";
  PresentationBacklog none(2);
  EXPECT_EQ(none.slack(kRefresh), 0);
}

using Controller = std::unique_ptr<ResolutionController>;

constexpr LadderSettings kLadder = {.output_extent = {1920, 1080}};
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
    known.render_extent = controller_->next();
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
    EXPECT_TRUE(
        controller->observe({.frame = 1, .render_extent = {1920, 1080}, .gpu_ms = 18, .queued = 2}).ok());
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
                                 .render_extent = controller->next(),
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
    refused([bad](PredictiveSettings& s) { s.blur_aware.min_scale = bad; }, "blur_aware.min_scale");
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
