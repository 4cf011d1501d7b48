// SPDX-License-Identifier: MIT
#include "history_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

// Output pixels by which the phases of copied texels may differ from the phase that their tile assumes.
constexpr double kCopiedPhaseErrorMax = .02;
// Output pixels: beyond any viewport, and small enough for an int.
constexpr double kSourceDistanceMax = 65536;

// The tile that holds texel (x, y), clamped to the edge.
const TileReprojection& reprojection_before(const TemporalInputs& in, int x, int y) {
  const int tile_x = std::clamp(x, 0, in.output_width - 1) / kTile;
  const int tile_y = std::clamp(y, 0, in.output_height - 1) / kTile;
  return in.before[index_of(in.tiles_x(), tile_x, tile_y)].reprojection;
}

// Whether the eight texels that a row of a rigid tile copies all exist and have the phase that it assumes.
bool can_copy(const TemporalInputs& in, const TileReprojection& tile, int x, int y) {
  const int first = x / kTile * kTile - tile.step[0];
  const int row = y - tile.step[1];
  if (!tile.is_rigid || first < 0 || row < 0 || first + kTile > in.output_width || row >= in.output_height)
    return false;
  for (const int column : {first, first + kTile - 1}) {
    const TileReprojection& from = reprojection_before(in, column, row);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (std::abs(from.phase[axis] - tile.source_phase[axis]) > kCopiedPhaseErrorMax) return false;
    }
  }
  return true;
}

// Where a pixel's picture was in the previous history: texel + fraction.
template <typename Real>
struct HistoryPlace {
  bool is_copied = false;
  std::array<int, 2> texel = {};
  std::array<Real, 2> fraction = {};
};

template <typename Real>
HistoryPlace<Real> history_place(const TemporalInputs& in, const TileReprojection& tile,
                                 const Reprojection& reprojection, int x, int y) {
  if (can_copy(in, tile, x, y)) return {true, {x - tile.step[0], y - tile.step[1]}, {}};
  const std::array<int, 2> pixel = {x, y};
  const std::array<int, 2> size = {in.output_width, in.output_height};
  const std::array<double, 2> motion = {reprojection.x, reprojection.y};
  // From the pixel's centre to where its picture was.
  std::array<Real, 2> way;
  std::array<int, 2> near;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Real moved = Real(motion[axis]) * in.reprojection_scale(static_cast<int>(axis));
    way[axis] = clamp(moved, -kSourceDistanceMax, kSourceDistanceMax) + tile.phase[axis];
    near[axis] = pixel[axis] + truncate_within(way[axis] + .5, -pixel[axis], size[axis] - 1 - pixel[axis]);
  }
  // The texels there hold their picture at a phase of their own.
  const TileReprojection& source = reprojection_before(in, near[0], near[1]);
  HistoryPlace<Real> place;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Split<Real> at = split(way[axis] - source.phase[axis]);
    place.texel[axis] = pixel[axis] + at.whole;
    place.fraction[axis] = at.fraction;
  }
  return place;
}

template <typename Real>
bool is_outside(const TemporalInputs& in, const HistoryPlace<Real>& from) {
  const std::array<int, 2> size = {in.output_width, in.output_height};
  bool outside = false;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Real place = from.texel[axis] + from.fraction[axis];
    outside = outside || place < -.5 || place > size[axis] - .5;
  }
  return outside;
}

// `at(x, y)`: what is sampled, of a texel.
template <typename Real, typename At>
Real linear_of(const At& at, int x, int y, const std::array<Real, 2>& fraction) {
  const auto on_row = [&](int row) {
    const Real left = at(x, row);
    const Real right = at(x + 1, row);
    return left + (right - left) * fraction[0];
  };
  const Real upper = on_row(y);
  return upper + (on_row(y + 1) - upper) * fraction[1];
}

template <typename Real, typename At>
Real cubic_of(const At& at, int x, int y, const std::array<Real, 2>& fraction, double a) {
  const std::array<Real, 4> wx = cubic_weights(fraction[0], a);
  const std::array<Real, 4> wy = cubic_weights(fraction[1], a);
  Real result = 0;
  double low = at(x, y);
  double high = low;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double texel = at(x + column - 1, y + row - 1);
      result += texel * wx[static_cast<std::size_t>(column)] * wy[static_cast<std::size_t>(row)];
      const bool is_inner = row % 3 != 0 && column % 3 != 0;
      if (is_inner) low = std::min(low, texel);
      if (is_inner) high = std::max(high, texel);
    }
  }
  return clamp(result, low, high);
}

// Returns the weights of the six texels around a place, `f` past the third: Hermite's cubic, with slopes of .9 of the
// difference of the two nearest texels of each less .25 of that of the next.
template <typename Real>
std::array<Real, 6> six_weights(const Real& f) {
  constexpr double kLongCubicNearSlope = .9;
  constexpr double kLongCubicFarSlope = .25;
  const Real rest = 1 - f;
  const Real before = f * rest * rest;
  const Real after = -f * f * rest;
  const Real next = f * f * (3 - 2 * f);
  return {kLongCubicFarSlope * before,
          kLongCubicFarSlope * after - kLongCubicNearSlope * before,
          1 - next - kLongCubicNearSlope * after,
          next + kLongCubicNearSlope * before,
          kLongCubicNearSlope * after - kLongCubicFarSlope * before,
          -(kLongCubicFarSlope * after)};
}

// Held in the range of the middle 4 x 4.
template <typename Real, typename At>
Real six_of(const At& at, int x, int y, const std::array<Real, 2>& fraction) {
  const std::array<Real, 6> wx = six_weights(fraction[0]);
  const std::array<Real, 6> wy = six_weights(fraction[1]);
  Real result = 0;
  double low = at(x, y);
  double high = low;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const double texel = at(x + column - 2, y + row - 2);
      result += texel * wx[static_cast<std::size_t>(column)] * wy[static_cast<std::size_t>(row)];
      const bool is_inner = row % 5 != 0 && column % 5 != 0;
      if (is_inner) low = std::min(low, texel);
      if (is_inner) high = std::max(high, texel);
    }
  }
  return clamp(result, low, high);
}

// Between the four texels from (x, y) on, or the sixteen or 36 around them.
template <typename Real>
HistoryTexel<Real> sample_history(const TemporalInputs& in, int taps, int x, int y,
                                  const std::array<Real, 2>& fraction) {
  const bool has_alpha = !in.history_alpha.empty();
  HistoryTexel<Real> known;
  if (taps == 4) {
    for (std::size_t c = 0; c < 4; ++c)
      known.texel[c] = linear_of([&](int i, int j) { return in.history_clamped(i, j)[c]; }, x, y, fraction);
    if (has_alpha)
      known.alpha = linear_of([&](int i, int j) { return in.alpha_clamped(i, j); }, x, y, fraction);
    return known;
  }
  if (taps == 36) {
    for (std::size_t c = 0; c < 4; ++c)
      known.texel[c] = six_of([&](int i, int j) { return in.history_clamped(i, j)[c]; }, x, y, fraction);
    if (has_alpha) known.alpha = six_of([&](int i, int j) { return in.alpha_clamped(i, j); }, x, y, fraction);
    return known;
  }
  known.texel = sample_cubic(in, x, y, fraction, kHistorySharpness);
  if (has_alpha) known.alpha = sample_alpha_cubic(in, x, y, fraction, kHistorySharpness);
  return known;
}

}  // namespace

const Pixel& TemporalInputs::history_clamped(int x, int y) const {
  return history[index_of(output_width, std::clamp(x, 0, output_width - 1),
                          std::clamp(y, 0, output_height - 1))];
}

double TemporalInputs::alpha_clamped(int x, int y) const {
  if (history_alpha.empty()) return 1;
  return history_alpha[index_of(output_width, std::clamp(x, 0, output_width - 1),
                                std::clamp(y, 0, output_height - 1))];
}

template <typename Real>
FetchedHistory<Real> fetch_history(const TemporalInputs& in, const TileReprojection& tile,
                                   const Reprojection& reprojection, const TemporalOptions& options, int x,
                                   int y) {
  const auto from = history_place<Real>(in, tile, reprojection, x, y);
  FetchedHistory<Real> fetched;
  fetched.texel = from.texel;
  if (from.is_copied) {
    fetched.known.texel = as<Real>(in.history_clamped(from.texel[0], from.texel[1]));
    fetched.known.alpha = in.alpha_clamped(from.texel[0], from.texel[1]);
    return fetched;
  }
  for (std::size_t axis = 0; axis < 2; ++axis)
    fetched.texel[axis] += from.fraction[axis] >= .5 ? 1 : 0;
  fetched.known = sample_history(in, options.taps, from.texel[0], from.texel[1], from.fraction);
  if (is_outside(in, from)) fetched.known.texel[3] = 0;
  fetched.between = between_texels(from.fraction);
  return fetched;
}

template <typename Real>
PixelOf<Real> sample_cubic(const TemporalInputs& in, int x, int y, const std::array<Real, 2>& fraction,
                           double a) {
  PixelOf<Real> result = {};
  for (std::size_t c = 0; c < 4; ++c)
    result[c] = cubic_of([&](int i, int j) { return in.history_clamped(i, j)[c]; }, x, y, fraction, a);
  return result;
}

template <typename Real>
Real sample_alpha_cubic(const TemporalInputs& in, int x, int y, const std::array<Real, 2>& fraction,
                        double a) {
  return cubic_of([&](int i, int j) { return in.alpha_clamped(i, j); }, x, y, fraction, a);
}

template FetchedHistory<double> fetch_history(const TemporalInputs&, const TileReprojection&,
                                              const Reprojection&, const TemporalOptions&, int, int);
template FetchedHistory<Bounded> fetch_history(const TemporalInputs&, const TileReprojection&,
                                               const Reprojection&, const TemporalOptions&, int, int);
template PixelOf<double> sample_cubic(const TemporalInputs&, int, int, const std::array<double, 2>&, double);
template PixelOf<Bounded> sample_cubic(const TemporalInputs&, int, int, const std::array<Bounded, 2>&,
                                       double);
template double sample_alpha_cubic(const TemporalInputs&, int, int, const std::array<double, 2>&, double);
template Bounded sample_alpha_cubic(const TemporalInputs&, int, int, const std::array<Bounded, 2>&, double);

}  // namespace quincunx::reference
