// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"
#include "temporal_refine.h"

namespace quincunx::reference {
namespace {

constexpr int kReach = 3;                 // pixels
constexpr double kConfidenceFloor = .03;  // weights
constexpr double kPartMax = .7;           // of the variance that the noise gives
constexpr double kVarianceMin = 1e-12;    // squared tone, against a division by 0
constexpr double kDistanceMin = 1e-7;     // squared tone

template <typename Real>
Real square(const Real& value) {
  return value * value;
}

template <typename Real>
struct NoisyPicture {
  TonePicture<Real> tone;
  const Picture& picture;
  const std::vector<double>& confidences;
  double noise;

  // Clamped to the edge, as tone is.
  Real weight(int x, int y) const {
    const int column = std::clamp(x, 0, picture.width - 1), row = std::clamp(y, 0, picture.height - 1);
    return Real(std::abs(confidences[index_of(picture.width, column, row)])) + kConfidenceFloor;
  }

  Real variance(int x, int y) const {
    const PixelOf<Real> t = tone.at(x, y);
    const Real rest = 1 - max(max(max(t[0], t[1]), t[2]), 0);
    return noise * square(rest) * (square(t[0]) + square(t[1]) + square(t[2])) / weight(x, y);
  }

  // The part of the variance that the picture shows around a pixel.
  Real shown_part(int x, int y) const {
    Real rough = 0, sum = 0;
    for (int j = y - 2; j <= y + 2; ++j) {
      for (int i = x - 2; i <= x + 2; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          const Real around =
              tone.at(i - 1, j)[c] + tone.at(i + 1, j)[c] + tone.at(i, j - 1)[c] + tone.at(i, j + 1)[c];
          rough += square<Real>(tone.at(i, j)[c] - .25 * around);
        }
        sum += variance(i, j);
      }
    }
    return min(rough / (sum + kVarianceMin), kPartMax);
  }
};

}  // namespace

template <typename Real>
PixelOf<Real> temporal_denoise(const Picture& picture, const Picture* albedo,
                               const std::vector<double>& confidences, double noise, int x, int y) {
  const NoisyPicture<Real> noisy{TonePicture<Real>(picture, albedo), picture, confidences, noise};
  const Real part = noisy.shown_part(x, y);
  const PixelOf<Real> own = noisy.tone.at(x, y);
  PixelOf<Real> sum = {};
  Real weights = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      Real distance = 0, variance = 0;
      for (int j = y - 1; j <= y + 1; ++j) {
        for (int i = x - 1; i <= x + 1; ++i) {
          const PixelOf<Real> here = noisy.tone.at(i, j), there = noisy.tone.at(i + dx, j + dy);
          for (std::size_t c = 0; c < 3; ++c)
            distance += square<Real>(there[c] - here[c]);
          variance += noisy.variance(i, j) + noisy.variance(i + dx, j + dy);
        }
      }
      const Real apart = distance / (part * variance + kDistanceMin);
      const Real weight = bell(apart) * noisy.weight(x + dx, y + dy);
      const PixelOf<Real> other = noisy.tone.at(x + dx, y + dy);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += weight * (other[c] - own[c]);
      weights += weight;
    }
  }
  PixelOf<Real> denoised = {}, factors = {};
  for (std::size_t c = 0; c < 3; ++c) {
    denoised[c] = own[c] + sum[c] / weights;
    factors[c] = noisy.tone.divisor(x, y, c);
  }
  return light_of(denoised, picture, x, y, factors);
}

template PixelOf<double> temporal_denoise(const Picture&, const Picture*, const std::vector<double>&, double,
                                          int, int);
template PixelOf<Bounded> temporal_denoise(const Picture&, const Picture*, const std::vector<double>&, double,
                                           int, int);

}  // namespace quincunx::reference
