// SPDX-License-Identifier: MIT
// temporal_tiles: of each tile of 8 x 8 output pixels how history is reprojected, and what the samples say of
// it. M: the motion of all samples in the tile and next to it, R': the phase of the tile that its middle
// comes from.
//   rigid         if M differs by no more than .05 px on either axis
//   phase, step   R' - M = step + phase, step the nearest integer
//   evidence      sum of (s - h) k, h k, |s - h| k and |s - n| k, k = 1 / (1 + s + h): luma of the sample s, of
//                 history h at its place, of the mean n of its four neighbours
// Source: found by measuring (docs/temporal.md): carrying a phase instead of resampling gives .7 dB, and 1.6
// to 2.2 dB on pans.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "motion_edge.h"
#include "temporal.h"

namespace quincunx::reference {
namespace {

// Output pixels by which the motion of a rigid tile's samples may differ: what velocity in halves is off by
// stays below.
constexpr double kRigid = .05;
// Output pixels of a motion edge up to which a tile's samples need not be looked at: where limit_confidence
// in resolve_temporal.cpp begins to act.
constexpr double kNoMotionEdge = .1;
// Output pixels of motion that are the rounding of a velocity of 0.
constexpr double kStill = 1e-4;
// Trust of a sample, and confidence of history, from which the one judges the other. A texel reseeded in the
// last frame has .15, and counts.
constexpr double kTrusted = .9;
constexpr double kKnown = .1;
// Change of luma that says nothing. Not to count smaller ones is worth .03 dB (docs/temporal.md).
constexpr double kNoise = .01;

struct Range {
  int first = 0;
  int last = 0;
};

// The samples whose centres lie in a tile; at least one, the nearest.
template <typename Real>
Range samples_in(int tile, double spacing, double jitter, int count) {
  const double start = (.5 + jitter) * spacing;  // of sample 0
  const auto sample_at = [&](int corner) { return (Real(corner) - start) / spacing; };
  const int first = ceil_within(sample_at(tile * kTile), 0, count - 1);
  return {first, ceil_within(sample_at((tile + 1) * kTile), first + 1, count) - 1};
}

// The previous frame's tile at an output position, clamped to the edge.
template <typename Real>
const TileReprojection& tile_before(const TemporalInputs& in, const std::array<Real, 2>& at) {
  const int x = floor_within(at[0] / kTile, 0, in.tiles_x() - 1);
  const int y = floor_within(at[1] / kTile, 0, in.tiles_y() - 1);
  return in.before[index_of(in.tiles_x(), x, y)].reprojection;
}

// Of the samples in both ranges; motion in pixels of the previous frame.
struct MotionRange {
  std::array<double, 2> least = {1e9, 1e9};
  std::array<double, 2> most = {-1e9, -1e9};
  double motion_edge = 0;
  bool is_known = true;
  bool is_trusted = true;  // wholly
};

MotionRange motion_in(const TemporalInputs& in, Range columns, Range rows) {
  MotionRange range;
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

Range with_neighbours(Range samples, int count) {
  return {std::max(samples.first - 1, 0), std::min(samples.last + 1, count - 1)};
}

template <typename Real>
Real luma(const PixelOf<Real>& c) {
  return max(.25 * (c[0] + c[2]) + .5 * c[1], 0);
}

// How far the mean of its four neighbours is from a sample; 0 where that is not valid.
template <typename Real>
Real neighbour_error(const TemporalInputs& in, int x, int y, const Real& own) {
  const auto left = as<Real>(texel_clamped(in.frame, x - 1, y));
  const auto right = as<Real>(texel_clamped(in.frame, x + 1, y));
  const auto above = as<Real>(texel_clamped(in.frame, x, y - 1));
  const auto below = as<Real>(texel_clamped(in.frame, x, y + 1));
  PixelOf<Real> mean;
  for (std::size_t c = 0; c < 4; ++c)
    mean[c] = .25 * (left[c] + right[c] + above[c] + below[c]);
  return is_valid(mean) ? abs(own - luma(mean)) : Real(0);
}

// Where history holds what the sample shows.
template <typename Real>
std::array<Real, 2> place_in_history(const TemporalInputs& in, const TileReprojectionOf<Real>& tile, int x,
                                     int y) {
  const std::array<int, 2> sample = {x, y};
  const std::array<double, 2> jitter = {in.frame.jitter_x, in.frame.jitter_y};
  std::array<Real, 2> at;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double spacing = in.spacing(static_cast<int>(axis));
    at[axis] = Real(sample[axis]) * spacing + (.5 + jitter[axis]) * spacing;
    if (tile.is_rigid) at[axis] = at[axis] - (tile.phase[axis] + tile.step[axis]);
  }
  if (tile.is_rigid) return at;
  const Reprojection& reprojection = in.reprojection_at(x, y);
  at[0] += Real(reprojection.x) * in.reprojection_scale(0);
  at[1] += Real(reprojection.y) * in.reprojection_scale(1);
  const TileReprojection& from = tile_before(in, at);
  return {at[0] - from.phase[0], at[1] - from.phase[1]};
}

// What the sample (x, y) says.
template <typename Real>
void judge_sample(const TemporalInputs& in, const TileReprojectionOf<Real>& tile, int x, int y,
                  TileEvidenceOf<Real>& evidence) {
  if (!in.reprojections.empty() && !(in.reprojection_at(x, y).trust > kTrusted)) return;
  const std::array<Real, 2> at = place_in_history(in, tile, x, y);
  if (at[0] < 0 || at[1] < 0 || at[0] >= in.output_width || at[1] >= in.output_height) return;
  const int column = floor_within(at[0], 0, in.output_width - 1);
  const int row = floor_within(at[1], 0, in.output_height - 1);
  const Pixel& history = in.history_clamped(column, row);
  const Pixel& sample = texel_clamped(in.frame, x, y);
  if (history[3] < kKnown || !is_valid(sample)) return;
  const Real s = luma(as<Real>(sample));
  const Real h = luma(as<Real>(history));
  const Real scale = 1 / (1 + s + h);
  const Real change = (s - h) * scale;
  evidence.brightening += change;
  evidence.light += h * scale;
  evidence.history_error += abs(change);
  evidence.neighbour_error += neighbour_error(in, x, y, s) * scale;
  if (change > kNoise) ++evidence.brighter;
  if (change < -kNoise) --evidence.brighter;
  ++evidence.count;
}

}  // namespace

template <typename Real>
TileReprojectionOf<Real> reproject_tile(const TemporalInputs& in, int tile_x, int tile_y) {
  TileReprojectionOf<Real> tile;
  if (in.reprojections.empty()) {
    tile.is_rigid = tile.is_copyable = true;
    return tile;
  }
  const Range columns = samples_in<Real>(tile_x, in.spacing(0), in.frame.jitter_x, in.frame.width);
  const Range rows = samples_in<Real>(tile_y, in.spacing(1), in.frame.jitter_y, in.frame.height);
  const MotionRange range =
      motion_in(in, with_neighbours(columns, in.frame.width), with_neighbours(rows, in.frame.height));
  tile.has_motion_edge = Real(range.motion_edge) > kMotionEdgeBegins;
  if (!range.is_known) return tile;

  const std::array<int, 2> middle = {tile_x * kTile + kTile / 2, tile_y * kTile + kTile / 2};
  std::array<Real, 2> motion;
  std::array<Real, 2> from;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double scale = in.reprojection_scale(static_cast<int>(axis));
    if ((Real(range.most[axis]) - range.least[axis]) * scale > kRigid) return tile;
    motion[axis] = .5 * (Real(range.most[axis]) + range.least[axis]) * scale;
    if (abs(motion[axis]) < kStill) motion[axis] = 0;
    from[axis] = middle[axis] + motion[axis];
  }
  const TileReprojection& source = tile_before(in, from);
  tile.is_rigid = true;
  tile.is_copyable = range.is_trusted && Real(range.motion_edge) <= kNoMotionEdge;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    tile.source_phase[axis] = source.phase[axis];
    const Real place = source.phase[axis] - motion[axis];
    tile.step[axis] = split(place + .5).whole;
    tile.phase[axis] = place - tile.step[axis];
  }
  return tile;
}

template <typename Real>
TileEvidenceOf<Real> judge_history(const TemporalInputs& in, const TileReprojectionOf<Real>& reprojection,
                                   int tile_x, int tile_y) {
  TileEvidenceOf<Real> evidence;
  const Range columns = samples_in<Real>(tile_x, in.spacing(0), in.frame.jitter_x, in.frame.width);
  const Range rows = samples_in<Real>(tile_y, in.spacing(1), in.frame.jitter_y, in.frame.height);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const bool is_judge = (x + in.judged_apart / 2 * y) % in.judged_apart == 0;
      if (is_judge) judge_sample(in, reprojection, x, y, evidence);
    }
  }
  return evidence;
}

std::vector<Tile> temporal_tiles(const TemporalInputs& in) {
  std::vector<Tile> tiles;
  for (int y = 0; y < in.tiles_y(); ++y) {
    for (int x = 0; x < in.tiles_x(); ++x) {
      const auto reprojection = reproject_tile<double>(in, x, y);
      tiles.push_back({reprojection, judge_history(in, reprojection, x, y)});
    }
  }
  return tiles;
}

template TileReprojectionOf<double> reproject_tile(const TemporalInputs&, int, int);
template TileReprojectionOf<Bounded> reproject_tile(const TemporalInputs&, int, int);
template TileEvidenceOf<double> judge_history(const TemporalInputs&, const TileReprojectionOf<double>&, int,
                                              int);
template TileEvidenceOf<Bounded> judge_history(const TemporalInputs&, const TileReprojectionOf<Bounded>&, int,
                                               int);

}  // namespace quincunx::reference
