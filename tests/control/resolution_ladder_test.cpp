// SPDX-License-Identifier: MIT
#include "quincunx/control/resolution_ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "quincunx/control/dynamic_viewport.h"

namespace quincunx {
namespace {

ResolutionLadder make(const LadderSettings& settings) {
  Result<ResolutionLadder> ladder = ResolutionLadder::create(settings);
  EXPECT_TRUE(ladder.ok()) << ladder.status().message();
  return std::move(ladder).value();
}

constexpr AxisOrder kOrders[] = {AxisOrder::kHorizontalFirst, AxisOrder::kHorizontalOnly, AxisOrder::kBoth};

TEST(ResolutionLadder, FullHdToHalfInSteps) {
  // One step of 2 pixels per rung: (1920 - 960) / 2 + (1080 - 540) / 2 + 1 extents.
  EXPECT_EQ(make({.output_extent = {1920, 1080}}).size(), 751);
  EXPECT_EQ(make({.output_extent = {1920, 1080}, .order = AxisOrder::kBoth}).size(), 751);
  EXPECT_EQ(make({.output_extent = {1920, 1080}, .order = AxisOrder::kHorizontalOnly}).size(), 481);
}

TEST(ResolutionLadder, HorizontalFirstGoesToThreeQuartersAndThenInTurns) {
  const ResolutionLadder ladder = make({.output_extent = {1920, 1080}});
  EXPECT_EQ(ladder[750], (Extent{1920, 1080}));
  EXPECT_EQ(ladder[749], (Extent{1918, 1080}));
  EXPECT_EQ(ladder[510], (Extent{1440, 1080}));  // 480 pixels, 240 rungs
  EXPECT_EQ(ladder[509], (Extent{1440, 1078}));  // 1438 would lie below .75 * 1080
  EXPECT_EQ(ladder[508], (Extent{1438, 1078}));  // .75 * 1078 / 1080 * 1920 = 1437.3
  EXPECT_EQ(ladder[0], (Extent{960, 540}));
  for (int rung = 1; rung < ladder.size() && ladder[rung].width > 960; ++rung) {
    EXPECT_GE(ladder[rung].width * 4 * 1080, ladder[rung].height * 3 * 1920 - 2 * 4 * 1080) << rung;
  }
}

TEST(ResolutionLadder, BothAxesKeepTheAspect) {
  const ResolutionLadder ladder = make({.output_extent = {1920, 1080}, .order = AxisOrder::kBoth});
  for (int rung = 0; rung < ladder.size(); ++rung) {
    const double x = ladder[rung].width / 1920.0;
    const double y = ladder[rung].height / 1080.0;
    EXPECT_LE(std::abs(x - y), 2.0 / 1080 + 1e-12) << rung;  // never more than one step of the coarser axis
  }
}

TEST(ResolutionLadder, RungsHoldBoundsParityAndOrder) {
  for (const AxisOrder order : kOrders) {
    for (const Extent output : {Extent{1, 1}, {7, 5}, {64, 64}, {257, 129}, {1280, 720}, {3840, 2160}}) {
      for (const auto& [low, high] : {std::pair{0.5, 1.0}, {0.1, 2.0}, {0.7, 0.7}, {1.2, 1.9}, {0.01, 0.6}}) {
        const LadderSettings settings = {
            .output_extent = output, .min_scale = low, .max_scale = high, .order = order};
        const ResolutionLadder ladder = make(settings);
        ASSERT_GE(ladder.size(), 1);
        bool holds_output = false;
        for (int rung = 0; rung < ladder.size(); ++rung) {
          const Extent at = ladder[rung];
          holds_output = holds_output || at == output;
          EXPECT_EQ((at.width - output.width) % 2, 0);
          EXPECT_EQ((at.height - output.height) % 2, 0);
          EXPECT_GE(at.width, std::min(8, output.width));
          EXPECT_GE(at.height, std::min(8, output.height));
          EXPECT_EQ(ladder.max_rung_within(ladder.area_fraction(rung)), rung);
          if (rung == 0) continue;
          const Extent below = ladder[rung - 1];
          EXPECT_EQ(std::abs(at.width - below.width) + std::abs(at.height - below.height), 2);
          EXPECT_GT(at.area(), below.area());
          if (order == AxisOrder::kHorizontalOnly) {
            EXPECT_EQ(at.height, output.height);
          }
        }
        if (low <= 1 && high >= 1) {
          EXPECT_TRUE(holds_output) << output.width << " " << low << " " << high;
        }
      }
    }
  }
}

TEST(ResolutionLadder, EveryRungIsAViewport) {
  for (const AxisOrder order : kOrders) {
    const ResolutionLadder ladder =
        make({.output_extent = {1279, 719}, .min_scale = 0.4, .max_scale = 2, .order = order});
    Result<DynamicViewport> viewport = DynamicViewport::create({1279, 719}, 2);
    ASSERT_TRUE(viewport.ok());
    for (int rung = 0; rung < ladder.size(); ++rung) {
      EXPECT_TRUE(viewport->set_render(ladder[rung]).ok());
    }
  }
}

TEST(ResolutionLadder, HighestWithin) {
  const ResolutionLadder ladder = make({.output_extent = {1920, 1080}});
  EXPECT_EQ(ladder.max_rung_within(1), 750);
  EXPECT_EQ(ladder.max_rung_within(7), 750);
  EXPECT_EQ(ladder.max_rung_within(1918.9 / 1920), 749);
  EXPECT_EQ(ladder.max_rung_within(0.25), 0);
  EXPECT_EQ(ladder.max_rung_within(0), 0);
  EXPECT_EQ(ladder.max_rung_within(-3), 0);
  EXPECT_EQ(ladder.max_rung_within(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(ladder.max_rung_within(std::numeric_limits<double>::infinity()), 750);
  EXPECT_EQ(ladder.max_rung_within_scale(0.5), 0);
  EXPECT_LE(ladder.area_fraction(ladder.max_rung_within_scale(0.71)), 0.71 * 0.71);
}

TEST(ResolutionLadder, BadSettingsNameTheField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto refused = [](const LadderSettings& settings, const char* field) {
    const Result<ResolutionLadder> ladder = ResolutionLadder::create(settings);
    ASSERT_FALSE(ladder.ok()) << field;
    EXPECT_EQ(ladder.status().code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(ladder.status().message().rfind(field, 0), 0u) << ladder.status().message();
  };
  refused({}, "output");
  refused({.output_extent = {1, 0}}, "output");
  refused({.output_extent = {-4, 4}}, "output");
  refused({.output_extent = {40000, 4}}, "output");
  for (const double bad : {0.0, -1.0, nan, infinity, 2.5})
    refused({.output_extent = {64, 64}, .min_scale = bad}, "min_scale");
  for (const double bad : {0.4, -1.0, nan, infinity, 2.5}) {
    refused({.output_extent = {64, 64}, .min_scale = 0.5, .max_scale = bad}, "max_scale");
  }
  refused({.output_extent = {64, 64}, .step = 0}, "step");
  refused({.output_extent = {64, 64}, .step = -2}, "step");
  refused({.output_extent = {64, 64}, .min_extent = {0, 8}}, "min_extent");
}

}  // namespace
}  // namespace quincunx
