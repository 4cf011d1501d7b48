// SPDX-License-Identifier: MIT
// The loop's logic with times that the tests make up.
#include "session/frame_pacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "session/paced_loop.h"

namespace quincunx::scenes {
namespace {

constexpr double kRefreshMs = 20;  // at 50 Hz

PacingSettings settings(ControllerKind kind = ControllerKind::kPredictive) {
  PacingSettings result;
  result.controller = kind;
  result.ladder = {.output_extent = {1280, 720}, .min_scale = 0.5};
  result.target_fps = 1000 / kRefreshMs;
  return result;
}

FramePacing made(const PacingSettings& settings) {
  return std::move(FramePacing::create(settings)).value();
}

// Draws one frame after the other as a program does: waits for a buffer, works `cost(render)` ms, tells.
class Player {
 public:
  explicit Player(const PacingSettings& settings) : pacing(made(settings)) {}

  template <typename Cost>
  void play(int frames, Cost cost) {
    for (int i = 0; i < frames; ++i) {
      now = std::max(now, pacing.free_at().value());
      const Extent render = pacing.next().value_or(Extent{1280, 720});
      const std::uint64_t frame = pacing.begin(now, render);
      now += cost(render);
      pacing.finish(frame, now);
      pacing.observe(frame, pacing.busy_ms(frame));
    }
  }
  const tools::PacedFrame& last() const { return pacing.run().frames.back(); }

  FramePacing pacing;
  double now = 1000;  // time of a clock that did not begin with the run
};

double area(Extent render) {
  return static_cast<double>(render.area()) / (1280 * 720);
}

TEST(FramePacing, BadSettingsAreNamed) {
  const auto message = [](PacingSettings bad) { return FramePacing::create(bad).status().message(); };
  for (const double fps : {0.0, -30.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-9}) {
    PacingSettings bad = settings();
    bad.target_fps = fps;
    EXPECT_NE(message(bad).find("frames a second"), std::string::npos) << fps;
  }
  PacingSettings bad = settings();
  bad.buffers = 1;
  EXPECT_NE(message(bad).find("buffers"), std::string::npos);
  bad = settings();
  bad.headroom = 0.7;
  EXPECT_NE(message(bad).find("headroom"), std::string::npos);
  for (const ControllerKind kind :
       {ControllerKind::kPredictive, ControllerKind::kProportional, ControllerKind::kMinimumOfN}) {
    bad = settings(kind);
    bad.ladder.min_scale = 0.9;
    bad.ladder.max_scale = 0.5;
    EXPECT_NE(message(bad).find("scale"), std::string::npos) << name_of(kind);
  }
}

// `quincunx:reprojected` errs least where light alone changes, the temporal methods where nothing does.
TEST(FramePacing, AChangeOfMethodIsNotedWithTheFrameThatBeginsIt) {
  FramePacing pacing = made(settings(ControllerKind::kQuality));
  double now = 0;
  for (int i = 0; i < 300; ++i) {
    now = std::max(now, pacing.free_at().value());
    const QualityChoice choice = pacing.choice().value();
    EXPECT_EQ(choice.render_extent, pacing.next());
    const std::uint64_t frame = pacing.begin(now, choice.render_extent);
    FrameCosts costs{.gpu_ms = 1 + 38 * area(choice.render_extent), .resolve_ms = 1};
    pacing.finish(frame, now += costs.gpu_ms);
    costs.content.emplace().light = i < 150 ? 0 : 1;
    pacing.observe(frame, costs);
    const tools::PacedFrame& noted = pacing.run().frames.back();
    EXPECT_EQ(noted.method, name_of(choice.method));
    EXPECT_EQ(noted.fading_from.empty(), !choice.fading_from.has_value());
    EXPECT_EQ(noted.weight, choice.weight);
    EXPECT_EQ(noted.content->light, i < 150 ? 0 : 1);
  }
  ASSERT_FALSE(pacing.run().method_changes.empty());
  const tools::MethodChange& change = pacing.run().method_changes.back();
  EXPECT_GE(change.frame, 150);
  EXPECT_EQ(change.to, "quincunx:reprojected");
  EXPECT_NE(change.why.find("light"), std::string::npos) << change.why;
  EXPECT_EQ(pacing.run().frames[static_cast<std::size_t>(change.frame)].fading_from, change.from);
  EXPECT_NE(pacing.reasons().find("Chosen         quincunx:reprojected"), std::string::npos);
  EXPECT_FALSE(made(settings()).choice().has_value());
}

TEST(FramePacing, ThreeBuffersHoldTwoFinishedFramesAndTheThirdWaits) {
  Player player(settings(ControllerKind::kFixed));
  player.play(3, [](Extent) { return 5; });
  // Shown at 0, 20, 40 after the first was finished; the fourth waits until the third frame replaces the
  // second.
  const auto& frames = player.pacing.run().frames;
  EXPECT_EQ(frames[0].shown_ms, 0);
  EXPECT_EQ(frames[1].shown_ms, 20);
  EXPECT_EQ(frames[2].shown_ms, 40);
  EXPECT_EQ(frames[2].finished_ms, 10);
  EXPECT_EQ(frames[2].queued, 2);
  EXPECT_EQ(player.pacing.free_at(), 1000 + 5 + 20)
      << "frame 3 draws where frame 0 was until frame 1 replaced it";
  player.play(1, [](Extent) { return 5; });
  EXPECT_EQ(player.last().start_ms, 20);
  EXPECT_EQ(player.last().busy_ms, 5) << "waiting is no work";
  EXPECT_EQ(player.last().shown_ms, 60);
}

TEST(FramePacing, EveryRefreshWithoutANewFrameIsCounted) {
  Player player(settings(ControllerKind::kFixed));
  player.play(1, [](Extent) { return 5; });
  player.play(1, [](Extent) { return 20; });  // exactly at the refresh
  EXPECT_EQ(player.last().missed, 0);
  player.play(1, [](Extent) { return 65; });
  EXPECT_EQ(player.last().shown_ms, 100) << "finished at 85";
  EXPECT_EQ(player.last().missed, 3);
  EXPECT_EQ(player.last().queued, 1);
}

TEST(FramePacing, AnOverlappingFrameCostsWhatItAdds) {
  FramePacing pacing = made(settings(ControllerKind::kFixed));
  EXPECT_EQ(pacing.begin(0, {64, 64}), 0u);
  EXPECT_EQ(pacing.begin(6, {64, 64}), 1u);
  EXPECT_EQ(pacing.busy_ms(0), 0) << "not finished";
  pacing.finish(1, 9);  // out of order: nothing
  EXPECT_TRUE(pacing.run().frames.empty());
  pacing.finish(0, 10);
  pacing.finish(1, 17);
  EXPECT_EQ(pacing.busy_ms(0), 10);
  EXPECT_EQ(pacing.busy_ms(1), 7);
}

TEST(FramePacing, ABufferThatDependsOnAnUnfinishedFrameIsNotKnown) {
  PacingSettings two = settings(ControllerKind::kFixed);
  two.buffers = 2;
  FramePacing pacing = made(two);
  EXPECT_LT(pacing.free_at().value(), 0);
  pacing.begin(0, {64, 64});
  EXPECT_LT(pacing.free_at().value(), 0);
  pacing.begin(0, {64, 64});
  EXPECT_EQ(pacing.free_at(), std::nullopt);
  pacing.finish(0, 3);
  EXPECT_EQ(pacing.free_at(), std::nullopt) << "of frame 1, which will replace frame 0";
  pacing.finish(1, 5);
  EXPECT_EQ(pacing.free_at(), 3 + kRefreshMs);
}

TEST(FramePacing, EachControllerHoldsTheRateThroughAHeavyMoment) {
  const auto light = [](Extent render) { return 2 + 22 * area(render); };
  const auto heavy = [](Extent render) { return 4 + 40 * area(render); };
  for (const ControllerKind kind :
       {ControllerKind::kPredictive, ControllerKind::kProportional, ControllerKind::kMinimumOfN}) {
    Player player(settings(kind));
    player.play(300, light);
    const double light_area = area(player.pacing.next().value());
    player.play(300, heavy);
    EXPECT_LT(area(player.pacing.next().value()), 0.7 * light_area) << name_of(kind);
    player.play(300, light);
    EXPECT_NEAR(area(player.pacing.next().value()), light_area, 0.1) << name_of(kind);
    const tools::PacingSummary summary = summary_of(player.pacing.run());
    EXPECT_GT(summary.achieved_fps, 48) << name_of(kind);
    EXPECT_EQ(player.pacing.run().controller, name_of(kind));
  }
}

TEST(FramePacing, AnInfeasibleLoadStaysAtTheLowestRungAndIsLeftAtOnce) {
  Player player(settings());
  player.play(200, [](Extent render) { return 60 + 60 * area(render); });
  EXPECT_EQ(player.pacing.controller()->rung(), 0);
  player.play(30, [](Extent render) { return 5 + 5 * area(render); });
  EXPECT_EQ(player.pacing.next(), (Extent{1280, 720})) << "no wind-up";
}

TEST(FramePacing, LongStreaksLowerTheHighestResolution) {
  PacingSettings blurred = settings();
  blurred.blur_aware.enabled = true;
  FramePacing pacing = made(blurred);
  for (std::uint64_t frame = 0; frame < 40; ++frame) {
    const double now = static_cast<double>(frame) * kRefreshMs;
    pacing.begin(now, pacing.next().value(), frame < 20 ? 0 : 30, 2);
    pacing.finish(frame, now + 1);
    pacing.observe(frame, 1);
    if (frame == 19) {
      EXPECT_EQ(pacing.next(), (Extent{1280, 720}));
    }
  }
  EXPECT_NEAR(area(pacing.next().value()), 0.71 * 0.71, 0.01);
  EXPECT_EQ(pacing.run().frames[39].blur_px, 30);
  EXPECT_EQ(pacing.run().frames[39].detail, 2);
}

TEST(FramePacing, HeadroomIsLeftFree) {
  PacingSettings careful = settings();
  careful.headroom = 0.2;
  Player player(careful);
  player.play(300, [](Extent render) { return 2 + 26 * area(render); });
  EXPECT_LE(player.last().busy_ms, 0.8 * kRefreshMs);
  EXPECT_GT(player.last().busy_ms, 0.75 * kRefreshMs);
}

TEST(FramePacing, BadTimesChangeNothing) {
  Player player(settings());
  player.play(50, [](Extent render) { return 30 * area(render); });
  const Extent before = player.pacing.next().value();
  const double busy = player.last().busy_ms;
  for (const double time : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    player.pacing.observe(49, time);
    EXPECT_EQ(player.last().busy_ms, busy);
  }
  player.pacing.observe(49, 500);  // again
  player.pacing.observe(50, 500);  // never drawn
  EXPECT_EQ(player.pacing.next(), before);
  EXPECT_EQ(player.last().busy_ms, busy);
}

TEST(FramePacing, AFixedRunTakesNoNonsenseEither) {
  Player player(settings(ControllerKind::kFixed));
  player.play(3, [](Extent) { return 5; });
  for (const double time : {0.0, std::nan(""), 4e7}) {
    player.pacing.observe(2, time);
    EXPECT_EQ(player.last().busy_ms, 5);
  }
}

TEST(FramePacing, TheSameTimesGiveTheSameRun) {
  const auto cost = [](Extent render) { return 3 + 28 * area(render) + 0.01 * (render.width % 7); };
  Player one(settings());
  Player two(settings());
  one.play(200, cost);
  two.play(200, cost);
  for (std::size_t i = 0; i < 200; ++i)
    ASSERT_EQ(one.pacing.run().frames[i].render, two.pacing.run().frames[i].render) << i;
}

TEST(FramePacing, WithoutADisplayNoFrameWaitsOrMissesARefresh) {
  FramePacing pacing = FramePacing::free_running({1280, 720});
  EXPECT_FALSE(pacing.has_display());
  EXPECT_FALSE(pacing.next());
  EXPECT_FALSE(pacing.choice());
  double now = 1000;
  for (std::uint64_t frame = 0; frame < 20; ++frame) {
    EXPECT_LE(pacing.free_at().value(), now) << frame;
    EXPECT_EQ(pacing.begin(now, {640, 360}), frame);
    EXPECT_LE(pacing.free_at().value(), now) << "the next one may begin before this one is finished";
    now += 70;
    pacing.finish(frame, now);
    pacing.observe(frame, pacing.busy_ms(frame));
    const tools::PacedFrame& finished = pacing.run().frames.back();
    EXPECT_EQ(finished.busy_ms, 70);
    EXPECT_EQ(finished.missed, 0);
    EXPECT_EQ(finished.shown_ms, finished.finished_ms);
  }
  EXPECT_TRUE(made(settings()).has_display());
}

TEST(FrameMeter, MeasuresNoDeviceWhosePassesHaveNoEvents) {
  for (const PassTimer passes : {PassTimer::kHostClock, PassTimer::kNone}) {
    const auto chosen = FrameMeter::create(FrameCost::kAuto, passes);
    ASSERT_TRUE(chosen.ok()) << chosen.status().message();
    EXPECT_FALSE(chosen->measures_device());
    const auto refused = FrameMeter::create(FrameCost::kDevice, passes);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
    EXPECT_NE(refused.status().message().find("--frame-cost"), std::string::npos);
  }
}

TEST(CameraStreak, IsNothingForACameraThatStandsStill) {
  EXPECT_EQ(camera_streak_px({}, 0.1f, {1280, 720}, 1), 0);
}

TEST(CameraStreak, OfAShiftIsTheShift) {
  CameraMotion motion;
  motion.clip_to_previous_clip[12] = 0.1f;  // every point was a twentieth of the width further right
  // Single precision: a few roundings of values up to 1.
  EXPECT_NEAR(camera_streak_px(motion, 0.1f, {1000, 500}, 0.5f), 0.5 * 0.05 * 1000, 1e-3);
}

TEST(CameraStreak, LeavesOutWhatWasBehindTheCamera) {
  CameraMotion motion;
  motion.clip_to_previous_clip[15] = -1;
  EXPECT_EQ(camera_streak_px(motion, 0.1f, {1000, 500}, 1), 0);
  motion.clip_to_previous_clip[15] = std::nanf("");
  EXPECT_EQ(camera_streak_px(motion, 0.1f, {1000, 500}, 1), 0);
}

}  // namespace
}  // namespace quincunx::scenes
