// SPDX-License-Identifier: MIT
// Properties that every controller keeps, whatever it is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "all_controllers.h"

namespace quincunx::testing {
namespace {

constexpr LadderSettings kLadder = {.output_extent = {1281, 719}, .min_scale = 0.4, .max_scale = 1.5};
constexpr double kTargetMs = 1000.0 / 60;

class EveryController : public ::testing::TestWithParam<ControllerKind> {
 protected:
  static Controller make(double target_ms = kTargetMs) {
    Result<Controller> controller = GetParam().make(kLadder, target_ms);
    EXPECT_TRUE(controller.ok()) << controller.status().message();
    return std::move(controller).value();
  }
};

// Frame times of a random walk with noise and single spikes, a third of it independent of the extent.
class Load {
 public:
  explicit Load(unsigned seed) : random_(seed) {}

  FrameTiming next(const ResolutionController& controller) {
    level_ = std::clamp(level_ * std::exp(0.02 * normal_(random_)), 2.0, 60.0);
    const double spike = frame_ % 37 == 36 ? 2.5 : 1;
    const double area = controller.ladder().area_fraction(controller.next());
    FrameTiming timing = {.frame = ++frame_, .render_extent = controller.next()};
    timing.gpu_ms = level_ * (1.0 / 3 + area * 2 / 3) * spike * std::exp(0.03 * normal_(random_));
    timing.cpu_ms = 5;
    timing.interval_ms = std::ceil(timing.gpu_ms / kTargetMs) * kTargetMs;
    timing.queued = timing.gpu_ms < kTargetMs ? 1 : 0;
    timing.missed_vsyncs = static_cast<int>(timing.gpu_ms / kTargetMs);
    return timing;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double level_ = 15;
  std::uint64_t frame_ = 0;
};

TEST_P(EveryController, StaysOnTheLadder) {
  const Controller controller = make();
  const Extent output = kLadder.output_extent;
  Load load(1);
  bool moved = false;
  for (int frame = 0; frame < 3000; ++frame) {
    const Extent at = controller->next();
    ASSERT_EQ(at, controller->ladder()[controller->rung()]);
    ASSERT_EQ((at.width - output.width) % 2, 0);
    ASSERT_EQ((at.height - output.height) % 2, 0);
    ASSERT_GE(at.width, kLadder.min_scale * output.width);
    ASSERT_GE(at.height, kLadder.min_scale * output.height);
    ASSERT_LE(at.width, kLadder.max_scale * output.width);
    ASSERT_LE(at.height, kLadder.max_scale * output.height);
    ASSERT_TRUE(controller->observe(load.next(*controller)).ok());
    moved = moved || controller->next() != at;
  }
  EXPECT_TRUE(moved);
}

TEST_P(EveryController, SameCallsSameExtents) {
  const Controller first = make();
  const Controller second = make();
  Load load(2);
  for (int frame = 0; frame < 2000; ++frame) {
    const FrameTiming timing = load.next(*first);
    ASSERT_TRUE(first->observe(timing).ok());
    ASSERT_TRUE(second->observe(timing).ok());
    ASSERT_EQ(first->rung(), second->rung()) << frame;
  }
}

// The mean rung of the last hundred frames under a constant load.
double settled_rung(ResolutionController& controller, double load_ms, double fixed_part) {
  double sum = 0;
  for (int frame = 1; frame <= 1500; ++frame) {
    const double area = controller.ladder().area_fraction(controller.next());
    const FrameTiming timing = {.frame = static_cast<std::uint64_t>(frame),
                                .render_extent = controller.next(),
                                .gpu_ms = load_ms * (fixed_part + (1 - fixed_part) * area),
                                .cpu_ms = 4,
                                .interval_ms = controller.target_ms(),
                                .queued = 1};
    EXPECT_TRUE(controller.observe(timing).ok());
    if (frame > 1400) sum += controller.rung();
  }
  return sum / 100;
}

// A cheaper method may leave more pixels.
class EveryResolutionController : public EveryController {};

TEST_P(EveryResolutionController, MoreLoadNeverMorePixels) {
  for (const double fixed_part : {0.0, 0.3, 0.6}) {
    double above = std::numeric_limits<double>::infinity();
    for (double load_ms = 4; load_ms < 90; load_ms *= 1.15) {
      const double rung = settled_rung(*make(), load_ms, fixed_part);
      // Controllers with a dead band settle within it, on a side that depends on the way there.
      const double dead_band = 0.03 * make()->ladder().size();
      EXPECT_LE(rung, above + dead_band) << load_ms;
      above = rung;
    }
  }
}

TEST_P(EveryController, LightLoadIsTheTopHeavyLoadTheBottom) {
  const Controller controller = make();
  EXPECT_EQ(settled_rung(*controller, 1, 0.2), controller->ladder().top());
  EXPECT_EQ(settled_rung(*make(), 500, 0.2), 0);
}

TEST_P(EveryController, LargerTargetNeverFewerPixels) {
  double below = 0;
  for (const double target_ms : {1000.0 / 120, 1000.0 / 60, 1000.0 / 30}) {
    const double rung = settled_rung(*make(target_ms), 20, 0.3);
    EXPECT_GE(rung, below);
    below = rung;
  }
}

TEST_P(EveryController, BadTimingsChangeNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Controller disturbed = make();
  const Controller twin = make();
  Load load(3);
  const auto refused = [&](FrameTiming bad, const char* field) {
    const Extent before = disturbed->next();
    const Status status = disturbed->observe(bad);
    ASSERT_FALSE(status.ok()) << field;
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message().rfind(field, 0), 0u) << status.message();
    EXPECT_EQ(disturbed->next(), before);
  };
  for (int frame = 0; frame < 300; ++frame) {
    const FrameTiming good = load.next(*twin);
    const auto with = [&good](const std::function<void(FrameTiming&)>& change) {
      FrameTiming timing = good;
      change(timing);
      return timing;
    };
    for (const double value : {nan, infinity, -infinity, -1.0, 1e9}) {
      refused(with([=](FrameTiming& t) { t.gpu_ms = value; }), "gpu_ms");
      refused(with([=](FrameTiming& t) { t.cpu_ms = value; }), "cpu_ms");
      refused(with([=](FrameTiming& t) { t.interval_ms = value; }), "interval_ms");
    }
    refused(with([](FrameTiming& t) { t.gpu_ms = 0; }), "gpu_ms");
    for (const double value : {nan, infinity, -1.0}) {
      refused(with([=](FrameTiming& t) { t.blur_px = value; }), "blur_px");
    }
    refused(with([](FrameTiming& t) { t.render_extent = {0, 100}; }), "render");
    refused(with([](FrameTiming& t) { t.render_extent = {100, -2}; }), "render");
    refused(with([](FrameTiming& t) { t.next_frame = t.frame; }), "next_frame");
    refused(with([](FrameTiming& t) { t.queued = -2; }), "queued");
    refused(with([](FrameTiming& t) { t.missed_vsyncs = -1; }), "missed_vsyncs");
    ASSERT_TRUE(twin->observe(good).ok());
    ASSERT_TRUE(disturbed->observe(good).ok());
    refused(good, "frame");                                                        // a duplicate
    refused(with([](FrameTiming& t) { t.frame -= 1, t.gpu_ms = 500; }), "frame");  // a late one
    ASSERT_EQ(disturbed->rung(), twin->rung()) << frame;
  }
}

TEST_P(EveryController, BadTargetsChangeNothing) {
  const Controller controller = make();
  for (const double bad : {0.0, -16.0, 1e9, std::nan(""), 1.0 / 0.0}) {
    const Status status = controller->set_target_ms(bad);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("target_ms"), std::string::npos);
    EXPECT_EQ(controller->target_ms(), kTargetMs);
    EXPECT_FALSE(GetParam().make(kLadder, bad).ok());
  }
  EXPECT_TRUE(controller->set_target_ms(2 * kTargetMs).ok());
  EXPECT_EQ(controller->target_ms(), 2 * kTargetMs);
  EXPECT_FALSE(
      GetParam().make({.output_extent = {64, 64}, .min_scale = 0.9, .max_scale = 0.8}, kTargetMs).ok());
}

// A lost timing is no error, and neither is an extent that is not on the ladder.
TEST_P(EveryController, GapsAndForeignExtentsAreAccepted) {
  const Controller controller = make();
  EXPECT_TRUE(controller->observe({.frame = 0, .render_extent = {1, 1}, .gpu_ms = 1e-6}).ok());
  EXPECT_TRUE(controller->observe({.frame = 7, .render_extent = {30000, 30000}, .gpu_ms = 60000}).ok());
  const std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  EXPECT_TRUE(controller->observe({.frame = last, .render_extent = {640, 360}, .gpu_ms = 10}).ok());
  EXPECT_GE(controller->rung(), 0);
  EXPECT_FALSE(controller->observe({.frame = 0, .render_extent = {640, 360}, .gpu_ms = 10}).ok());
}

INSTANTIATE_TEST_SUITE_P(All, EveryController, ::testing::ValuesIn(all_controllers()),
                         [](const auto& kind) { return kind.param.name; });
INSTANTIATE_TEST_SUITE_P(Sizing, EveryResolutionController, ::testing::ValuesIn(resolution_controllers()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace quincunx::testing
