// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

// In units of u = 2^-24 of the larger value M: the difference, at most 2 M, is off by 2, its product by 2 more, the
// sum, at most M, by 1; and a little for what errors do to each other.
constexpr double kError = 7 * 0x1p-24;

class CrossFade : public ::testing::TestWithParam<PixelFormat> {
 protected:
  std::vector<unsigned char> run(const std::vector<Pixel>& pixels, const std::vector<Pixel>& other,
                                 Extent extent, float weight, double outside = 1e30, bool tight = false) {
    Rig rig;
    PassRig pass({}, {.output = {.linear = GetParam()}, .control = {.fades = true}}, "cross_fade");
    const ImageView from = rig.image(GetParam(), Storage::kBuffer, extent, other, outside, tight);
    const ImageView view = rig.image(GetParam(), Storage::kBuffer, extent, pixels, outside, tight);
    FrameInputs inputs;
    inputs.fade_weight = weight;
    pass.run(inputs, {}, extent, {}, {{Resource::kFadingFrom, from}, {Resource::kResolved, view}});
    return rig.bytes(view, extent);
  }

  reference::Picture stored(const std::vector<Pixel>& pixels, Extent extent) const {
    reference::Picture picture{extent.width, extent.height, pixels, {}, 0};
    for (Pixel& pixel : picture.pixels) {
      for (double& value : pixel)
        value = testing::stored_value(GetParam(), value);
    }
    return picture;
  }
};

TEST_P(CrossFade, MatchesTheReferenceOnEveryPatternAndSize) {
  for (const Extent extent : {Extent{1, 1}, {7, 5}, {64, 64}, {257, 129}}) {
    const std::vector<Pixel> other = testing::pattern_pixels(Pattern::kNoise, extent, 8);
    for (const Pattern pattern : testing::all_patterns()) {
      for (const float weight : {.125f, 1.f / 3, .875f}) {
        const std::vector<Pixel> pixels = testing::pattern_pixels(pattern, extent, 5);
        const reference::Picture expected =
            reference::cross_fade(stored(pixels, extent), stored(other, extent), static_cast<double>(weight));
        testing::expect_close(
            expected, testing::decode(GetParam(), run(pixels, other, extent, weight)),
            [&](std::size_t i) {
              return kError * expected.largest[i] + testing::output_rounding(GetParam(), expected.largest[i]);
            },
            fmt::format("{} {}x{} by {}", testing::name_of(pattern), extent.width, extent.height, weight),
            GetParam());
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(CrossFade, WeightsZeroAndEqualPicturesKeepEveryBit) {
  const Extent extent{33, 21};
  const std::vector<Pixel> a = testing::pattern_pixels(Pattern::kNoise, extent, 3);
  const std::vector<Pixel> b = testing::pattern_pixels(Pattern::kNoise, extent, 4);
  EXPECT_EQ(run(a, b, extent, 0), testing::encode(GetParam(), b));
  EXPECT_EQ(run(a, a, extent, .3f), testing::encode(GetParam(), a));
}

TEST_P(CrossFade, PoisonOutsideThePictureAndTightImagesChangeNoBit) {
  for (const Extent extent : {Extent{1, 1}, {5, 3}, {33, 21}}) {
    const std::vector<Pixel> a = testing::pattern_pixels(Pattern::kNoise, extent, 2);
    const std::vector<Pixel> b = testing::pattern_pixels(Pattern::kNoise, extent, 6);
    const std::vector<unsigned char> clean = run(a, b, extent, .5f, 0);
    for (const double poison : testing::kPoisons)
      EXPECT_EQ(clean, run(a, b, extent, .5f, poison)) << poison;
    EXPECT_EQ(clean, run(a, b, extent, .5f, 0, true));
  }
}

const std::vector<PixelFormat> kFormats = {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F};
INSTANTIATE_TEST_SUITE_P(Variants, CrossFade, ::testing::ValuesIn(kFormats),
                         testing::sample_names(kFormats,
                                               [](PixelFormat f) { return std::string(name_of(f)); }));

}  // namespace
}  // namespace quincunx
