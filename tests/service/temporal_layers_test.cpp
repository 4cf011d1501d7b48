// SPDX-License-Identifier: MIT
// Two layers of history: thin things before something that moves differently.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::Place;
using testing::TemporalRun;
using testing::TemporalScene;

using Pixels = std::vector<Pixel>;

ResolveSettings preset(TemporalPreset preset, TemporalView view = TemporalView::kPicture) {
  ResolveSettings settings{.method = Method::kTemporal};
  settings.temporal.preset = preset;
  settings.temporal.view = view;
  return settings;
}

// The mean over frames 16 to 31.
double error_of(const TemporalScene& scene, const ResolveSettings& settings) {
  TemporalRun run(scene, settings);
  run.until(16);
  double sum = 0;
  for (int i = 0; i < 16; ++i) {
    const Pixels shown = run.next();
    sum += testing::squared_error(shown, run.truth(), scene.output);
  }
  return sum / 16;
}

TEST(TemporalLayers, WiresAndWhatIsBehindThemGain) {
  const TemporalScene scene = testing::wires_before_a_wall();
  const double one = error_of(scene, preset(TemporalPreset::kFast));
  for (const TemporalPreset two : {TemporalPreset::kBalanced, TemporalPreset::kQuality})
    EXPECT_LT(error_of(scene, preset(two)), .7 * one);
}

// Returns whether the pixel and those around it are `colour` in the truth.
bool lies_within(const Pixels& truth, Extent output, float colour, int x, int y) {
  for (int j = y - 1; j <= y + 1; ++j) {
    for (int i = x - 1; i <= x + 1; ++i) {
      if (i < 0 || j < 0 || i >= output.width || j >= output.height) return false;
      if (truth[static_cast<std::size_t>(j * output.width + i)][0] != colour) return false;
    }
  }
  return true;
}

// Pixels of one layer lie beside such of two, whose far layer is the sky.
TEST(TemporalLayers, ABladeThatTurnsShowsNoSkyBehindIt) {
  constexpr float kDark = .03125f, kSky = 16;
  TemporalScene scene;
  scene.surfaces.push_back({.shape = testing::Surface::Shape::kRectangle,
                            .half_size = {60, 7},
                            .centre = {80, 48},
                            .turn = std::polar(1., .03),
                            .distance = 4,
                            .texture = testing::plain_texture(kDark, kDark, kDark)});
  scene.surfaces.push_back({.texture = testing::plain_texture(kSky, kSky, kSky)});
  TemporalRun run(scene, preset(TemporalPreset::kBalanced));
  run.until(16);
  int within = 0, lighter = 0;
  for (int frame = 0; frame < 8; ++frame) {
    const Pixels shown = run.next();
    const Pixels truth = run.truth();
    for (int y = 0; y < scene.output.height; ++y) {
      for (int x = 0; x < scene.output.width; ++x) {
        if (!lies_within(truth, scene.output, kDark, x, y)) continue;
        ++within;
        lighter += shown[static_cast<std::size_t>(y * scene.output.width + x)][0] > 2 * kDark ? 1 : 0;
      }
    }
  }
  EXPECT_GT(within, 8'000);
  EXPECT_LT(lighter, within / 200);
}

TEST(TemporalLayers, WhereNothingMovesApartThereIsOneLayer) {
  TemporalScene scene = testing::wires_before_a_wall();
  for (testing::Surface& surface : scene.surfaces)
    surface.velocity = {.4, 0};
  TemporalRun run(scene, preset(TemporalPreset::kBalanced, TemporalView::kLayers));
  for (const Pixel& pixel : run.until(12))
    ASSERT_EQ(pixel[0], 0);
}

// Wires under a camera that turns, before a sky of broad bands that was drawn infinitely far away and without motion,
// as Cycles draws it.
TemporalScene wires_before_a_sky() {
  TemporalScene scene = testing::wires_before_a_wall();
  for (testing::Surface& surface : scene.surfaces) {
    surface.velocity = {-4.3, .2};
    surface.turn = std::polar(1., .0004);
  }
  for (std::size_t i = 0; i + 1 < scene.surfaces.size(); ++i)
    scene.surfaces[i].centre += 120;
  testing::Surface& sky = scene.surfaces.back();
  sky.velocity = {-3.4, 0};
  sky.is_sky = true;
  sky.texture = [](Place place) {
    const auto wave = static_cast<float>(.5 + .5 * std::sin(place.real() / 6));
    return Pixel{.25f + .55f * wave, .4f + .45f * wave, .7f + .2f * wave, 1};
  };
  return scene;
}

// History of the sky is wrong and rejected, in every frame; what is known of the wires must not go with it.
TEST(TemporalLayers, WiresBeforeASkyThatIsSaidToStandStillAreBetterThanBilinear) {
  const TemporalScene scene = wires_before_a_sky();
  const double bilinear = error_of(scene, {.method = Method::kBilinear});
  EXPECT_LT(error_of(scene, preset(TemporalPreset::kBalanced)), .7 * bilinear);
}

// Other wires of the same depths, before another wall.
TEST(TemporalLayers, ACutThatNobodyAnnouncesLeavesNothingOfTheNearLayer) {
  const auto error_after_cut = [](TemporalPreset one) {
    TemporalRun run(testing::wires_before_a_wall(), preset(one));
    run.until(20);
    for (testing::Surface& surface : run.scene().surfaces) {
      surface.centre += Place(9, 5);
      surface.texture = testing::plain_texture(.8f, .7f, .1f);
    }
    run.scene().surfaces.back().texture = testing::noise_texture(9, 5);
    const Pixels shown = run.next();
    return testing::squared_error(shown, run.truth(), run.scene().output);
  };
  EXPECT_LT(error_after_cut(TemporalPreset::kBalanced), 1.05 * error_after_cut(TemporalPreset::kFast));
}

TEST(TemporalLayers, ViewsShowThem) {
  const TemporalScene scene = testing::wires_before_a_wall();
  const auto show = [&scene](TemporalView view) {
    return TemporalRun(scene, preset(TemporalPreset::kBalanced, view)).until(12);
  };
  const Pixels layers = show(TemporalView::kLayers), coverage = show(TemporalView::kCoverage);
  const Pixels near = show(TemporalView::kNear), far = show(TemporalView::kFar);
  const Pixels picture = show(TemporalView::kPicture);
  int two = 0, solid = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    ASSERT_TRUE(layers[i][0] == 0 || layers[i][0] == 1) << i;
    two += layers[i][0] == 1;
    solid += coverage[i][0] > .5f;
    EXPECT_EQ(layers[i][1], coverage[i][0]) << i;
    if (layers[i][0] == 0) {
      EXPECT_EQ(coverage[i][0], 0) << i;
      EXPECT_EQ(picture[i], far[i]) << i;
      continue;
    }
    if (layers[i][2] * 32 < .15f) continue;  // the near layer stands in for an unknown far one
    const float open = 1 - std::clamp(coverage[i][0], 0.f, 1.f);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(picture[i][c], near[i][c] + open * far[i][c], 1e-5) << i;
  }
  EXPECT_GT(two, 1000);
  EXPECT_LT(two, 160 * 96 / 2);
  EXPECT_GT(solid, 100);
}

TEST(TemporalLayers, AlphaOfOpaqueSamplesIsOneAndChangesNoColour) {
  const TemporalScene scene = testing::wires_before_a_wall();
  TemporalRun opaque(scene, preset(TemporalPreset::kBalanced), {.background = true});
  TemporalRun alpha(scene, preset(TemporalPreset::kBalanced), {.background = false});
  for (int frame = 0; frame < 12; ++frame) {
    const Pixels expected = opaque.next(), actual = alpha.next();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(actual[i][c], expected[i][c]) << frame << ", " << i;
      ASSERT_NEAR(actual[i][3], 1, 2e-3) << frame << ", " << i;  // a coverage may be off by halves
    }
  }
}

// A wire before nothing: its coverage is the picture's alpha.
TEST(TemporalLayers, AlphaOfAWireBeforeNothingIsItsCoverage) {
  TemporalScene scene = testing::wires_before_a_wall();
  scene.surfaces.back().texture = [](Place) { return Pixel{0, 0, 0, 0}; };
  TemporalRun run(scene, preset(TemporalPreset::kBalanced), {.background = false});
  const Pixels shown = run.until(24), truth = run.truth();
  double error = 0, bilinear = 0;
  ResolveSettings one_frame{.method = Method::kBilinear};
  TemporalRun single(scene, one_frame, {.background = false});
  const Pixels blurred = single.until(24);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    error += (shown[i][3] - truth[i][3]) * (shown[i][3] - truth[i][3]);
    bilinear += (blurred[i][3] - truth[i][3]) * (blurred[i][3] - truth[i][3]);
  }
  EXPECT_LT(error, .5 * bilinear);
}

TEST(TemporalLayers, AViewOfThemIsRefusedWhereThereIsOne) {
  const auto refused = [](const SceneNeeds& needs, TemporalPreset one) {
    ResolveSettings settings = preset(one, TemporalView::kCoverage);
    settings.output_extent = settings.target_extent = {64, 64};
    return plan_for(needs, settings).status().message();
  };
  EXPECT_NE(refused({}, TemporalPreset::kFast).find("settings.temporal.view is coverage"), std::string::npos);
  EXPECT_NE(
      refused({.moving_objects = false, .camera_motion = false}, TemporalPreset::kBalanced).find("one layer"),
      std::string::npos);
  EXPECT_EQ(refused({}, TemporalPreset::kBalanced), "");
}

TEST(TemporalLayers, ChangingSizesAndResetsAreSurvived) {
  const TemporalScene scene = testing::wires_before_a_wall();
  TemporalRun run(scene, preset(TemporalPreset::kBalanced));
  ResolveSettings one_frame{.method = Method::kBilinear};
  TemporalRun single(scene, one_frame);
  double error = 0, bilinear = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const int grown = frame * 7 % 24;
    const Extent render = {80 + 2 * grown, 48 + grown};
    const Pixels shown = run.next(render), blurred = single.next(render);
    for (const Pixel& pixel : shown)
      ASSERT_TRUE(std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2]));
    if (frame < 16) continue;
    error += testing::squared_error(shown, run.truth(), scene.output);
    bilinear += testing::squared_error(blurred, run.truth(), scene.output);
  }
  EXPECT_LT(error, .7 * bilinear);
}

// Two layers where depth and motion are not exact: rounded, noisy or spread by the renderer.

// A renderer's change to exact inputs.
struct Fault {
  std::string name;
  std::function<void(HostFrame&)> apply;
};

// In [-1, 1], of a sample and a frame.
float noise(int x, int y, float salt) {
  const float value =
      std::sin(12.9898f * static_cast<float>(x) + 78.233f * static_cast<float>(y) + salt) * 43758.5f;
  return 2 * (value - std::floor(value)) - 1;
}

// Velocity in 8 bits over +-16 samples.
void round_velocity(HostFrame& frame) {
  const float columns = 8 * static_cast<float>(frame.render.width);
  const float rows = 8 * static_cast<float>(frame.render.height);
  frame.velocity = [exact = frame.velocity, columns, rows](int x, int y) {
    const Vec2 v = exact(x, y);
    return Vec2{std::round(v.x * columns) / columns, std::round(v.y * rows) / rows};
  };
}

// Velocity of the nearest of 3x3 samples, as many temporal filters want it.
void spread_velocity(HostFrame& frame) {
  frame.velocity = [exact = frame.velocity, depth = frame.depth, render = frame.render](int x, int y) {
    int from_x = x, from_y = y;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, render.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, render.width - 1); ++i) {
        if (depth(i, j) > depth(from_x, from_y)) std::tie(from_x, from_y) = std::pair(i, j);
      }
    }
    return exact(from_x, from_y);
  };
}

// By up to a tenth of a sample each way.
void shake_velocity(HostFrame& frame) {
  const float columns = 10 * static_cast<float>(frame.render.width);
  const float rows = 10 * static_cast<float>(frame.render.height);
  frame.velocity = [exact = frame.velocity, salt = frame.jitter.x, columns, rows](int x, int y) {
    const Vec2 v = exact(x, y);
    return Vec2{v.x + noise(x, y, salt) / columns, v.y + noise(y, x, salt) / rows};
  };
}

void shake_depth(HostFrame& frame) {
  frame.depth = [exact = frame.depth, salt = frame.jitter.x](int x, int y) {
    return exact(x, y) * (1 + .01f * noise(x, y, salt));
  };
}

// The mean over frames 16 to 31.
double error_of(TemporalPreset preset, const std::function<void(HostFrame&)>& apply,
                DrawnVelocity drawn = DrawnVelocity::kOwn) {
  constexpr Extent kRender{80, 48};
  ResolveSettings settings{.method = Method::kTemporal};
  settings.temporal.preset = preset;
  settings.conventions.drawn_velocity = drawn;
  TemporalRun run(testing::wires_before_a_wall(), settings);
  double sum = 0;
  for (int i = 0; i < 32; ++i) {
    const int phases = testing::halton_phases(run.scene().output, kRender);
    HostFrame frame = run.scene().render(i, kRender, testing::halton_jitter(i, phases));
    apply(frame);
    const auto shown = run.rig().resolve(frame);
    run.skip();
    if (i >= 16) sum += testing::squared_error(shown, run.truth(), run.scene().output);
  }
  return sum / 16;
}

class InexactLayers : public ::testing::TestWithParam<Fault> {};

// Two layers need surfaces that move apart. Where the renderer has blurred that, little is gained, but nothing lost.
TEST_P(InexactLayers, AreNoWorseThanOne) {
  EXPECT_LE(error_of(TemporalPreset::kBalanced, GetParam().apply),
            error_of(TemporalPreset::kFast, GetParam().apply));
}

INSTANTIATE_TEST_SUITE_P(Faults, InexactLayers,
                         ::testing::Values(Fault{"spread_velocity", spread_velocity},
                                           Fault{"velocity_noise", shake_velocity}),
                         [](const auto& instance) { return instance.param.name; });

// Rounding to an eighth of a sample makes the wires' velocity wrong by .08 output pixels in each frame, always the same
// way. The long history of a near layer smears by that; one layer is corrected where surfaces move apart.
TEST(RoundedVelocity, CostsTwoLayersAtMostAQuarterMoreThanOne) {
  EXPECT_LE(error_of(TemporalPreset::kBalanced, round_velocity),
            1.25 * error_of(TemporalPreset::kFast, round_velocity));
}

// Spread velocity can be taken back: most of the gain of two layers is there again.
TEST(SpreadLayers, GainAlmostAsMuchOnceVelocityIsTakenBack) {
  const auto keep = [](HostFrame&) {};
  const double one = error_of(TemporalPreset::kFast, keep);
  const double two = error_of(TemporalPreset::kBalanced, keep);
  const double taken_back = error_of(TemporalPreset::kBalanced, spread_velocity, DrawnVelocity::kDilated);
  EXPECT_LT(taken_back - two, .2 * (one - two)) << one << " " << two << " " << taken_back;
  EXPECT_LE(error_of(TemporalPreset::kFast, spread_velocity, DrawnVelocity::kDilated), 1.02 * one);
}

TEST(ExactLayers, NoiseInDepthTakesNothing) {
  const double exact = error_of(TemporalPreset::kBalanced, [](HostFrame&) {});
  EXPECT_LE(error_of(TemporalPreset::kBalanced, shake_depth), 1.02 * exact);
}

}  // namespace

}  // namespace quincunx
