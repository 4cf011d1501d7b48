// SPDX-License-Identifier: MIT
// temporal_refine: the specification. In tone space, t = c / (1 + max(red, green, blue, 0)), for each channel
//   t' = clamp(t + a (t - m) + K (b D_t + c D_n), l, h)
//   a, b, c   .05 + .35 / (W + .6), .03 + .5 / (W + .15), 0 of a pixel of one layer and confidence W;
//             0, .2, -.12 of one of two layers, whose confidence is negative
//   m, l, h   mean and range of the 3x3 pixels around
//   D_n, D_t  second derivatives across and along the edge; K its coherence, 0 to 1: both of the sums of luma's
//             gradients' products over the 3x3 pixels, (1 2 1) by (1 2 1) / 16
// and back, within +-65504. Alpha stays. NaN counts as 0, what is beyond +-65504 as that. Neighbours are clamped to the
// edge.
// Source: Bigun and Granlund, "Optimal Orientation Detection of Linear Symmetry", 1987.
//
// temporal_denoise, in tone space, too: t' is the mean of the 7x7 pixels around, each weighted
// w bell(d / (s n + 10^-7)), w = |W| + .03
//   v   noise (1 - max(t, 0))^2 |t|^2 / w
//   s   min(sum of |t - mean of four neighbours|^2 / (sum of v + 10^-12), .7), sums over the 5x5 pixels around
//   d   sum of |t_q - t_p|^2, n sum of v_p + v_q, over the 3x3 places around both pixels
// Where albedo is known, each channel is divided by max(albedo, 0) + .02 before all this (by more, if it came to more
// than 32768), and multiplied afterwards.
// Source: Buades, Coll and Morel, "A non-local algorithm for image denoising", 2005.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

constexpr double kFiniteHalfMax = 65504;
constexpr double kAlbedoFloor = .02;
constexpr double kOverAlbedoMax = 32768;
constexpr double kToneRestMin = 0x1p-16;  // least 1 - tone, against a division by 0 on the way back

// What stands for a value that is not finite.
inline double cleaned(double value) {
  return std::isnan(value) ? 0 : std::clamp(value, -kFiniteHalfMax, kFiniteHalfMax);
}

template <typename Real>
class TonePicture {
 public:
  // `albedo`: null, or of the picture's size: divides it.
  explicit TonePicture(const Picture& picture, const Picture* albedo = nullptr)
      : picture_(picture), albedo_(albedo) {}

  Real divisor(int x, int y, std::size_t channel) const {
    if (albedo_ == nullptr) return 1;
    const Real known = Real(std::max(cleaned(pixel_of(*albedo_, x, y)[channel]), 0.0)) + kAlbedoFloor;
    return max(known, Real(std::abs(cleaned(pixel_of(picture_, x, y)[channel]))) / kOverAlbedoMax);
  }

  // Clamped to the edge.
  PixelOf<Real> at(int x, int y) const {
    const Pixel& pixel = pixel_of(picture_, x, y);
    PixelOf<Real> colour = {};
    Real brightest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      colour[c] = cleaned(pixel[c]);
      if (albedo_ != nullptr) colour[c] = colour[c] / divisor(x, y, c);
      brightest = max(brightest, colour[c]);
    }
    const Real scale = 1 / (1 + brightest);
    return {colour[0] * scale, colour[1] * scale, colour[2] * scale, 0};
  }

  Real luma(int x, int y) const {
    const PixelOf<Real> tone = at(x, y);
    return .25 * (tone[0] + tone[2]) + .5 * tone[1];
  }

 private:
  static const Pixel& pixel_of(const Picture& picture, int x, int y) {
    const int column = std::clamp(x, 0, picture.width - 1), row = std::clamp(y, 0, picture.height - 1);
    return picture.pixels[index_of(picture.width, column, row)];
  }

  const Picture& picture_;
  const Picture* albedo_;
};

// The way back from tone space; alpha is that of the picture's pixel.
template <typename Real>
PixelOf<Real> light_of(const PixelOf<Real>& tone, const Picture& picture, int x, int y,
                       const PixelOf<Real>& factors = {1, 1, 1, 1}) {
  const Real scale = 1 / max(1 - max(max(max(tone[0], tone[1]), tone[2]), 0), kToneRestMin);
  PixelOf<Real> light = {};
  for (std::size_t c = 0; c < 3; ++c)
    light[c] = min(max(tone[c] * (scale * factors[c]), -kFiniteHalfMax), kFiniteHalfMax);
  light[3] = picture.pixels[index_of(picture.width, x, y)][3];
  return light;
}

// `confidences`: of each pixel, as history stores them.
template <typename Real>
PixelOf<Real> temporal_refine(const Picture& picture, const std::vector<double>& confidences, int x, int y);
template <typename Real>
PixelOf<Real> temporal_denoise(const Picture& picture, const Picture* albedo,
                               const std::vector<double>& confidences, double noise, int x, int y);

}  // namespace quincunx::reference
