// SPDX-License-Identifier: MIT
// The choice of the method; and the quality controller against a front and a machine that are written down here.
#include "quincunx/control/quality_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "method_choice.h"

namespace quincunx {
namespace {

constexpr MethodChoice::Settings kSettings = {.hysteresis = 0.05, .rest_ms = 1000, .fade_frames = 4};
constexpr double kFrameMs = 20;

class MethodChanges : public ::testing::Test {
 protected:
  using Situation = MethodChoice::Situation;

  // Frames in which method `best` would save `gain`.
  void run(int frames, std::size_t best, double gain, Situation now = {.both_fit = true}) {
    for (int i = 0; i < frames; ++i) {
      now.next_frame = ++frame_;
      now.frame_ms = kFrameMs;
      now.best = best;
      now.gain = gain;
      choice_.advance(now);
      now.cut = false;
    }
  }
  void grow_old() { run(100, 0, 0); }

  MethodChoice choice_{kSettings, 0};
  std::uint64_t frame_ = 0;
};

TEST_F(MethodChanges, AGainWithinTheHysteresisIsLetBe) {
  grow_old();
  run(500, 1, 0.04);
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, AGainHasToLastFourFrames) {
  grow_old();
  for (int i = 0; i < 100; ++i) {
    run(3, 1, 0.2);
    run(1, 0, 0);
  }
  EXPECT_EQ(choice_.method(), 0u);
  run(4, 1, 0.2);
  EXPECT_EQ(choice_.method(), 1u);
}

TEST_F(MethodChanges, AChangeIsFadedInEvenly) {
  grow_old();
  run(4, 1, 0.2);
  for (int step = 1; step <= 4; ++step) {
    ASSERT_EQ(choice_.fading_from(), 0u);
    ASSERT_NEAR(choice_.weight(), step / 5.0, 1e-12);
    run(1, 0, 0.9);  // nothing turns back on the way
  }
  EXPECT_FALSE(choice_.fading_from());
  EXPECT_EQ(choice_.weight(), 1);
  EXPECT_EQ(choice_.method(), 1u);
}

TEST_F(MethodChanges, OneChangeASecond) {
  grow_old();
  run(4, 1, 0.2);
  ASSERT_EQ(choice_.method(), 1u);
  run(49, 0, 0.2);
  EXPECT_EQ(choice_.method(), 1u);
  run(1, 0, 0.2);
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, WhatMustBeDoesNotWaitForRest) {
  grow_old();
  run(4, 1, 0.2);
  run(12, 2, 0, {.must = true, .both_fit = false});
  EXPECT_EQ(choice_.method(), 2u);
  EXPECT_FALSE(choice_.fading_from());
}

TEST_F(MethodChanges, HeldFramesChangeNothing) {
  grow_old();
  run(50, 1, 0.5, {.held = true, .both_fit = true});
  EXPECT_EQ(choice_.method(), 0u);
}

TEST_F(MethodChanges, FastMotionAndTooLittleTimeNeedNoFade) {
  grow_old();
  run(4, 1, 0.2, {.masked = true, .both_fit = true});
  EXPECT_EQ(choice_.method(), 1u);
  EXPECT_FALSE(choice_.fading_from());
  run(60, 0, 0.2, {.both_fit = false});
  EXPECT_EQ(choice_.method(), 0u);
  EXPECT_FALSE(choice_.fading_from());
}

TEST_F(MethodChanges, AYoungShotMayChangeOnceAtOnce) {
  grow_old();
  run(4, 1, 0.2);
  run(10, 1, 0);
  run(1, 2, 0.2, {.both_fit = true, .cut = true});
  run(1, 2, 0.2);
  EXPECT_EQ(choice_.method(), 2u);
  EXPECT_FALSE(choice_.fading_from());
  run(8, 0, 0.2);
  EXPECT_EQ(choice_.method(), 2u);
}

TEST_F(MethodChanges, ACutEndsAFade) {
  grow_old();
  run(5, 1, 0.2);
  ASSERT_TRUE(choice_.fading_from());
  run(1, 1, 0, {.both_fit = true, .cut = true});
  EXPECT_FALSE(choice_.fading_from());
  EXPECT_EQ(choice_.weight(), 1);
}

TEST_F(MethodChanges, LostFramesShortenAFade) {
  grow_old();
  run(4, 1, 0.2);
  frame_ += 10;
  run(1, 1, 0);
  EXPECT_FALSE(choice_.fading_from());
}

}  // namespace
}  // namespace quincunx

namespace quincunx::testing {
namespace {

constexpr MethodVariant kPlain = {.method = Method::kBilinear};
constexpr MethodVariant kTwo = {.method = Method::kQuincunx};
constexpr MethodVariant kDear = {.method = Method::kTemporal};
constexpr double kTargetMs = 20;
constexpr LadderSettings kLadder = {.output_extent = {1000, 1000},
                                    .order = AxisOrder::kBoth};  // one megapixel

// Milliseconds of a method's passes, of an output of one megapixel.
double passes_ms(const MethodVariant& method) {
  return method == kPlain ? 0.5 : method == kTwo ? 2 : 6;
}

// In a still picture the dear method errs least by far; in light the plain one does; between them, the second.
double flip(SceneClass scene_class, const MethodVariant& method, double scale) {
  const bool light = scene_class == SceneClass::kLight;
  const double at_one = method == kPlain ? (light ? 0.05 : 0.08)
                        : method == kTwo ? 0.06
                                         : (light ? 0.09 : 0.03);
  return at_one * (1 + 0.8 * (1 - scale));
}

ErrorFront front(double ms_factor = 1) {
  std::vector<FrontPoint> points;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    for (const MethodVariant& method : {kPlain, kTwo, kDear}) {
      for (const double scale : {0.5, 1.0}) {
        FrontPoint point = {.scene_class = static_cast<SceneClass>(i), .method = method, .scale = scale};
        point.flip = flip(point.scene_class, method, scale);
        point.psnr_db = 30;
        point.ms_per_megapixel = passes_ms(method) * ms_factor;
        points.push_back(point);
      }
    }
  }
  FrontSource source;
  source.device = "a machine written down";
  source.output_extent = kLadder.output_extent;
  return ErrorFront::create(source, points).value();
}

QualitySettings usual_settings() {
  QualitySettings settings;
  settings.pacing.ladder = kLadder;
  settings.pacing.target_ms = kTargetMs;
  settings.front = front();
  return settings;
}
using Change = std::function<void(QualitySettings&)>;

// A program that draws what it is told to.
class Program {
 public:
  explicit Program(const Change& change = {}) {
    QualitySettings settings = usual_settings();
    if (change) change(settings);
    auto made = make_quality_controller(settings);
    if (!made.ok()) throw std::invalid_argument(made.status().message());
    controller_ = std::move(made).value();
  }

  // Frames whose drawing takes so long at the output resolution.
  void run(int frames, double full_ms, std::optional<ContentStatistics> content, bool timed = true) {
    for (int i = 0; i < frames; ++i) {
      const QualityChoice choice = controller_->choice();
      const double area = controller_->ladder().area_fraction(choice.render_extent);
      const double passes =
          passes_ms(choice.method) + (choice.fading_from ? passes_ms(*choice.fading_from) : 0);
      QualityFrame frame = {.timing = {.frame = frame_++, .render_extent = choice.render_extent}};
      frame.timing.gpu_ms = full_ms * (0.2 + 0.8 * area) + passes;
      frame.timing.cpu_ms = cpu_ms;
      frame.timing.interval_ms = std::max(kTargetMs, frame.timing.gpu_ms);
      frame.timing.queued = 1;
      frame.resolve_ms = timed ? passes : 0;
      frame.content = content;
      if (content) content->cut = false;
      last_ms = frame.timing.gpu_ms;
      const QualityChoice before = choice;
      ASSERT_TRUE(controller_->observe(frame).ok());
      if (!(controller_->choice().method == before.method)) ++changes;
      if (controller_->choice().fading_from) ++faded;
    }
  }
  QualityController& operator*() { return *controller_; }
  QualityController* operator->() { return controller_.get(); }

  double cpu_ms = 4;
  double last_ms = 0;
  int changes = 0;
  int faded = 0;

 private:
  std::unique_ptr<QualityController> controller_;
  std::uint64_t frame_ = 0;
};

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

// Light that only the dear method sees does not bring that back as soon as it is not looked for, and is found to rest
// in the end.
TEST(QualityController, JudgedLightIsRememberedWhileNobodyJudges) {
  Program program;
  int dear = 0;
  const auto run = [&](int frames, double light) {
    dear = program.changes = 0;
    for (int i = 0; i < frames; ++i) {
      const bool judged = program->choice().method == kDear;
      dear += judged ? 1 : 0;
      program.run(1, 20, ContentStatistics{.light = judged ? light : 0, .judged = judged});
    }
  };
  run(100, 0);
  ASSERT_EQ(program->choice().method, kDear);
  run(500, 1);
  EXPECT_EQ(program->choice().method, kPlain);
  EXPECT_EQ(program.changes, 1);
  run(5000, 1);
  EXPECT_LT(dear, 500) << "a look every few hundred frames";
  EXPECT_GT(dear, 0);
  run(1000, 0);
  EXPECT_EQ(program->choice().method, kDear);
  run(5000, 0);
  EXPECT_EQ(program.changes, 0);
}

// A cut ends what was judged; reactive values count for more where they are more.
TEST(QualityController, ACutForgetsJudgedLight) {
  Program program;
  program.run(100, 20, ContentStatistics{.light = 1, .judged = true});
  ASSERT_EQ(program->choice().method, kPlain);
  const auto light = [&] {
    return program->reasons().mix.share[static_cast<std::size_t>(SceneClass::kLight)];
  };
  program.run(1, 20, kStill);
  EXPECT_GT(light(), 0.99);
  program.run(1, 20, ContentStatistics{.cut = true});
  EXPECT_EQ(light(), 0);
  program.run(100, 20, ContentStatistics{.light = 0.25, .judged = true});
  program.run(100, 20, ContentStatistics{.light = 0.75});
  EXPECT_NEAR(light(), 0.75, 0.01);
}

// The pair is that of a search over everything, whatever the load and what is shown.
TEST(QualityController, FindsTheLeastErrorThatFits) {
  for (const double full_ms : {10.0, 16.0, 20.0, 26.0, 34.0, 40.0}) {
    for (const double light : {0.0, 0.25, 0.5, 1.0}) {
      Program program([](auto& s) { s.hysteresis = 0; });
      program.run(300, full_ms, ContentStatistics{.light = light});
      double least = 1;
      for (const MethodVariant& method : {kPlain, kTwo, kDear}) {
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
    EXPECT_EQ(program->choice().render_extent, program->ladder()[0]);
    const auto cost = [full_ms](const MethodVariant& method) {
      const double ms = full_ms * 0.4 + passes_ms(method);
      return flip(SceneClass::kStill, method, 0.5) * ms * ms;
    };
    for (const MethodVariant& other : {kPlain, kTwo, kDear})
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
    ASSERT_TRUE(predictive.value()->observe({.frame = frame, .render_extent = render, .gpu_ms = ms}).ok());
  }
  EXPECT_NEAR(program->ladder().area_fraction(program->choice().render_extent),
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
  EXPECT_EQ(program->choice().render_extent, kLadder.output_extent);
  for (std::uint64_t frame = 1000; frame < 1100; ++frame) {
    const QualityFrame blurred = {
        .timing = {
            .frame = frame, .render_extent = program->choice().render_extent, .gpu_ms = 10, .blur_px = 40}};
    ASSERT_TRUE(program->observe(blurred).ok());
  }
  EXPECT_NEAR(program->choice().render_extent.width, 710, 4);
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
    EXPECT_EQ(program->choice().render_extent, before.render_extent);
    EXPECT_EQ(program->choice().method, before.method);
  };
  const FrameTiming good = {.render_extent = {800, 800}, .gpu_ms = 10};
  for (const double bad : {-1.0, 10.0, 11.0, std::nan("")})
    refused({.timing = good, .resolve_ms = bad}, "resolve_ms");
  refused({.timing = good, .content = ContentStatistics{.light = 2}}, "content.light");
  refused({.timing = {.render_extent = {0, 800}, .gpu_ms = 10}, .content = kLight}, "render");
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
