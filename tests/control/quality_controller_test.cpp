// SPDX-License-Identifier: MIT
// The quality controller against the front and the machine of quality_program.h.
#include "quincunx/quality_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "quality_program.h"

namespace quincunx::testing {
namespace {

constexpr ContentStatistics kStill = {};
constexpr ContentStatistics kLight = {.light = 1};

TEST(QualityController, GoesToTheMethodThatErrsLeastInWhatIsShown) {
  Program program;
  program.run(100, 20, kStill);
  EXPECT_EQ(program->choice().method, kDear);
  program.run(100, 20, kLight);
  EXPECT_EQ(program->choice().method, kPlain);
  program.run(100, 20, kStill);
  EXPECT_EQ(program->choice().method, kDear);
  EXPECT_EQ(program.changes, 2);
}

// The pair is that of a search over everything, whatever the load and what is shown.
TEST(QualityController, FindsTheLeastErrorThatFits) {
  for (const double full_ms : {10.0, 16.0, 20.0, 26.0, 34.0, 40.0}) {
    for (const double light : {0.0, 0.25, 0.5, 1.0}) {
      Program program([](auto& s) { s.hysteresis = 0; });
      program.run(300, full_ms, ContentStatistics{.light = light});
      double least = 1;
      for (const FrontMethod& method : {kPlain, kTwo, kDear}) {
        for (double scale = 0.5; scale <= 1; scale += 0.001) {
          if (full_ms * (0.2 + 0.8 * scale * scale) + passes_ms(method) > kTargetMs) continue;
          least = std::min(least, light * flip(SceneClass::kLight, method, scale) +
                                      (1 - light) * flip(SceneClass::kStill, method, scale));
        }
      }
      // The dead bands leave 1 % of the area undrawn at most, .5 % of the scale: as much of the error.
      EXPECT_NEAR(program->reasons().chosen.flip, least, 0.005 * least) << full_ms << " ms, light " << light;
      EXPECT_LE(program.last_ms, kTargetMs);
    }
  }
}

TEST(QualityController, MoreLoadNeverLessError) {
  double below = 0;
  for (double full_ms = 4; full_ms < 45; full_ms *= 1.1) {  // kPlain fits to 48
    Program program([](auto& s) { s.hysteresis = 0; });
    program.run(300, full_ms, ContentStatistics{.light = 0.3});
    const double flip = program->reasons().chosen.flip;
    EXPECT_GE(flip, below * 0.995) << full_ms;  // dead bands
    below = flip;
  }
}

TEST(QualityController, AMethodThatDoesNotFitIsLeft) {
  Program program;
  program.run(100, 20, kStill);
  ASSERT_EQ(program->choice().method, kDear);
  program.run(100, 40, kStill);  // 16 ms at the lowest resolution: 22 with kDear
  EXPECT_EQ(program->choice().method, kTwo);
}

// Frames are dropped whatever is done: the error of what is shown and the time of a frame both count.
TEST(QualityController, WhereNothingFitsTimeCountsTwice) {
  for (const double full_ms : {52.0, 60.0, 90.0, 300.0}) {
    Program program;
    program.run(200, full_ms, kStill);
    EXPECT_EQ(program->choice().render, program->ladder()[0]);
    const auto cost = [full_ms](const FrontMethod& method) {
      const double ms = full_ms * 0.4 + passes_ms(method);
      return flip(SceneClass::kStill, method, 0.5) * ms * ms;
    };
    for (const FrontMethod& other : {kPlain, kTwo, kDear})
      EXPECT_LE(cost(program->choice().method), cost(other) * 1.001) << full_ms;
  }
}

TEST(QualityController, AFadeFitsTheTargetToo) {
  Program program;
  program.run(200, 24, kStill);
  for (int frame = 0; frame < 30; ++frame) {
    program.run(1, 24, kLight);
    ASSERT_LE(program.last_ms, kTargetMs * 1.001);
  }
  EXPECT_GE(program.faded, 6);
}

TEST(QualityController, OneMethodIsThePredictiveController) {
  Program program([](auto& s) { s.methods = {kTwo}; });
  auto predictive = make_predictive_controller({.ladder = kLadder, .target_ms = kTargetMs - passes_ms(kTwo)});
  for (std::uint64_t frame = 0; frame < 400; ++frame) {
    program.run(1, 24, kStill);
    const Extent render = predictive.value()->next();
    const double area = program->ladder().area_fraction(render);
    const double ms = 24 * (0.2 + 0.8 * area);
    ASSERT_TRUE(predictive.value()->observe({.frame = frame, .render = render, .gpu_ms = ms}).ok());
  }
  EXPECT_NEAR(program->ladder().area_fraction(program->choice().render),
              program->ladder().area_fraction(predictive.value()->next()), 0.02);
}

// The front's times are those of a machine a hundred times slower.
TEST(QualityController, LearnsTheMachineFromTimedPasses) {
  Program program([](auto& s) { s.front = front(100); });
  program.run(200, 20, kStill);
  EXPECT_EQ(program->choice().method, kDear);
  EXPECT_NEAR(program->reasons().chosen.ms, program.last_ms, 0.1);
}

TEST(QualityController, LearnsTheMachineFromWholeFrames) {
  for (const double factor : {0.05, 1.0, 20.0}) {
    Program program([factor](auto& s) { s.front = front(factor); });
    program.run(600, 20, kLight, false);
    EXPECT_EQ(program->choice().method, kPlain) << factor;
    program.run(600, 20, kStill, false);
    EXPECT_EQ(program->choice().method, kDear) << factor;
    EXPECT_NEAR(program.last_ms, kTargetMs, 0.03 * kTargetMs) << factor;
    EXPECT_LE(program.changes, 12) << factor;
  }
}

TEST(QualityController, BlurInViewLowersTheResolution) {
  Program program([](auto& s) { s.pacing.blur_aware.enabled = true; });
  program.run(50, 8, kStill);
  EXPECT_EQ(program->choice().render, kLadder.output);
  for (std::uint64_t frame = 1000; frame < 1100; ++frame) {
    const QualityFrame blurred = {
        .timing = {.frame = frame, .render = program->choice().render, .gpu_ms = 10, .blur_px = 40}};
    ASSERT_TRUE(program->observe(blurred).ok());
  }
  EXPECT_NEAR(program->choice().render.width, 710, 4);
}

TEST(QualityController, TheProcessorHoldsOrIsFollowed) {
  Program holds;
  Program follows([](auto& s) { s.pacing.cpu_bound = CpuBound::kFollow; });
  for (Program* program : {&holds, &follows}) {
    program->run(100, 30, kStill);
    program->cpu_ms = 30;
    program->run(200, 30, kLight);
  }
  EXPECT_EQ(holds.changes, 0);
  EXPECT_EQ(follows.changes, 1);
  EXPECT_NEAR(follows.last_ms, 30 * 0.95, 0.5);
}

TEST(QualityController, SaysWhy) {
  Program program;
  program.run(200, 24, kStill);
  const QualityReasons reasons = program->reasons();
  EXPECT_EQ(reasons.chosen.method, kDear);
  EXPECT_NEAR(reasons.mix.share[0], 1, 1e-9);
  ASSERT_EQ(reasons.others.size(), 2u);
  EXPECT_LE(reasons.others[0].flip, reasons.others[1].flip);
  ASSERT_TRUE(reasons.next_better);
  EXPECT_LE(reasons.next_better->flip, 0.98 * reasons.chosen.flip);
  EXPECT_GT(reasons.next_better->ms, reasons.budget_ms);
  const std::string text = explain(reasons);
  EXPECT_NE(text.find("Picture        still 100 %"), std::string::npos) << text;
  EXPECT_NE(text.find("Chosen         temporal:balanced at scale "), std::string::npos) << text;
  EXPECT_NE(text.find(" more than there is"), std::string::npos) << text;
  program.run(200, 2, kStill);
  EXPECT_FALSE(program->reasons().next_better);
  EXPECT_NE(explain(program->reasons()).find("none: no pair errs less"), std::string::npos);
}

TEST(QualityController, BadFramesChangeNothing) {
  Program program;
  program.run(100, 20, kStill);
  const QualityChoice before = program->choice();
  const auto refused = [&](QualityFrame frame, const char* field) {
    frame.timing.frame = 500;
    const Status status = program->observe(frame);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message().rfind(field, 0), 0u) << status.message();
    EXPECT_EQ(program->choice().render, before.render);
    EXPECT_EQ(program->choice().method, before.method);
  };
  const FrameTiming good = {.render = {800, 800}, .gpu_ms = 10};
  for (const double bad : {-1.0, 10.0, 11.0, std::nan("")})
    refused({.timing = good, .resolve_ms = bad}, "resolve_ms");
  refused({.timing = good, .content = ContentStatistics{.light = 2}}, "content.light");
  refused({.timing = {.render = {0, 800}, .gpu_ms = 10}, .content = kLight}, "render");
}

TEST(QualityController, BadSettingsAreNamed) {
  const auto message = [](const Change& change) {
    QualitySettings settings = usual_settings();
    change(settings);
    return make_quality_controller(settings).status().message();
  };
  EXPECT_NE(message([](auto& s) { s.methods = {{.method = Method::kNoise}}; }).find("noise"),
            std::string::npos);
  EXPECT_NE(message([](auto& s) { s.hysteresis = 1; }).find("hysteresis"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.rest_seconds = std::nan(""); }).find("rest_seconds"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.fade_frames = -1; }).find("fade_frames"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.pacing.buffers = 9; }).find("buffers"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.pacing.target_ms = 0; }).find("target_ms"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::testing
