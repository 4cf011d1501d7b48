// SPDX-License-Identifier: MIT
// The parts of the predictive controller against values computed by hand.
#include <gtest/gtest.h>

#include "cost_model.h"
#include "level_tracker.h"
#include "presentation_backlog.h"

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

}  // namespace
}  // namespace quincunx
