// SPDX-License-Identifier: MIT
// Wild ladders, settings and timings for every resolution controller, the same ones each time: whatever comes
// of it is a Status that names a field and changes nothing, or a next extent on the ladder.
#include <gtest/gtest.h>

#include <cmath>

#include "../control/all_controllers.h"
#include "wild.h"

namespace quincunx::testing {
namespace {

// Sides stay small most of the time, so that thousands of ladders are made quickly.
LadderSettings wild_ladder(Random& random) {
  LadderSettings settings = {.output_extent = {wild_int(random, 300), wild_int(random, 200)},
                             .order = static_cast<AxisOrder>(random.below(3))};
  settings.min_scale = wild(random, 0.3);
  settings.max_scale = wild(random, 1.0);
  settings.step = wild_int(random, 4);
  settings.min_extent = {wild_int(random, 16), wild_int(random, 16)};
  return settings;
}

FrameTiming wild_timing(Random& random, const ResolutionController& controller, std::uint64_t frame) {
  FrameTiming timing;
  timing.frame = random.below(8) == 0 ? random.next() >> random.below(64) : frame;
  timing.render_extent =
      random.below(4) == 0 ? Extent{wild_int(random, 4000), wild_int(random, 4000)} : controller.next();
  timing.gpu_ms = wild(random, controller.target_ms());
  timing.cpu_ms = random.below(2) == 0 ? 0 : wild(random, controller.target_ms());
  timing.interval_ms = random.below(2) == 0 ? 0 : wild(random, controller.target_ms());
  timing.queued = random.below(4) == 0 ? wild_int(random, 4) : random.below(4) - 1;
  timing.missed_vsyncs = random.below(4) == 0 ? wild_int(random, 4) : 0;
  timing.blur_px = random.below(4) == 0 ? wild(random, 10) : 0;
  return timing;
}

void expect_named(const Status& status) {
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find(" is "), std::string::npos) << status.message();
}

class ControllerFuzz : public ::testing::TestWithParam<ControllerKind> {};

TEST_P(ControllerFuzz, WildSettingsAndTimings) {
  Random random(11);
  int made = 0;
  int accepted = 0;
  int refused = 0;
  for (int round = 0; round < rounds(); ++round) {
    SCOPED_TRACE(round);
    const LadderSettings ladder = wild_ladder(random);
    Result<Controller> result = GetParam().make(ladder, wild(random, 16));
    if (!result.ok()) {
      expect_named(result.status());
      continue;
    }
    ++made;
    ResolutionController& controller = *result.value();
    const Extent output = controller.ladder().output();
    for (std::uint64_t frame = 1; frame <= 40; ++frame) {
      const Extent before = controller.next();
      const Status status = controller.observe(wild_timing(random, controller, frame));
      if (!status.ok()) {
        ++refused;
        expect_named(status);
        ASSERT_EQ(controller.next(), before);
      } else {
        ++accepted;
      }
      if (random.below(16) == 0) (void)controller.set_target_ms(wild(random, 16));
      ASSERT_GE(controller.rung(), 0);
      ASSERT_LE(controller.rung(), controller.ladder().top());
      ASSERT_GE(controller.next().width, 1);
      // Where a step is wider than the range of scales, the first rung above the lowest scale is the only one.
      ASSERT_LE(controller.next().width, 2 * output.width + ladder.step);
      ASSERT_GE(controller.next().height, 1);
      ASSERT_LE(controller.next().height, 2 * output.height + ladder.step);
      ASSERT_TRUE(controller.target_ms() > 0 && controller.target_ms() <= ResolutionController::kMaxMs);
    }
  }
  EXPECT_GT(made, 0);
  EXPECT_LT(made, rounds());
  EXPECT_GT(accepted, 0);
  EXPECT_GT(refused, 0);
}

// After any wild past, an ordinary constant load ends where it would have ended without it.
TEST_P(ControllerFuzz, RecoversFromAnyPast) {
  Random random(12);
  const LadderSettings ladder = {.output_extent = {640, 360}};
  const auto settle = [](ResolutionController& controller, std::uint64_t first) {
    for (std::uint64_t frame = first; frame < first + 1200; ++frame) {
      const double area = controller.ladder().area_fraction(controller.next());
      EXPECT_TRUE(controller
                      .observe({.frame = frame,
                                .render_extent = controller.next(),
                                .gpu_ms = 25 * (0.3 + 0.7 * area),
                                .interval_ms = 16.7,
                                .queued = 1})
                      .ok());
    }
    return controller.ladder().area_fraction(controller.next());
  };
  const Controller fresh = std::move(GetParam().make(ladder, 1000.0 / 60)).value();
  const double expected = settle(*fresh, 1);
  for (int round = 0; round < rounds() / 30; ++round) {
    SCOPED_TRACE(round);
    const Controller controller = std::move(GetParam().make(ladder, 1000.0 / 60)).value();
    for (std::uint64_t frame = 1; frame <= 60; ++frame) {
      FrameTiming timing = wild_timing(random, *controller, frame);
      timing.frame = frame;
      (void)controller->observe(timing);
    }
    EXPECT_NEAR(settle(*controller, 61), expected, 0.05);
  }
}

// Damaged text of a cost table: refused with a reason, or a table whose answers are finite or none.
TEST(CostTableFuzz, DamagedText) {
  CostTable table = CostTable::create(500).value();
  for (std::uint64_t frame = 0; frame < 40; ++frame) {
    ASSERT_TRUE(table
                    .record(frame * 10, 0.25 + 0.03 * static_cast<double>(frame),
                            5 + 0.3 * static_cast<double>(frame))
                    .ok());
  }
  const std::string good = table.to_json();
  Random random(13);
  int loaded = 0;
  for (int round = 0; round < rounds(); ++round) {
    SCOPED_TRACE(round);
    std::string text = good;
    for (int hit = 0, hits = 1 + random.below(3); hit < hits; ++hit) {
      text[static_cast<std::size_t>(random.below(static_cast<int>(text.size())))] =
          random.below(2) == 0 ? static_cast<char>('0' + random.below(10))
                               : static_cast<char>(random.below(256));
    }
    if (random.below(10) == 0)
      text.resize(static_cast<std::size_t>(random.below(static_cast<int>(text.size()))));
    const Result<CostTable> result = CostTable::from_json(text);
    if (!result.ok()) {
      EXPECT_EQ(result.status().message().rfind("cost table: ", 0), 0u);
      continue;
    }
    ++loaded;
    for (const double area : {0.01, 0.3, 0.5, 1.0, 4.0}) {
      const double confidence = result.value().confidence(area);
      EXPECT_TRUE(confidence >= 0 && confidence <= 1);
      const double time = result.value().predict(area).value_or(1);
      EXPECT_TRUE(std::isfinite(time) && time > 0);
    }
    const double fixed_part = result.value().fixed_part().value_or(0);
    EXPECT_TRUE(fixed_part >= 0 && fixed_part <= 0.9);
  }
  EXPECT_GT(loaded, 0);
  EXPECT_LT(loaded, rounds());
}

INSTANTIATE_TEST_SUITE_P(All, ControllerFuzz, ::testing::ValuesIn(all_controllers()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace quincunx::testing
