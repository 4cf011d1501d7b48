// SPDX-License-Identifier: MIT
#include "history_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

constexpr double kHistoryCubic = -1;  // Keys' a
constexpr double kSameOffset = .02;   // output pixels that offsets of copied texels may differ by

// Whether the eight texels that a block of a rigid tile takes are all there, at one offset.
bool copies(const TemporalInputs& in, const Tile& tile, int x, int y) {
  const int first = x - tile.step[0];
  const int row = y - tile.step[1];
  if (!tile.rigid || first < 0 || row < 0 || first + 8 > in.output_width || row >= in.output_height)
    return false;
  for (const int column : {first, first + 7}) {
    const Tile& from = in.tile_before(column / kTile, row / kTile);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (std::abs(from.offset[axis].value - tile.source[axis]) > kSameOffset) return false;
    }
  }
  return true;
}

BoundedPixel sample_linear(const TemporalInputs& in, int x, int y, const Bounded& fx, const Bounded& fy) {
  const auto texel = [&](int column, int row) {
    return exact(in.history_at(std::clamp(x + column, 0, in.output_width - 1),
                               std::clamp(y + row, 0, in.output_height - 1)));
  };
  const BoundedPixel t00 = texel(0, 0), t10 = texel(1, 0), t01 = texel(0, 1), t11 = texel(1, 1);
  BoundedPixel result;
  for (std::size_t c = 0; c < 4; ++c) {
    const Bounded upper = t00[c] + (t10[c] - t00[c]) * fx;
    const Bounded lower = t01[c] + (t11[c] - t01[c]) * fx;
    result[c] = upper + (lower - upper) * fy;
  }
  return result;
}

}  // namespace

Taken take_history(const TemporalInputs& in, const Tile& tile, const Move& move, int x, int y,
                   const TemporalOptions& options, bool& undecided) {
  if (copies(in, tile, x / 8 * 8, y)) return {exact(in.history_at(x - tile.step[0], y - tile.step[1])), 0};
  const std::array<int, 2> texel = {x, y};
  const std::array<double, 2> moves = {move.x, move.y};
  std::array<Bounded, 2> at;
  std::array<int, 2> from;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Bounded by = Bounded(moves[axis]) * rounded(in.move_scale(static_cast<int>(axis)));
    at[axis] = clamp(by, -65536, 65536) + tile.offset[axis];
    const int last = axis == 0 ? in.output_width - 1 : in.output_height - 1;
    from[axis] = decide(
        at[axis] + .5,
        [&](double place) { return std::clamp(static_cast<int>(place) + texel[axis], 0, last) / kTile; },
        undecided);
  }
  const Tile& source = in.tile_before(from[0], from[1]);
  std::array<int, 2> step;
  std::array<Bounded, 2> fraction;
  Bounded between = 0;
  bool lost = false;  // beyond the edges
  for (std::size_t axis = 0; axis < 2; ++axis) {
    at[axis] = at[axis] - source.offset[axis];
    // The cubic is continuous, but from one texel to the next what it is held in is not.
    step[axis] = floor_of(at[axis], undecided);
    fraction[axis] = {at[axis].value - step[axis], at[axis].error};
    const Bounded place = Bounded(texel[axis] + step[axis]) + fraction[axis];
    const int size = axis == 0 ? in.output_width : in.output_height;
    lost = lost || less(place, -.5, undecided) || less(size - .5, place, undecided);
    between = between + fraction[axis] * (Bounded(1) - fraction[axis]);
  }
  const auto sample = [&] {
    if (options.taps == 4) return sample_linear(in, x + step[0], y + step[1], fraction[0], fraction[1]);
    return sample_cubic(in, x + step[0], y + step[1], fraction[0], fraction[1], kHistoryCubic);
  };
  Taken taken{sample(), min(Bounded(4) * between, 1)};
  if (lost) taken.value[3] = 0;
  return taken;
}

BoundedPixel sample_cubic(const TemporalInputs& in, int x, int y, const Bounded& fraction_x,
                          const Bounded& fraction_y, double a) {
  const auto weights = [a](const Bounded& f) {
    const Bounded rest = Bounded(1) - f;
    const Bounded w0 = Bounded(a) * f * rest * rest;
    const Bounded w1 = (Bounded(a + 2) * f - Bounded(a + 3)) * f * f + 1;
    const Bounded w3 = Bounded(a) * rest * f * f;
    return std::array<Bounded, 4>{w0, w1, Bounded(1) - w0 - w1 - w3, w3};
  };
  const auto wx = weights(fraction_x);
  const auto wy = weights(fraction_y);
  BoundedPixel result, least, most;
  for (std::size_t c = 0; c < 4; ++c) {
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        const Bounded texel = in.history_at(std::clamp(x + column - 1, 0, in.output_width - 1),
                                            std::clamp(y + row - 1, 0, in.output_height - 1))[c];
        const auto i = static_cast<std::size_t>(column);
        const auto j = static_cast<std::size_t>(row);
        result[c] = result[c] + texel * wx[i] * wy[j];
        if (row % 3 == 0 || column % 3 == 0) continue;
        const bool first = row == 1 && column == 1;
        least[c] = first ? texel : min(least[c], texel);
        most[c] = first ? texel : max(most[c], texel);
      }
    }
    result[c] = clamp(result[c], least[c], most[c]);
  }
  return result;
}

}  // namespace quincunx::reference
