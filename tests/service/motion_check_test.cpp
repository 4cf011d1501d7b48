// SPDX-License-Identifier: MIT
// What the service says of velocity whose signs are wrong, and of velocity that is right.
#include <gtest/gtest.h>

#include <algorithm>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Place;
using testing::Surface;
using testing::TemporalRun;
using testing::TemporalScene;

constexpr Extent kRender = {120, 72};

constexpr ResolveSettings kMethods[] = {
    {.method = Method::kQuincunx},
    {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kReprojected}},
    {.method = Method::kTemporal}};

// A disc before a wall, which move apart.
TemporalScene scene_moving(Place wall, Place disc) {
  TemporalScene scene;
  scene.surfaces = {{.shape = Surface::Shape::kDisc,
                     .half_size = {24, 0},
                     .centre = {60, 70},
                     .velocity = disc,
                     .texture = testing::noise_texture(9, 3)},
                    {.velocity = wall, .distance = 20, .texture = testing::noise_texture(12, 5)}};
  return scene;
}

// Runs as many frames, whose velocities are multiplied by `turn`, and returns what the last one says.
MotionCheck after(int frames, const TemporalScene& scene, ResolveSettings settings, Vec2 turn,
                  bool cuts = false) {
  settings.checks_motion = true;
  TemporalRun run(scene, settings);
  MotionCheck said;
  for (int i = 0; i < frames; ++i) {
    HostFrame frame = scene.render(i, kRender, testing::halton_jitter(i, 16));
    frame.velocity = [drawn = frame.velocity, turn](int x, int y) {
      const Vec2 v = drawn(x, y);
      return Vec2{turn.x * v.x, turn.y * v.y};
    };
    frame.reset = cuts;
    run.rig().resolve(frame);
    EXPECT_TRUE(run.rig().service().finish().ok());
    while (const auto report = run.rig().service().next_completed())
      said = report->motion;
  }
  return said;
}

TEST(MotionCheck, NamesTheSignsThatAreWrong) {
  const TemporalScene scene = scene_moving({-5, 3}, {4, -6});
  for (const ResolveSettings& settings : kMethods) {
    const auto named = [&](Vec2 turn) { return after(9, scene, settings, turn).verdict; };
    EXPECT_EQ(named({1, 1}), MotionVerdict::kRight) << name_of(settings.method);
    EXPECT_EQ(named({-1, 1}), MotionVerdict::kSignOfX) << name_of(settings.method);
    EXPECT_EQ(named({1, -1}), MotionVerdict::kSignOfY) << name_of(settings.method);
    EXPECT_EQ(named({-1, -1}), MotionVerdict::kDirection) << name_of(settings.method);
  }
  EXPECT_GT(after(9, scene, {}, {1, -1}).margin_db, 6);
}

TEST(MotionCheck, ReadsVelocityAsTheConventionsSay) {
  ResolveSettings settings;
  settings.conventions.velocity_up = true;
  EXPECT_EQ(after(9, scene_moving({-5, 3}, {4, -6}), settings, {1, 1}).verdict, MotionVerdict::kSignOfY);
  EXPECT_EQ(after(9, scene_moving({-5, 3}, {4, -6}), settings, {1, -1}).verdict, MotionVerdict::kRight);
}

TEST(MotionCheck, SaysNothingOfWhatItCannotSee) {
  const TemporalScene scene = scene_moving({-5, 3}, {4, -6});
  EXPECT_EQ(after(12, scene_moving(0, 0), {}, {1, -1}).verdict, MotionVerdict::kUnknown) << "still";
  EXPECT_EQ(after(8, scene, {}, {1, -1}).verdict, MotionVerdict::kUnknown) << "seven pairs of frames";
  EXPECT_EQ(after(12, scene, {}, {1, -1}, true).verdict, MotionVerdict::kUnknown) << "cut after cut";
  EXPECT_EQ(after(9, scene_moving({-6, 0}, {4, 0}), {}, {1, 1}).verdict, MotionVerdict::kRightX);
  EXPECT_EQ(after(9, scene_moving({-6, 0}, {4, 0}), {}, {-1, 1}).verdict, MotionVerdict::kSignOfX);
}

ResolvePlan plan_of(const SceneNeeds& needs, ResolveSettings settings, bool checks) {
  settings.output_extent = settings.target_extent = {64, 64};
  settings.checks_motion = checks;
  return plan_for(needs, settings).value();
}

TEST(MotionCheck, IsAPassOfItsOwnWhereItIsAskedFor) {
  const auto is_check = [](const PlannedPass& pass) { return pass.kernel == "check_motion"; };
  for (const ResolveSettings& settings : kMethods) {
    const ResolvePlan without = plan_of({}, settings, false);
    ResolvePlan with = plan_of({}, settings, true);
    EXPECT_TRUE(std::none_of(without.passes.begin(), without.passes.end(), is_check));
    EXPECT_EQ(std::erase_if(with.passes, is_check), 1u) << name_of(settings.method);
    EXPECT_EQ(with.passes, without.passes) << name_of(settings.method);
    EXPECT_EQ(with.frame_bytes(), without.frame_bytes()) << "it asks for no image more";
  }
}

TEST(MotionCheck, IsLeftOutWhereThereIsNoVelocityToCheck) {
  const auto reason = [](const SceneNeeds& needs, const ResolveSettings& settings) -> std::string {
    for (const LeftOut& left : plan_of(needs, settings, true).left_out)
      if (left.what == "check_motion") return left.why;
    return "";
  };
  EXPECT_EQ(reason({}, {.method = Method::kBilinear}), "no pass reads velocity");
  EXPECT_EQ(reason({}, {.method = Method::kBilinear, .blur = {.shutter = .5f}}),
            "the method uses one frame only");
  EXPECT_EQ(reason({.moving_objects = false}, {}), "velocity comes from depth and the camera");
}

}  // namespace
}  // namespace quincunx
