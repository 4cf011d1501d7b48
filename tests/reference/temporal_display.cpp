// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>

#include "history_sampling.h"

namespace quincunx::reference {
namespace {

constexpr double kDisplayCubic = -.75;  // Keys' a
constexpr double kLittle = 1.5;         // confidence below which a pixel is smoothed

BoundedPixel smoothed(const TemporalInputs& in, int x, int y, const BoundedPixel& centre) {
  const double confidence = in.history_at(x, y)[3];
  const Bounded other = rounded(.3) * bell(2 * confidence);
  const Bounded own = Bounded(confidence) + rounded(.02);
  BoundedPixel sum;
  for (std::size_t c = 0; c < 3; ++c) {
    sum[c] = centre[c] * own;
    for (int i = 0; i < 9; ++i) {
      if (i == 4) continue;
      const Pixel& texel = in.history_at(std::clamp(x + i % 3 - 1, 0, in.output_width - 1),
                                         std::clamp(y + i / 3 - 1, 0, in.output_height - 1));
      sum[c] = sum[c] + other * texel[c];
    }
    sum[c] = sum[c] / (own + Bounded(8) * other);
  }
  return sum;
}

// Both fractions are rounded, and change it by twice the largest alpha; two steps between values of a
// difference, a product and a sum each.
Bounded alpha_at(const TemporalInputs& in, int x, int y) {
  const Sample sample = sample_bilinear(in.frame, x, y, in.output_width, in.output_height);
  return {sample.value[3], (4 + 2 * 6) * kUnit * sample.largest};
}

HistoryTexel display(const TemporalInputs& in, const Tile& tile, const DisplayOptions& options, int x,
                     int y) {
  const Pixel& own = in.history_at(x, y);
  HistoryTexel texel;
  texel.value = {own[0], own[1], own[2], 1};
  if (tile.offset[0].value != 0 || tile.offset[1].value != 0) {
    std::array<int, 2> first = {x, y};
    std::array<Bounded, 2> fraction;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int back = tile.offset[axis].value > 0 ? 1 : 0;
      first[axis] -= back;
      fraction[axis] = Bounded(back) - tile.offset[axis];
    }
    texel.value = sample_cubic(in, first[0], first[1], fraction[0], fraction[1], kDisplayCubic);
  }
  if (options.smooth && own[3] < kLittle) texel.value = smoothed(in, x, y, texel.value);
  texel.value[3] = options.alpha ? alpha_at(in, x, y) : Bounded(1);
  return texel;
}

}  // namespace

std::vector<HistoryTexel> temporal_display(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                           const DisplayOptions& options) {
  std::vector<HistoryTexel> shown;
  for (int y = 0; y < in.output_height; ++y) {
    for (int x = 0; x < in.output_width; ++x) {
      const Tile& tile = tiles[static_cast<std::size_t>(y / kTile * in.tiles_x() + x / kTile)];
      shown.push_back(display(in, tile, options, x, y));
    }
  }
  return shown;
}

}  // namespace quincunx::reference
