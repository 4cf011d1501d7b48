// SPDX-License-Identifier: MIT
// Cuts that nobody announces, and fine textures, which only look like one.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::Pixel;
using testing::Place;
using testing::TemporalRun;
using testing::TemporalScene;
using testing::Texture;

constexpr TemporalPreset kPresets[] = {TemporalPreset::kFast, TemporalPreset::kBalanced,
                                       TemporalPreset::kQuality};

ResolveSettings preset(TemporalPreset one) {
  return {.method = Method::kTemporal, .temporal = {.preset = one}};
}

TemporalScene drifting(Texture texture) {
  TemporalScene scene;
  scene.surfaces = {{.velocity = {.37, .21}, .texture = std::move(texture)}};
  return scene;
}

bool is_odd(double cells) {
  return std::fmod(std::floor(cells) + 4096, 2) != 0;
}

Pixel black_or_white(bool is_white) {
  const float light = is_white ? .8f : .1f;
  return {light, light, light, 1};
}

// `size` output pixels wide.
Texture stripes(double size) {
  return [size](Place place) { return black_or_white(is_odd(place.real() / size)); };
}
Texture checks(double size) {
  return [size](Place place) {
    return black_or_white(is_odd(place.real() / size) != is_odd(place.imag() / size));
  };
}

double next_error(TemporalRun& run) {
  const std::vector<Pixel> shown = run.next();
  return testing::squared_error(shown, run.truth(), run.scene().output);
}

class FineTexture : public ::testing::TestWithParam<std::pair<const char*, Texture>> {};

// Finer than the samples, which lie two pixels apart. A history of one frame then foretells samples worse than their
// neighbours do. If that counted as a cut history would never grow. Stripes of 1.6 pixels once had .41 of bilinear's
// error for it, checks of 1.3 had .7. Noise times checks as wide as the samples are apart had 2.5, because of the
// samples that judge history all showed white fields, or all black ones.
TEST_P(FineTexture, IsNoCutAndNoChangeOfLight) {
  for (const TemporalPreset one : kPresets) {
    TemporalRun run(drifting(GetParam().second), preset(one));
    TemporalRun bilinear(run.scene(), {.method = Method::kBilinear});
    run.until(16), bilinear.until(16);
    double own = 0, single = 0;
    for (int i = 0; i < 8; ++i)
      own += next_error(run), single += next_error(bilinear);
    EXPECT_LT(own, .35 * single) << static_cast<int>(one);
  }
}

INSTANTIATE_TEST_SUITE_P(TemporalCut, FineTexture,
                         ::testing::Values(std::pair{"stripes", stripes(1.6)},
                                           std::pair{"checks", checks(1.3)},
                                           std::pair{"checks_like_the_samples", testing::noise_texture(2)}),
                         [](const auto& instance) { return instance.param.first; });

// The first frame after a cut is a little worse than a first frame of all, as it is smoothed where little is known;
// with history that nobody rejects its error is five times as large.
TEST(TemporalCut, AnotherPictureLeavesNothingOfTheOldOne) {
  for (const TemporalPreset one : kPresets) {
    TemporalRun run(drifting(testing::noise_texture(9)), preset(one));
    run.until(16);
    run.scene() = drifting(testing::noise_texture(7, 5));
    TemporalRun fresh(run.scene(), preset(one));
    while (fresh.frame() < run.frame())
      fresh.skip();
    EXPECT_LT(next_error(run), 1.5 * next_error(fresh)) << static_cast<int>(one);
  }
}

}  // namespace
}  // namespace quincunx
