// SPDX-License-Identifier: MIT
// temporal_refine and temporal_denoise against their references. The bounds follow from running error analysis beside
// them.
#include "../reference/temporal_refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "expected.h"
#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t index_of(Extent extent, int x, int y) {
  return static_cast<std::size_t>(std::clamp(y, 0, extent.height - 1) * extent.width +
                                  std::clamp(x, 0, extent.width - 1));
}

struct Case {
  PixelFormat picture, history;
  float noise = 0;  // 0: temporal_refine
};

class TemporalPicture : public ::testing::TestWithParam<Case> {
 protected:
  static PixelFormat format() { return GetParam().picture; }
  static bool denoises() { return GetParam().noise > 0; }

  // Refines with `confidences` for the pixels, or if there are none with every kind, side by side; history's colours
  // are NaN.
  std::vector<unsigned char> run(const std::vector<Pixel>& pixels, Extent extent,
                                 const std::vector<double>& confidences = {}, double outside = 1e30,
                                 bool tight = false) {
    Rig rig;
    const ResolveSettings settings = {
        .method = Method::kTemporal,
        .output = {.linear = format()},
        .temporal = {.preset = denoises() ? TemporalPreset::kBalanced : TemporalPreset::kQuality,
                     .history = GetParam().history,
                     .noise = GetParam().noise}};
    PassRig pass({}, settings, denoises() ? "temporal_denoise" : "temporal_refine");
    std::vector<Pixel> known;
    for (const double confidence : confidences.empty() ? every_kind(extent) : confidences)
      known.push_back({kNan, kNan, kNan, confidence});
    const std::vector<unsigned char> bytes = testing::encode(GetParam().history, known);
    cl::Buffer history(testing::impl().context, CL_MEM_READ_WRITE, bytes.size());
    testing::impl().queue.enqueueWriteBuffer(history, CL_TRUE, 0, bytes.size(), bytes.data());
    const ImageView source = rig.image(format(), Storage::kBuffer, extent, pixels, outside, tight);
    if (!albedo_.empty())
      pass.set_albedo(rig.image(format(), Storage::kBuffer, extent, albedo_, outside, tight));
    const ImageView view = rig.output(format(), extent);
    pass.run({}, {}, extent, {},
             {{denoises() ? Resource::kNoisy : Resource::kUnrefined, source},
              {Resource::kHistory, {.memory = history()}},
              {Resource::kResolved, view}});
    return rig.bytes(view, extent);
  }

  std::vector<Pixel> refined(const std::vector<Pixel>& pixels, Extent extent,
                             const std::vector<double>& confidences = {}) {
    return testing::decode(format(), run(pixels, extent, confidences));
  }

  static reference::Picture stored(const std::vector<Pixel>& pixels, Extent extent) {
    reference::Picture picture{extent.width, extent.height, pixels, {}, 0};
    for (Pixel& pixel : picture.pixels) {
      for (double& value : pixel)
        value = testing::stored_value(format(), value);
    }
    return picture;
  }

  // Confidences as history stores them: of one layer and, negative, of two.
  static std::vector<double> every_kind(Extent extent) {
    constexpr std::array kKinds = {0.0, .15, -.4, .7, 1.5, -0.0, 8.0, -32.0, 32.0, .3, -2.0};
    std::vector<double> confidences;
    for (int i = 0; i < extent.area(); ++i)
      confidences.push_back(
          testing::stored_value(GetParam().history, kKinds.at(static_cast<std::size_t>(i) % kKinds.size())));
    return confidences;
  }

  void compare(const std::vector<Pixel>& pixels, Extent extent, const std::string& what) {
    const reference::Picture picture = stored(pixels, extent), albedo = stored(albedo_, extent);
    const std::vector<double> confidences = every_kind(extent);
    const auto expected =
        testing::expected_pixels(extent.width, extent.height, [&]<typename Real>(Real, int x, int y) {
          if (denoises())
            return reference::temporal_denoise<Real>(picture, albedo_.empty() ? nullptr : &albedo,
                                                     confidences, GetParam().noise, x, y);
          return reference::temporal_refine<Real>(picture, confidences, x, y);
        });
    const std::vector<Pixel> actual = refined(pixels, extent);
    for (std::size_t i = 0; i < actual.size(); ++i) {
      ASSERT_FALSE(expected[i].undecided);
      for (std::size_t c = 0; c < 4; ++c) {
        testing::expect_near(expected[i].value[c], expected[i].bound[c], actual[i][c],
                             fmt::format("{}: value {} of pixel {}", what, c, i), format());
        if (HasFatalFailure()) return;
      }
    }
  }

  std::vector<Pixel> albedo_;  // empty: it is not known
};

class TemporalRefine : public TemporalPicture {};
class TemporalDenoise : public TemporalPicture {};

TEST_P(TemporalPicture, MatchesTheReferenceOnEveryPatternAndSize) {
  const Extent largest = denoises() ? Extent{21, 9} : Extent{67, 41};  // the reference takes a while
  for (const Extent extent : {Extent{1, 1}, {7, 5}, {8, 8}, {9, 17}, largest}) {
    for (const Pattern pattern : testing::all_patterns()) {
      const std::string what =
          fmt::format("{} {}x{}", testing::name_of(pattern), extent.width, extent.height);
      std::vector<Pixel> pixels = testing::pattern_pixels(pattern, extent, 5);
      // The alpha of what is not finite is not this pass's to clean.
      for (Pixel& pixel : pixels)
        pixel[3] = std::isfinite(pixel[3]) ? pixel[3] : 1;
      compare(pixels, extent, what);
      if (HasFatalFailure()) return;
      if (!denoises()) continue;
      albedo_ = testing::pattern_pixels(Pattern::kNoise, extent, 9);
      albedo_.front() = {-1, 0, kNan, 0};
      compare(pixels, extent, what + ", albedo");
      if (HasFatalFailure()) return;
      albedo_.clear();
    }
  }
}

TEST_P(TemporalPicture, ConstantsAndAlphaKeepEveryBit) {
  for (const Extent extent : {Extent{1, 1}, {7, 5}, {65, 33}}) {
    for (const double value : {0.0, .3, -2.0, 1e-7, 65504.0}) {
      const std::vector<Pixel> flat(static_cast<std::size_t>(extent.area()),
                                    Pixel{value, value, value / 3, .7});
      EXPECT_EQ(run(flat, extent), testing::encode(format(), flat)) << value;
    }
    const std::vector<Pixel> noise = testing::pattern_pixels(Pattern::kNoise, extent, 3);
    const reference::Picture before = stored(noise, extent);
    const std::vector<Pixel> after = refined(noise, extent);
    for (std::size_t i = 0; i < after.size(); ++i)
      ASSERT_EQ(after[i][3], before.pixels[i][3]) << "alpha of pixel " << i;
  }
}

std::vector<Pixel> picture_of(Extent extent, const std::function<double(int, int)>& light) {
  std::vector<Pixel> pixels;
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      const double value = light(x, y);
      pixels.push_back({value, value, value, 1});
    }
  }
  return pixels;
}

// Returns how far the pixels of a slanted line are from their mean: the stairs that are left.
double stairs(const std::vector<Pixel>& pixels, Extent extent) {
  double sum = 0;
  for (int y = 6; y < 16; y += 2)
    sum += std::abs(pixels[index_of(extent, y + 2, y)][0] - pixels[index_of(extent, y + 3, y + 1)][0]);
  return sum;
}

// Stairs of a slanted edge, half a pixel high and wide, get flatter: the flatter, the less is known.
TEST_P(TemporalRefine, SlantedEdgesAreSmoothedTheMoreTheLessIsKnown) {
  const Extent extent{24, 24};
  const auto all = [&](double confidence) {
    return std::vector<double>(static_cast<std::size_t>(extent.area()), confidence);
  };
  const auto jagged = picture_of(extent, [](int x, int y) { return x - y / 2 * 2 > 2 ? .8 : .1; });
  const double before = stairs(jagged, extent);
  const double little = stairs(refined(jagged, extent, all(.5)), extent);
  const double more = stairs(refined(jagged, extent, all(2)), extent);
  EXPECT_LT(little, .7 * before);
  EXPECT_LT(little, .9 * more);
  EXPECT_LT(more, before);
  EXPECT_LT(stairs(refined(jagged, extent, all(-8)), extent), .9 * before);
}

// A level edge that is blurred gets steeper; of pixels of two layers, too, across the edge.
TEST_P(TemporalRefine, BlurredEdgesAreSharpened) {
  const Extent extent{24, 24};
  const auto blurred =
      picture_of(extent, [](int x, int) { return .1 + .7 * std::clamp((x - 9) / 6.0, 0.0, 1.0); });
  for (const double confidence : {2.0, -2.0}) {
    const std::vector<Pixel> sharp =
        refined(blurred, extent, std::vector<double>(static_cast<std::size_t>(extent.area()), confidence));
    EXPECT_LT(sharp[index_of(extent, 9, 12)][0], blurred[index_of(extent, 9, 12)][0] + 1e-3) << confidence;
    EXPECT_GT(sharp[index_of(extent, 14, 12)][0], blurred[index_of(extent, 14, 12)][0]) << confidence;
  }
}

TEST_P(TemporalPicture, ANonFinitePixelCountsAsItsStandInAndReachesAFewPixelsFar) {
  const Extent extent{22, 9};
  const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 9);
  const std::vector<Pixel> without = refined(pixels, extent);
  for (const auto& [bad, stand_in] : {std::pair{kNan, 0.0}, {kInfinity, 65504.0}, {-kInfinity, -65504.0}}) {
    const std::size_t place = index_of(extent, 12, 4);
    std::vector<Pixel> stood = pixels;
    std::vector<Pixel> spoilt = pixels;
    stood[place] = {stand_in, stand_in, stand_in, 1};
    spoilt[place] = {bad, bad, bad, 1};
    const std::vector<Pixel> with = refined(spoilt, extent);
    EXPECT_EQ(with, refined(stood, extent)) << bad;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        if (std::max(std::abs(x - 12), std::abs(y - 4)) <= (denoises() ? 4 : 2)) continue;
        ASSERT_EQ(with[index_of(extent, x, y)], without[index_of(extent, x, y)]) << x << ", " << y;
      }
    }
  }
}

TEST_P(TemporalPicture, PoisonOutsideThePictureChangesNoBit) {
  for (const Extent extent : {Extent{1, 1}, {5, 3}, {33, 21}}) {
    const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 2);
    const std::vector<unsigned char> clean = run(pixels, extent, {}, 0);
    for (const double poison : testing::kPoisons)
      EXPECT_EQ(clean, run(pixels, extent, {}, poison)) << poison;
  }
}

// Under a memory checker this also shows that nothing beyond the picture is read.
TEST_P(TemporalPicture, ATightImageGivesTheSameBits) {
  for (const Extent extent : {Extent{1, 1}, {1, 6}, {4, 2}, {5, 1}, {8, 3}, {13, 11}}) {
    const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 2);
    EXPECT_EQ(run(pixels, extent, {}, 0), run(pixels, extent, {}, 0, true)) << extent.width;
  }
}

TEST_P(TemporalPicture, TwoRunsAgreeBitForBit) {
  const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kExtremes, {100, 70}, 4);
  EXPECT_EQ(run(pixels, {100, 70}), run(pixels, {100, 70}));
}

// Grey light of .5 with noise of the variance that is told, from pixel `edge` on another light.
std::vector<Pixel> noisy_picture(Extent extent, double confidence, double noise, int edge, double light) {
  const std::vector<Pixel> chance = testing::pattern_pixels(Pattern::kNoise, extent, 7);
  const auto pixels = static_cast<double>(chance.size());
  double mean = 0, square = 0;
  for (const Pixel& pixel : chance) {
    mean += pixel[0] / pixels;
    square += pixel[0] * pixel[0] / pixels;
  }
  const double scale = std::sqrt(noise / confidence / (square - mean * mean));
  return picture_of(extent, [&](int x, int y) {
    return (x < edge ? .5 : light) * (1 + scale * (chance[index_of(extent, x, y)][0] - mean));
  });
}

// Returns the mean squared difference of the columns from `first` to before `end` from `light`.
double error_of(const std::vector<Pixel>& pixels, Extent extent, int first, int end, double light) {
  double sum = 0;
  for (int y = 0; y < extent.height; ++y) {
    for (int x = first; x < end; ++x)
      sum += std::pow(pixels[index_of(extent, x, y)][0] - light, 2) / ((end - first) * extent.height);
  }
  return sum;
}

TEST_P(TemporalDenoise, NoiseFadesBesideAnEdgeThatStays) {
  const Extent extent{48, 32};
  const double confidence = 4, edge_light = 3;
  const auto noisy = noisy_picture(extent, confidence, GetParam().noise, 24, edge_light);
  const std::vector<double> known(static_cast<std::size_t>(extent.area()), confidence);
  const auto shown = refined(noisy, extent, known);
  EXPECT_LT(error_of(shown, extent, 0, 24, .5), .25 * error_of(noisy, extent, 0, 24, .5));
  EXPECT_LT(error_of(shown, extent, 24, 48, edge_light), .25 * error_of(noisy, extent, 24, 48, edge_light));
}

// Texture that is stronger than the noise that is told, and smooth light.
TEST_P(TemporalDenoise, WhatNoiseDoesNotExplainStays) {
  const Extent extent{24, 24};
  const std::vector<double> known(static_cast<std::size_t>(extent.area()), 32);
  const auto board = picture_of(extent, [](int x, int y) { return (x / 3 + y / 3) % 2 == 0 ? .2 : .9; });
  const auto ramp = picture_of(extent, [](int x, int y) { return .2 + .02 * x + .01 * y; });
  for (const auto& [picture, most] : {std::pair{board, 1e-3}, {ramp, 4e-3}}) {
    const auto shown = refined(picture, extent, known);
    for (std::size_t i = 0; i < shown.size(); ++i)
      ASSERT_NEAR(shown[i][0], picture[i][0], most) << i;
  }
}

// A board of black and white that noise hides, under even light.
TEST_P(TemporalDenoise, NoiseFadesFromSurfacesWhoseAlbedoIsKnown) {
  const Extent extent{48, 32};
  const double confidence = 4;
  const std::vector<double> known(static_cast<std::size_t>(extent.area()), confidence);
  auto noisy = noisy_picture(extent, confidence, GetParam().noise, 48, .5);
  const auto board = picture_of(extent, [](int x, int y) { return (x + y) % 2 == 0 ? .3 : .9; });
  for (std::size_t i = 0; i < noisy.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      noisy[i][c] *= board[i][0] + .02;
  const auto error = [&](const std::vector<Pixel>& pixels) {
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      sum += std::pow(pixels[i][0] - .5 * (board[i][0] + .02), 2);
    return sum;
  };
  const double without = error(refined(noisy, extent, known));
  albedo_ = board;
  const double with = error(refined(noisy, extent, known));
  EXPECT_LT(with, .25 * error(noisy));
  EXPECT_LT(with, .5 * without);
}

std::vector<Case> all_formats(float noise) {
  std::vector<Case> all;
  for (const PixelFormat picture : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    for (const PixelFormat history : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F})
      all.push_back({picture, history, noise});
  }
  return all;
}

std::string name(const Case& c) {
  return fmt::format("{}{}_of_{}", c.noise > 0 ? "denoised_" : "", name_of(c.picture), name_of(c.history));
}

INSTANTIATE_TEST_SUITE_P(Refined, TemporalPicture, ::testing::ValuesIn(all_formats(0)),
                         testing::sample_names(all_formats(0), name));
INSTANTIATE_TEST_SUITE_P(Denoised, TemporalPicture, ::testing::ValuesIn(all_formats(.25F)),
                         testing::sample_names(all_formats(.25F), name));
INSTANTIATE_TEST_SUITE_P(Variants, TemporalRefine, ::testing::ValuesIn(all_formats(0)),
                         testing::sample_names(all_formats(0), name));
INSTANTIATE_TEST_SUITE_P(Variants, TemporalDenoise, ::testing::ValuesIn(all_formats(.25F)),
                         testing::sample_names(all_formats(.25F), name));

}  // namespace
}  // namespace quincunx
