// SPDX-License-Identifier: MIT
#include "tools/image/image_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace quincunx::tools {
namespace {

// Single precision through 21 taps, two cube roots and three powers, each exact to some 2^-23, but the power
// q_f = 1/2 makes of a feature difference of 1e-7 one of 3e-4.
constexpr double kRounding = 5e-4;
constexpr double kMeanRounding = 2e-5;

constexpr Extent kExtent{96, 64};

struct Pair {
  std::vector<float> truth, picture;
};

// Gradients, a disc that moved by two pixels, stripes and noise; all in [0, 1].
Pair drawn() {
  Pair pair;
  for (int y = 0; y < kExtent.height; ++y) {
    for (int x = 0; x < kExtent.width; ++x) {
      const double across = x / (kExtent.width - 1.0), down = y / (kExtent.height - 1.0);
      const auto disc = [&](double shift) {
        const double dx = x - kExtent.width * 0.4 - shift, dy = y - kExtent.height * 0.5;
        return dx * dx + dy * dy < kExtent.height * 0.3 * kExtent.height * 0.3;
      };
      const double stripes = (x / 3 + y / 5) % 2;
      const double noise = (x * 73 + y * 151 + x * y * 7) % 97 / 96.0;
      for (const double value : {across, down, disc(0) ? 0.9 : 0.2})
        pair.truth.push_back(static_cast<float>(value));
      for (const double value :
           {across * 0.8 + 0.1 * stripes, down * 0.9 + 0.1 * noise, disc(2) ? 0.8 : 0.25})
        pair.picture.push_back(static_cast<float>(value));
    }
  }
  return pair;
}

std::vector<float> plain(std::array<float, 3> colour) {
  std::vector<float> values;
  for (int i = 0; i < kExtent.area(); ++i)
    values.insert(values.end(), colour.begin(), colour.end());
  return values;
}

double difference(std::array<float, 3> a, std::array<float, 3> b) {
  return flip_mean(flip_map(kExtent, plain(a), plain(b)));
}

// Figures of the code that its authors published (NVlabs/flip, python/flip_api.py of 2021), transcribed to
// plain sums in double precision and run on the pictures above.
TEST(Flip, AgreesWithItsAuthors) {
  struct Figures {
    double pixels_per_degree, mean;
    std::array<double, 5> values;  // at kPixels
  };
  constexpr std::array<std::array<std::size_t, 2>, 5> kPixels = {
      {{0, 0}, {40, 31}, {57, 32}, {95, 63}, {20, 50}}};
  const Figures published[] = {
      {kFlipPixelsPerDegree,
       0.3396771063,
       {0.1655357275, 0.3137274090, 0.2023307280, 0.4588604399, 0.3465152320}},
      {30, 0.3619331730, {0.1238240492, 0.3410013022, 0.2807342252, 0.4791840591, 0.4184765570}},
  };
  const Pair pair = drawn();
  for (const Figures& expected : published) {
    const std::vector<float> map = flip_map(kExtent, pair.picture, pair.truth, expected.pixels_per_degree);
    EXPECT_NEAR(flip_mean(map), expected.mean, kMeanRounding);
    for (std::size_t i = 0; i < kPixels.size(); ++i) {
      const auto [x, y] = kPixels[i];
      EXPECT_NEAR(double{map[y * kExtent.width + x]}, expected.values[i], kRounding)
          << x << ", " << y << " at " << expected.pixels_per_degree << " pixels per degree";
    }
  }
  EXPECT_NEAR(difference({0, 0, 0}, {1, 1, 1}), 0.9673797634, kMeanRounding);
  EXPECT_NEAR(difference({1, 0, 0}, {0, 0, 0}), 0.9704973358, kMeanRounding);
}

TEST(Flip, HasTheLargestDifferenceBetweenGreenAndBlue) {
  EXPECT_NEAR(difference({0, 1, 0}, {0, 0, 1}), 1, kMeanRounding);
}

TEST(Flip, IsZeroForEqualPicturesAndSymmetric) {
  const Pair pair = drawn();
  for (const float value : flip_map(kExtent, pair.truth, pair.truth))
    ASSERT_EQ(value, 0);
  const std::vector<float> forth = flip_map(kExtent, pair.picture, pair.truth);
  EXPECT_EQ(forth, flip_map(kExtent, pair.truth, pair.picture));
  EXPECT_GE(*std::min_element(forth.begin(), forth.end()), 0);
  EXPECT_LE(*std::max_element(forth.begin(), forth.end()), 1);
}

}  // namespace
}  // namespace quincunx::tools
