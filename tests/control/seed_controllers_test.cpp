// SPDX-License-Identifier: MIT
// The two seed controllers against values computed by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "quincunx/control/resolution_controller.h"

namespace quincunx {
namespace {

using Controller = std::unique_ptr<ResolutionController>;

// A square output of 1000 pixels with both axes in turns: a scale of .9 is the rung nearest to 900 x 900 from
// below, that is 900 x 900 itself.
constexpr LadderSettings kLadder = {.output_extent = {1000, 1000}, .order = AxisOrder::kBoth};

Controller proportional(ProportionalSettings settings) {
  settings.ladder = kLadder;
  Result<Controller> controller = make_proportional_controller(settings);
  EXPECT_TRUE(controller.ok()) << controller.status().message();
  return std::move(controller).value();
}

Controller minimum_of_n(MinimumOfNSettings settings) {
  settings.ladder = kLadder;
  Result<Controller> controller = make_minimum_of_n_controller(settings);
  EXPECT_TRUE(controller.ok()) << controller.status().message();
  return std::move(controller).value();
}

Extent after(ResolutionController& controller, FrameTiming timing) {
  static std::uint64_t frame = 0;
  timing.frame = ++frame;
  if (timing.render_extent == Extent{}) timing.render_extent = controller.next();
  EXPECT_TRUE(controller.observe(timing).ok());
  return controller.next();
}

TEST(ProportionalController, StartsAtTheTop) {
  EXPECT_EQ(proportional({})->next(), (Extent{1000, 1000}));
  EXPECT_STREQ(proportional({})->name(), "proportional");
}

TEST(ProportionalController, StepIsProportionalToTheError) {
  const Controller controller = proportional({.target_ms = 20, .rate = 0.2});
  // t = (29 + 31) / 2 = 30; s = 1 + .2 * 1 * (1 - 30 / 20) = .9
  EXPECT_EQ(after(*controller, {.gpu_ms = 29, .interval_ms = 31}), (Extent{900, 900}));
  // t = 25; s = .9 + .2 * .9 * (1 - 25 / 20) = .9 - .045 = .855; largest rung within .855^2 = 731025 pixels:
  // 854 x 856 = 731024
  EXPECT_EQ(after(*controller, {.gpu_ms = 25, .interval_ms = 25}).area(), 731024);
  // t = 10; s = .855 + .2 * .855 * .5 = .9405; within 884540.25 pixels: 940 x 940 = 883600
  EXPECT_EQ(after(*controller, {.gpu_ms = 10, .interval_ms = 10}), (Extent{940, 940}));
}

TEST(ProportionalController, LongIntervalsAreIgnored) {
  const Controller controller = proportional({.target_ms = 20, .rate = 0.2, .spike_ratio = 1.5});
  // Display sync holds the interval at 46 although the work took 30, and 46 > 1.5 * 30: t = 30.
  EXPECT_EQ(after(*controller, {.gpu_ms = 30, .interval_ms = 46}), (Extent{900, 900}));
  // 44 <= 1.5 * 30: t = 37; s = .9 (1 + .2 (1 - 1.85)) = .747; within 558009 pixels: 746 x 748 = 558008
  EXPECT_EQ(after(*controller, {.gpu_ms = 30, .interval_ms = 44}).area(), 558008);
}

TEST(ProportionalController, StepsBelowARungAddUp) {
  const Controller controller = proportional({.target_ms = 20, .rate = 0.01});
  // Each step is .01 * .01 = 1e-4 of the scale, a twentieth of a rung's 2 of 1000 pixels.
  Extent extent;
  for (int frame = 0; frame < 100; ++frame)
    extent = after(*controller, {.gpu_ms = 20.2});
  EXPECT_EQ(extent, (Extent{990, 990}));  // (1 - 1e-4)^100 = .99005
}

TEST(MinimumOfNController, StepTakesTheShortestOfTheLastN) {
  const Controller controller = minimum_of_n({.target_ms = 20, .count = 3, .factor = 0.2, .margin = 0.5});
  // T' = 10. m = 15: s = 1 + .2 * (10 - 15) / 10 = .9
  EXPECT_EQ(after(*controller, {.gpu_ms = 15}), (Extent{900, 900}));
  // m = min(15, 40) = 15: s = .9 * .9 = .81
  EXPECT_EQ(after(*controller, {.gpu_ms = 40}), (Extent{810, 810}));
  // m = min(15, 40, 12.5) = 12.5: s = .81 * .95 = .7695; within 592130.25 pixels: 768 x 770 = 591360
  EXPECT_EQ(after(*controller, {.gpu_ms = 12.5}).area(), 591360);
  // 15 has left: m = min(40, 12.5, 60) = 12.5: s = .7695 * .95 = .731025; within 534397.6: 730 x 732 = 534360
  EXPECT_EQ(after(*controller, {.gpu_ms = 60}).area(), 534360);
  // m = min(12.5, 60, 5) = 5: s = .731025 * 1.1 = .8041275; within 646621: 804 x 804 = 646416
  EXPECT_EQ(after(*controller, {.gpu_ms = 5}), (Extent{804, 804}));
  // m = min(60, 5, 30) = 5: s = .8041275 * 1.1 = .88454025; m = min(5, 30, 30) = 5: s = .972994275
  EXPECT_EQ(after(*controller, {.gpu_ms = 30}), (Extent{884, 884}));
  EXPECT_EQ(after(*controller, {.gpu_ms = 30}), (Extent{972, 972}));
  // 5 has left, m = 30: s = .972994275 (1 + .2 (10 - 30) / 10) = .583796565
  // 582 x 584 = 339888 is the largest within 340818.4
  EXPECT_EQ(after(*controller, {.gpu_ms = 30}).area(), 339888);
}

TEST(MinimumOfNController, DefaultMarginIsTheTutorials) {
  // 29 of 33.3 ms is a margin of .87: at exactly that time nothing moves.
  const Controller controller = minimum_of_n({.target_ms = 100.0 / 3});
  EXPECT_EQ(after(*controller, {.gpu_ms = 29}), (Extent{1000, 1000}));
  EXPECT_LT(after(*minimum_of_n({.target_ms = 100.0 / 3}), {.gpu_ms = 30}).area(), 1000000);
  EXPECT_STREQ(controller->name(), "minimum-of-n");
}

TEST(SeedControllers, BadSettingsNameTheField) {
  const double nan = std::nan("");
  const auto refused = [](const Result<Controller>& controller, const char* field) {
    ASSERT_FALSE(controller.ok()) << field;
    EXPECT_EQ(controller.status().code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(controller.status().message().rfind(field, 0), 0u) << controller.status().message();
  };
  for (const double bad : {0.0, -1.0, nan, 1.0 / 0.0}) {
    refused(make_proportional_controller({.ladder = kLadder, .target_ms = bad}), "target_ms");
    refused(make_proportional_controller({.ladder = kLadder, .rate = bad}), "rate");
    refused(make_proportional_controller({.ladder = kLadder, .spike_ratio = bad}), "spike_ratio");
    refused(make_minimum_of_n_controller({.ladder = kLadder, .target_ms = bad}), "target_ms");
    refused(make_minimum_of_n_controller({.ladder = kLadder, .factor = bad}), "factor");
    refused(make_minimum_of_n_controller({.ladder = kLadder, .margin = bad}), "margin");
  }
  refused(make_minimum_of_n_controller({.ladder = kLadder, .count = 0}), "count");
  refused(make_minimum_of_n_controller({.ladder = kLadder, .count = 1001}), "count");
  refused(
      make_proportional_controller({.ladder = {.output_extent = {64, 64}, .min_scale = 1, .max_scale = 0.5}}),
      "max_scale");
  refused(
      make_minimum_of_n_controller({.ladder = {.output_extent = {64, 64}, .min_scale = 1, .max_scale = 0.5}}),
      "max_scale");
}

}  // namespace
}  // namespace quincunx
