// SPDX-License-Identifier: MIT
// The samples of a tile, and how they move: of temporal_tiles, with one layer and two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {

// Output pixels by which the motion of a rigid tile's samples may differ: what velocity in halves is off by
// stays below.
constexpr double kRigidMotionRangeMax = .05;
// Output pixels of motion that are the rounding of a velocity of 0.
constexpr double kStillMotionMax = 1e-4;

struct SampleRange {
  int first = 0;
  int last = 0;
};

// The samples whose centres lie in a tile; at least one, the nearest.
template <typename Real>
SampleRange samples_in(int tile, double spacing, double jitter, int count) {
  const double start = (.5 + jitter) * spacing;  // place of sample 0
  const auto sample_at = [&](int corner) { return (Real(corner) - start) / spacing; };
  const int first = ceil_within(sample_at(tile * kTile), 0, count - 1);
  return {first, ceil_within(sample_at((tile + 1) * kTile), first + 1, count) - 1};
}

template <typename Real>
std::array<SampleRange, 2> samples_of_tile(const TemporalInputs& in, int tile_x, int tile_y) {
  return {samples_in<Real>(tile_x, in.spacing(0), in.frame.jitter_x, in.frame.width),
          samples_in<Real>(tile_y, in.spacing(1), in.frame.jitter_y, in.frame.height)};
}

inline SampleRange with_neighbours(SampleRange samples, int count) {
  return {std::max(samples.first - 1, 0), std::min(samples.last + 1, count - 1)};
}

// The same and the next samples around them.
template <typename Real>
std::array<SampleRange, 2> samples_around_tile(const TemporalInputs& in, int tile_x, int tile_y) {
  const auto [columns, rows] = samples_of_tile<Real>(in, tile_x, tile_y);
  return {with_neighbours(columns, in.frame.width), with_neighbours(rows, in.frame.height)};
}

// The range of motion of the samples in both ranges, in pixels of the previous frame.
struct MotionRange {
  std::array<double, 2> least = {1e9, 1e9};
  std::array<double, 2> most = {-1e9, -1e9};
  double motion_edge = 0;
  bool is_known = true;
  bool is_trusted = true;  // wholly
};

inline MotionRange motion_in(const TemporalInputs& in, const std::array<SampleRange, 2>& samples) {
  MotionRange range;
  const auto [columns, rows] = samples;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const Reprojection& sample = in.reprojection_at(x, y);
      range.is_known = range.is_known && !std::isnan(sample.trust);
      range.is_trusted = range.is_trusted && sample.trust == 1;
      range.motion_edge = std::max(range.motion_edge, std::abs(sample.motion_edge));
      range.least = {std::min(range.least[0], sample.x), std::min(range.least[1], sample.y)};
      range.most = {std::max(range.most[0], sample.x), std::max(range.most[1], sample.y)};
    }
  }
  return range;
}

// The index of the tile at an output position, clamped to the edge.
template <typename Real>
std::size_t tile_index_at(const TemporalInputs& in, const std::array<Real, 2>& at) {
  const int x = floor_within(at[0] / kTile, 0, in.tiles_x() - 1);
  const int y = floor_within(at[1] / kTile, 0, in.tiles_y() - 1);
  return index_of(in.tiles_x(), x, y);
}

}  // namespace quincunx::reference
