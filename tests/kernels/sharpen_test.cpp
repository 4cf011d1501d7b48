// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

// In units of u = 2^-24 and M, the largest of the five values; S is the sharpness. The mean is off by 2 (its
// quarters are exact), the difference from it, at most 2 M, by 4 in all; the two sums and the quotient (2.5
// last places in OpenCL) of the slope, which is at most 1, by 7, and two factors by 2 more, of a product of
// at most 2 S M; the last sum by 1 + 2 S. That makes 4 S + 18 S + 1 + 2 S, and a little for what errors do to
// each other.
double error_bound(double sharpness, double largest) {
  return (25 * sharpness + 2) * 0x1p-24 * largest + 16 * 0x1p-126;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Extent kSizes[] = {{1, 1}, {7, 5}, {64, 64}, {257, 129}};

std::size_t index_of(Extent extent, int x, int y) {
  return static_cast<std::size_t>(std::clamp(y, 0, extent.height - 1) * extent.width +
                                  std::clamp(x, 0, extent.width - 1));
}

class Sharpen : public ::testing::TestWithParam<PixelFormat> {
 protected:
  std::vector<unsigned char> run(const std::vector<Pixel>& pixels, Extent extent, float sharpness,
                                 double outside = 1e30, bool tight = false) {
    Rig rig;
    PassRig pass({}, {.sharpness = sharpness, .output = {.linear = GetParam()}}, "sharpen");
    const ImageView source = rig.image(GetParam(), Storage::kBuffer, extent, pixels, outside, tight);
    const ImageView view = rig.output(GetParam(), extent);
    pass.run({}, {}, extent, {}, {{Resource::kUnsharpened, source}, {Resource::kResolved, view}});
    return rig.bytes(view, extent);
  }

  std::vector<Pixel> sharpened(const std::vector<Pixel>& pixels, Extent extent, float sharpness) {
    return testing::decode(GetParam(), run(pixels, extent, sharpness));
  }

  reference::Picture stored(const std::vector<Pixel>& pixels, Extent extent) const {
    reference::Picture picture{extent.width, extent.height, pixels, {}, 0};
    for (Pixel& pixel : picture.pixels) {
      for (double& value : pixel)
        value = testing::stored_value(GetParam(), value);
    }
    return picture;
  }

  void compare(const std::vector<Pixel>& pixels, Extent extent, float sharpness, const std::string& what) {
    const reference::Picture expected =
        reference::sharpen(stored(pixels, extent), static_cast<double>(sharpness));
    testing::expect_close(
        expected, sharpened(pixels, extent, sharpness),
        [&](std::size_t i) {
          return error_bound(static_cast<double>(sharpness), expected.largest[i]) +
                 testing::output_rounding(GetParam(), expected.largest[i]);
        },
        what, GetParam());
  }
};

TEST_P(Sharpen, MatchesTheReferenceOnEveryPatternAndSize) {
  for (const Extent extent : kSizes) {
    for (const Pattern pattern : testing::all_patterns()) {
      for (const float sharpness : {.1f, .5f, 1.0f}) {
        compare(
            testing::pattern_pixels(pattern, extent, 5), extent, sharpness,
            fmt::format("{} {}x{} by {}", testing::name_of(pattern), extent.width, extent.height, sharpness));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(Sharpen, ConstantsAndAlphaKeepEveryBit) {
  for (const Extent extent : kSizes) {
    for (const double value : {0.0, .3, -2.0, 1e-7, 65504.0}) {
      const std::vector<Pixel> flat(static_cast<std::size_t>(extent.area()),
                                    Pixel{value, value, value / 3, .7});
      EXPECT_EQ(run(flat, extent, 1), testing::encode(GetParam(), flat)) << value;
    }
    const std::vector<Pixel> noise = testing::pattern_pixels(Pattern::kNoise, extent, 3);
    const reference::Picture before = stored(noise, extent);
    const std::vector<Pixel> after = sharpened(noise, extent, 1);
    for (std::size_t i = 0; i < after.size(); ++i)
      ASSERT_EQ(after[i][3], before.pixels[i][3]) << "alpha of pixel " << i;
  }
}

// Exactly, not within a tolerance: no halo, no dark ring, nothing below 0, nothing beyond the largest half.
TEST_P(Sharpen, NothingLeavesTheRangeOfItsNeighbours) {
  const Extent extent{130, 70};
  for (const Pattern pattern : {Pattern::kNoise, Pattern::kExtremes, Pattern::kImpulse, Pattern::kRamp}) {
    const std::vector<Pixel> pixels = testing::pattern_pixels(pattern, extent, 11);
    const reference::Picture before = stored(pixels, extent);
    const std::vector<Pixel> after = sharpened(pixels, extent, 1);
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          const auto range = std::minmax(
              {before.pixels[index_of(extent, x, y)][c], before.pixels[index_of(extent, x - 1, y)][c],
               before.pixels[index_of(extent, x + 1, y)][c], before.pixels[index_of(extent, x, y - 1)][c],
               before.pixels[index_of(extent, x, y + 1)][c]});
          const double value = after[index_of(extent, x, y)][c];
          ASSERT_GE(value, range.first) << testing::name_of(pattern) << " at " << x << ", " << y;
          ASSERT_LE(value, range.second) << testing::name_of(pattern) << " at " << x << ", " << y;
        }
      }
    }
  }
}

// By hand: an edge with one pixel between its sides. The pixel stays where it is half-way, moves by
// 1.25 / 2 * (.25 - .375) = -.078125 where it is nearer to the dark side, and as far as the range allows
// where light is far from even.
TEST_P(Sharpen, AnEdgeGetsSteeper) {
  const Extent extent{9, 3};
  const auto middle = [&](double between, double bright) {
    std::vector<Pixel> pixels;
    for (int i = 0; i < extent.width * extent.height; ++i) {
      const int x = i % extent.width;
      const double value = x < 4 ? 0 : x == 4 ? between : bright;
      pixels.push_back({value, value, value, 1});
    }
    return sharpened(pixels, extent, 1)[index_of(extent, 4, 1)][0];
  };
  EXPECT_EQ(middle(.5, 1), .5);
  EXPECT_NEAR(middle(.25, 1), .25 - .078125, 0x1p-12);
  EXPECT_EQ(middle(.25, 1000), 0);
  EXPECT_EQ(middle(999, 1000), 1000);
}

// A lamp among even pixels: it stays, and what is next to it does not go dark.
TEST_P(Sharpen, ALampLeavesNoRing) {
  const Extent extent{11, 9};
  std::vector<Pixel> pixels(static_cast<std::size_t>(extent.area()), Pixel{.25, .25, .25, 1});
  pixels[index_of(extent, 5, 4)] = {65504, 65504, 65504, 1};
  EXPECT_EQ(run(pixels, extent, 1), testing::encode(GetParam(), pixels));
}

TEST_P(Sharpen, ANonFinitePixelCountsAsItsStandInAndReachesItsNeighboursOnly) {
  const Extent extent{22, 5};
  std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 9);
  const std::vector<Pixel> without = sharpened(pixels, extent, 1);
  for (const auto& [bad, stand_in] : {std::pair{kNan, 0.0}, {kInfinity, 65504.0}, {-kInfinity, -65504.0}}) {
    const std::size_t place = index_of(extent, 12, 2);
    std::vector<Pixel> stood = pixels;
    std::vector<Pixel> spoilt = pixels;
    stood[place] = {stand_in, stand_in, stand_in, stand_in};
    spoilt[place] = {bad, bad, bad, bad};
    const std::vector<Pixel> with = sharpened(spoilt, extent, 1);
    EXPECT_EQ(with, sharpened(stood, extent, 1)) << bad;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        if (std::abs(x - 12) + std::abs(y - 2) <= 1) continue;
        ASSERT_EQ(with[index_of(extent, x, y)], without[index_of(extent, x, y)]) << x << ", " << y;
      }
    }
  }
}

TEST_P(Sharpen, PoisonOutsideThePictureChangesNoBit) {
  for (const Extent extent : {Extent{1, 1}, {5, 3}, {33, 21}}) {
    const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 2);
    const std::vector<unsigned char> clean = run(pixels, extent, .5f, 0);
    for (const double poison : testing::kPoisons)
      EXPECT_EQ(clean, run(pixels, extent, .5f, poison)) << poison;
  }
}

// Under a memory checker this also shows that nothing beyond the picture is read.
TEST_P(Sharpen, ATightImageGivesTheSameBits) {
  for (const Extent extent : {Extent{1, 1}, {1, 6}, {4, 2}, {5, 1}, {8, 3}, {13, 5}}) {
    const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kNoise, extent, 2);
    EXPECT_EQ(run(pixels, extent, 1, 0), run(pixels, extent, 1, 0, true)) << extent.width;
  }
}

TEST_P(Sharpen, TwoRunsAgreeBitForBit) {
  const std::vector<Pixel> pixels = testing::pattern_pixels(Pattern::kExtremes, {100, 70}, 4);
  EXPECT_EQ(run(pixels, {100, 70}, .7f), run(pixels, {100, 70}, .7f));
}

const std::vector<PixelFormat> kFormats = {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F};
INSTANTIATE_TEST_SUITE_P(Variants, Sharpen, ::testing::ValuesIn(kFormats),
                         testing::sample_names(kFormats,
                                               [](PixelFormat f) { return std::string(name_of(f)); }));

}  // namespace
}  // namespace quincunx
