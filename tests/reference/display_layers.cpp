// SPDX-License-Identifier: MIT
// display_layers: one output pixel after the near layer has been laid over the picture of the far one. p: the pixel's
// centre, R: the phase of its tile's near layer, D: the mean depth between the layers of its tile, M: the picture, W:
// the confidence of the far layer.
//   F, C  the near layer with its alpha, both times coverage, and its coverage at p - R: the cubic of Keys, a = -.75. A
//         texel of one layer counts as its colour and 1 if it is nearer than D, else as 0
//   where W < .15 and C > .02: M <- M + (F / C - M) (1 - W / .15)
//   F + (1 - C) M, C in [0, 1]; pixels of one layer stay what they are
// Source: found by measuring (docs/lab/layers.md).
#include <cmath>
#include <cstddef>

#include "resolve_layers.h"
#include "temporal/reseed.h"

namespace quincunx::reference {
namespace {

constexpr double kDisplaySharpness = -.75;  // Keys' a, as of temporal_display

template <typename Real>
LayerTap<Real> near_at_centre(const LayerHistory& history, const LayerTile& tile, int x, int y) {
  const auto near = [&](int i, int j) { return near_texel<Real>(history, Real(tile.between), i, j); };
  if (tile.phase[0] == 0 && tile.phase[1] == 0) return near(x, y);
  std::array<int, 2> texel = {x, y};
  std::array<Real, 2> fraction;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int back = tile.phase[axis] > 0 ? 1 : 0;
    texel[axis] -= back;
    fraction[axis] = back - Real(tile.phase[axis]);
  }
  const auto blended = blend_taps(history, texel, fraction, kDisplaySharpness, near);
  return {blended.value, 0, blended.alpha};
}

}  // namespace

template <typename Real>
PixelOf<Real> display_layers(const LayerHistory& history, const Pixel& picture, int x, int y) {
  PixelOf<Real> far = as<Real>(picture);
  const LayerTile& tile = history.layers[history.tile(x, y)];
  if (!tile.is_split || !history.has_two(x, y)) return far;
  const auto near = near_at_centre<Real>(history, tile, x, y);
  const PixelOf<Real> laid = {near.value[0], near.value[1], near.value[2], near.alpha};
  const Real coverage = clamp(near.value[3], 0, 1);
  const Real confidence = std::abs(history.far[history.texel(x, y)][3]);
  const Real unknown = clamp(1 - confidence / kConfidenceMin, 0, 1);
  if (seamless(unknown > 0) && coverage > kShownCoverageMin) {
    for (std::size_t c = 0; c < 4; ++c)
      far[c] += (laid[c] / near.value[3] - far[c]) * unknown;
  }
  PixelOf<Real> shown;
  for (std::size_t c = 0; c < 4; ++c)
    shown[c] = laid[c] + (1 - coverage) * far[c];
  return shown;
}

template PixelOf<double> display_layers(const LayerHistory&, const Pixel&, int, int);
template PixelOf<Bounded> display_layers(const LayerHistory&, const Pixel&, int, int);

}  // namespace quincunx::reference
