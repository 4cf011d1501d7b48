// SPDX-License-Identifier: MIT
// temporal_tiles: of each tile of 8 x 8 output pixels how history is reprojected, and what the samples say of
// it. M: the motion of all samples in the tile and next to it, R': the phase of the tile that its middle
// comes from.
//   rigid         if M differs by no more than .05 px on either axis
//   phase, step   R' - M = step + phase, step the nearest integer
//   evidence      sum of (s - h) k, h k, |s - h| k, k = 1 / (1 + s + h), and of |s - n| / (1 + s + n): luma of
//                 the sample s, of history h at its place, of the mean n of its four neighbours
//                 lag, lit: of s - h and h by the luma weight of s. 0, in the mean, where history is what it
//                 becomes under constant light; the weights k, which depend on h, would find texture dark
//                 Samples of two layers, and those of hidden tiles (layer_tile.cpp), say nothing
//   outliers      how many of those samples are, and two of their four neighbours with them
// Source: found by measuring (docs/lab/temporal.md): carrying a phase instead of resampling gives .7 dB, and 1.6
// to 2.2 dB on pans.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "motion_edge.h"
#include "temporal/frame_samples.h"
#include "tile_samples.h"

namespace quincunx::reference {
namespace {

// Output pixels of a motion edge up to which a tile's samples need not be looked at: where limit_confidence
// in resolve_temporal.cpp begins to act.
constexpr double kCostlyEdgeMin = .1;
// Trust of a sample, and confidence of history, from which the one judges the other. A texel reseeded in the
// last frame has .15, and counts.
constexpr double kJudgingTrustMin = .9;
constexpr double kJudgedConfidenceMin = .1;
// Change of luma that says nothing. Not to count smaller ones is worth .03 dB (docs/lab/temporal.md).
constexpr double kLumaChangeMin = .01;

// The previous frame's tile at an output position, clamped to the edge.
template <typename Real>
const TileReprojection& tile_before(const TemporalInputs& in, const std::array<Real, 2>& at) {
  return in.before[tile_index_at(in, at)].reprojection;
}

template <typename Real>
Real luma(const PixelOf<Real>& c) {
  return max(.25 * (c[0] + c[2]) + .5 * c[1], 0);
}

// A sample's four neighbours; on a checkerboard the diagonal ones, which are shaded.
std::array<Pixel, 4> neighbours_of(const TemporalInputs& in, int x, int y) {
  const int aside = in.parity >= 0 ? 1 : 0;
  return {texel_clamped(in.frame, x - 1, y - aside), texel_clamped(in.frame, x + 1, y + aside),
          texel_clamped(in.frame, x + aside, y - 1), texel_clamped(in.frame, x - aside, y + 1)};
}

// How far the luma of the mean of its neighbours is from a sample's; 0 where one of them is not valid.
template <typename Real>
Real neighbour_error(const TemporalInputs& in, int x, int y, const Real& own) {
  PixelOf<Real> mean = {};
  for (const Pixel& sample : neighbours_of(in, x, y)) {
    if (!is_valid(sample)) return 0;
    for (std::size_t c = 0; c < 4; ++c)
      mean[c] += .25 * Real(sample[c]);
  }
  const Real n = luma(mean);
  return abs(own - n) / (1 + own + n);
}

// Returns how many of a sample's neighbours are outliers.
template <typename Real>
int outlier_neighbours(const TemporalInputs& in, int x, int y, const Pixel& history) {
  int count = 0;
  for (const Pixel& sample : neighbours_of(in, x, y)) {
    if (is_valid(sample) && is_outlier(sample, as<Real>(history))) ++count;
  }
  return count;
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

// Whether sample (x, y) shows a near layer, of which the layer of history that is judged knows nothing.
bool is_of_near_layer(const TemporalInputs& in, int x, int y) {
  if (!in.has_layers()) return false;
  const std::size_t i = index_of(in.frame.width, x, y);
  const LayerSplit& split = in.splits[i];
  if (!split.is_split()) return false;
  return !(Bounded(in.frame.depth[i]) < .5 * (Bounded(split.near_depth) + split.far_depth));
}

// Which of its tile's cells sample (x, y) lies in.
template <typename Real>
std::size_t cell_of(const TemporalInputs& in, int x, int y) {
  const auto half = [&](int axis, int i, double jitter) {
    const Real place = (i + .5 + Real(jitter)) * in.spacing(axis);
    return floor_within(place, 0, 1 << 24) % kTile / (kTile / 2);
  };
  return static_cast<std::size_t>(2 * half(1, y, in.frame.jitter_y) + half(0, x, in.frame.jitter_x));
}

// Adds the evidence of sample (x, y).
template <typename Real>
void judge_sample(const TemporalInputs& in, const TileReprojectionOf<Real>& tile, int x, int y,
                  TileEvidenceOf<Real>& evidence) {
  if (!in.reprojections.empty() && !(in.reprojection_at(x, y).trust > kJudgingTrustMin)) return;
  if (is_of_near_layer(in, x, y)) return;
  const std::array<Real, 2> at = place_in_history(in, tile, x, y);
  if (at[0] < 0 || at[1] < 0 || at[0] >= in.output_width || at[1] >= in.output_height) return;
  const int column = floor_within(at[0], 0, in.output_width - 1);
  const int row = floor_within(at[1], 0, in.output_height - 1);
  const Pixel& history = in.history_clamped(column, row);
  const Pixel& sample = texel_clamped(in.frame, x, y);
  if (std::abs(history[3]) < kJudgedConfidenceMin || !is_valid(sample)) return;
  const Real s = luma(as<Real>(sample));
  const Real h = luma(as<Real>(history));
  const Real scale = 1 / (1 + s + h);
  const Real change = (s - h) * scale;
  evidence.brightening += change;
  evidence.light += h * scale;
  evidence.history_error += abs(change);
  evidence.lag += luma_weighted(s - h, as<Real>(sample));
  evidence.lit += luma_weighted(h, as<Real>(sample));
  evidence.neighbour_error += neighbour_error(in, x, y, s);
  const int brighter = change > kLumaChangeMin ? 1 : change < -kLumaChangeMin ? -1 : 0;
  evidence.brighter += brighter;
  ++evidence.count;
  auto& cell = evidence.cells[cell_of<Real>(in, x, y)];
  cell.brightening += change;
  cell.brighter += brighter;
  ++cell.count;
  if (is_outlier(sample, as<Real>(history)) && outlier_neighbours<Real>(in, x, y, history) >= 2)
    ++evidence.outliers;
}

}  // namespace

template <typename Real>
TileReprojectionOf<Real> reproject_tile(const TemporalInputs& in, int tile_x, int tile_y) {
  TileReprojectionOf<Real> tile;
  if (in.reprojections.empty()) {
    tile.is_rigid = tile.is_trusted = true;
    return tile;
  }
  const MotionRange range = motion_in(in, samples_around_tile<Real>(in, tile_x, tile_y));
  tile.has_motion_edge = Real(range.motion_edge) > kRejectedEdgeMin;
  if (!range.is_known) return tile;

  const std::array<int, 2> middle = {tile_x * kTile + kTile / 2, tile_y * kTile + kTile / 2};
  std::array<Real, 2> motion;
  std::array<Real, 2> from;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double scale = in.reprojection_scale(static_cast<int>(axis));
    if ((Real(range.most[axis]) - range.least[axis]) * scale > kRigidMotionRangeMax) return tile;
    motion[axis] = .5 * (Real(range.most[axis]) + range.least[axis]) * scale;
    if (abs(motion[axis]) < kStillMotionMax) motion[axis] = 0;
    from[axis] = middle[axis] + motion[axis];
  }
  const TileReprojection& source = tile_before(in, from);
  tile.is_rigid = true;
  tile.is_trusted = range.is_trusted && Real(range.motion_edge) <= kCostlyEdgeMin;
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
  const auto [columns, rows] = samples_of_tile<Real>(in, tile_x, tile_y);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      if (in.parity < 0 || (x + y) % 2 == in.parity) judge_sample(in, reprojection, x, y, evidence);
    }
  }
  return evidence;
}

std::vector<Tile> temporal_tiles(const TemporalInputs& in) {
  std::vector<Tile> tiles;
  for (int y = 0; y < in.tiles_y(); ++y) {
    for (int x = 0; x < in.tiles_x(); ++x) {
      LayeredTileOf<double> tile{{}, reproject_tile<double>(in, x, y)};
      if (in.has_layers()) tile = layer_tile(in, tile.reprojection, x, y);
      tiles.push_back({tile.reprojection, {}});
      if (!tile.is_hidden) tiles.back().evidence = judge_history(in, tile.reprojection, x, y);
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
