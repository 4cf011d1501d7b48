// SPDX-License-Identifier: MIT
// A sky that was drawn infinitely far away and without motion, behind silhouettes and under a camera that turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::Mask;
using testing::Pixel;
using testing::Place;
using testing::Surface;
using testing::TemporalRun;
using testing::TemporalScene;
using Pixels = std::vector<Pixel>;
using Shape = Surface::Shape;

constexpr Extent kOutput{160, 96};
constexpr int kFirst = 10, kEnd = 26;  // frames that count

constexpr ResolveSettings kMethods[] = {
    {.method = Method::kTemporal},
    {.method = Method::kTemporal, .temporal = {.preset = TemporalPreset::kFast}},
    {.method = Method::kQuincunx},
    {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kReprojected}}};

// Posts and a ground before clouds; what is nearer moves faster.
TemporalScene scene_under(Place pan, Place turn) {
  TemporalScene scene;
  const Place middle(kOutput.width / 2., kOutput.height / 2.);
  for (int i = 0; i < 10; ++i) {
    scene.surfaces.push_back({.shape = Shape::kRectangle,
                              .half_size = {i % 2 != 0 ? 1.2 : 6., 30},
                              .centre = {30. + 28 * i, 70},
                              .velocity = pan * 1.2,
                              .distance = 20,
                              .texture = testing::noise_texture(7, 3)});
  }
  scene.surfaces.push_back({.shape = Shape::kRectangle,
                            .half_size = {400, 20},
                            .centre = {80, 105},
                            .velocity = pan * 1.1,
                            .distance = 40,
                            .texture = testing::noise_texture(11, 5)});
  scene.surfaces.push_back({.centre = middle,
                            .velocity = pan,
                            .turn = turn,
                            .is_sky = true,
                            .texture = testing::noise_texture(14, 9)});
  return scene;
}

// Its motion was drawn, as that of any surface.
TemporalScene with_drawn_sky(TemporalScene scene) {
  scene.surfaces.back().is_sky = false;
  scene.surfaces.back().distance = 1e30;
  return scene;
}

// The sky that no silhouette has touched, and that which one has just uncovered or is about to hide.
struct SkyErrors {
  double open = 0, beside = 0;
};

bool is_covered(const TemporalScene& scene, int x, int y, int frame, double margin) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end() - 1, [&](const Surface& surface) {
    const Place local =
        Place(x + .5, y + .5) - surface.centre - surface.velocity * static_cast<double>(frame);
    return std::abs(local.real()) < surface.half_size.real() + margin &&
           std::abs(local.imag()) < surface.half_size.imag() + margin;
  });
}

SkyErrors errors_of(const TemporalScene& scene, ResolveSettings settings, SkyMotion far) {
  constexpr double kBeside = 4;  // output pixels
  settings.conventions.sky_motion = far;
  TemporalRun run(scene, settings);
  SkyErrors errors;
  for (int frame = 0; frame < kEnd; ++frame) {
    const Pixels pixels = run.next();
    if (frame < kFirst) continue;
    const Pixels truth = run.truth();
    const Mask open = [&](int x, int y) { return !is_covered(scene, x, y, frame, kBeside); };
    const Mask beside = [&](int x, int y) { return !open(x, y) && !is_covered(scene, x, y, frame, 0); };
    errors.open += testing::squared_error(pixels, truth, kOutput, open) / (kEnd - kFirst);
    errors.beside += testing::squared_error(pixels, truth, kOutput, beside) / (kEnd - kFirst);
  }
  return errors;
}

void expect_as_good_as_drawn(SkyMotion far, Place pan, Place turn, double allowed_db) {
  const TemporalScene scene = scene_under(pan, turn);
  for (const ResolveSettings& settings : kMethods) {
    const SkyErrors drawn = errors_of(with_drawn_sky(scene), settings, SkyMotion::kAsDrawn);
    const SkyErrors found = errors_of(scene, settings, far);
    EXPECT_GE(testing::psnr(found.open), testing::psnr(drawn.open) - allowed_db)
        << name_of(settings.method) << ", pan " << pan << ", turn " << turn;
    EXPECT_GE(testing::psnr(found.beside), testing::psnr(drawn.beside) - allowed_db)
        << name_of(settings.method) << ", pan " << pan << ", turn " << turn;
  }
}

// Velocities from the camera differ from drawn ones by their rounding, whereby other texels are copied.
TEST(SkyMotion, FromTheCameraItIsAsGoodAsDrawn) {
  expect_as_good_as_drawn(SkyMotion::kCamera, {-.4, .1}, 1, .3);
  expect_as_good_as_drawn(SkyMotion::kCamera, {-2.3, .4}, {.999992, .004}, .3);
  expect_as_good_as_drawn(SkyMotion::kCamera, {-6.2, 0}, 1, .3);
}

// The posts and the ground pan with the sky, only faster.
TEST(SkyMotion, FromEvidenceItIsNearlyAsGoodAsDrawn) {
  for (const Place pan : {Place(-.4, .1), Place(-6.2, 0)})
    expect_as_good_as_drawn(SkyMotion::kEvidence, pan, 1, 1);
}

// The fit is worse for this pan: with temporal the sky loses 5 to 6 dB to drawn motion, and gains over none at all as
// much as is expected here. Silhouettes with a layer of their own have less to gain: a sky that is taken for another
// picture leaves them alone.
TEST(SkyMotion, FromEvidenceASkyIsBetterThanWithoutMotion) {
  const TemporalScene scene = scene_under({-2.3, .4}, 1);
  for (const ResolveSettings& settings : kMethods) {
    const SkyErrors still = errors_of(scene, settings, SkyMotion::kAsDrawn);
    const SkyErrors found = errors_of(scene, settings, SkyMotion::kEvidence);
    const bool has_layers =
        settings.method == Method::kTemporal && settings.temporal.preset != TemporalPreset::kFast;
    EXPECT_GE(testing::psnr(found.open), testing::psnr(still.open) + (has_layers ? .7 : 1))
        << name_of(settings.method);
    const double gain = has_layers ? .5 : 1;
    EXPECT_GE(testing::psnr(found.beside), testing::psnr(still.beside) + gain) << name_of(settings.method);
  }
}

// All of this serves one purpose: as it was drawn the sky is smeared, and so are the things before it.
TEST(SkyMotion, WithoutItASkyIsMuchWorse) {
  for (const Place pan : {Place(-2.3, .4), Place(-6.2, 0)}) {
    const TemporalScene scene = scene_under(pan, 1);
    for (const ResolveSettings& settings : {kMethods[0], kMethods[3]}) {
      const SkyErrors drawn = errors_of(with_drawn_sky(scene), settings, SkyMotion::kAsDrawn);
      const SkyErrors still = errors_of(scene, settings, SkyMotion::kAsDrawn);
      EXPECT_LT(testing::psnr(still.open), testing::psnr(drawn.open) - 1) << name_of(settings.method) << pan;
      EXPECT_LT(testing::psnr(still.beside), testing::psnr(drawn.beside) - 1)
          << name_of(settings.method) << pan;
    }
  }
}

// Where nothing is far and without motion not one bit changes.
TEST(SkyMotion, ADrawnSkyIsLeftAlone) {
  const TemporalScene scene = with_drawn_sky(scene_under({-2.3, .4}, 1));
  for (ResolveSettings settings : kMethods) {
    TemporalRun as_drawn(scene, settings);
    settings.conventions.sky_motion = SkyMotion::kCamera;
    TemporalRun completed(scene, settings);
    EXPECT_EQ(as_drawn.until(6), completed.until(6)) << name_of(settings.method);
  }
}

// A picture that hangs behind the scene and moves with the camera does not move on the screen, whatever all else does.
// The match of its colours tells.
TEST(SkyMotion, FromEvidenceAPictureThatHangsBehindStandsStill) {
  for (const Place pan : {Place(-2.3, .4), Place(-6.2, 0)}) {
    TemporalScene scene = scene_under(pan, 1);
    scene.surfaces.back().velocity = 0;
    for (const ResolveSettings& settings : {kMethods[0], kMethods[3]}) {
      const SkyErrors drawn = errors_of(scene, settings, SkyMotion::kAsDrawn);
      const SkyErrors found = errors_of(scene, settings, SkyMotion::kEvidence);
      EXPECT_GE(testing::psnr(found.open), testing::psnr(drawn.open) - .1) << name_of(settings.method) << pan;
      EXPECT_GE(testing::psnr(found.beside), testing::psnr(drawn.beside) - .1)
          << name_of(settings.method) << pan;
    }
  }
}

// A camera that stands still moves nothing: what was drawn as standing still does so, but for rounding.
TEST(SkyMotion, UnderAStillCameraTheSkyStandsStill) {
  TemporalScene scene = scene_under(0, 1);
  for (ResolveSettings settings : kMethods) {
    TemporalRun as_drawn(scene, settings);
    settings.conventions.sky_motion = SkyMotion::kCamera;
    TemporalRun completed(scene, settings);
    EXPECT_LE(testing::largest_difference(as_drawn.until(12), completed.until(12), kOutput), 1e-4)
        << name_of(settings.method);
  }
}

}  // namespace
}  // namespace quincunx
