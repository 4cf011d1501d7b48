// SPDX-License-Identifier: MIT
// temporal_tiles where the picture has two layers: the near layer of a tile. `before` of a place: what the
// previous frame's tile there has.
//   split       a tile of the 3 x 3 around it is marked, and a sample in it or next to it is split
//   range       of the motions v of those samples, on the axis where it is larger
//   rigid       the near layer: if that is no more than .05 px
//   phase       R' - v without whole texels. R': the near layer's phase before, if the tile's middle + v was split
//               and the mean near depth of the samples is above `between` there, else the phase of the tile there
//   layered     split, or a tile was split that the tile's texels, and 3 around them, come from
//   far layer   where texels come from such a tile, a rigid tile whose middle was split there, and whose samples
//               are nearer in the mean than `between` there, goes on with the near layer's phase
//   hidden      texels come from such a tile, and the far layer is not rigid or has gone on so: no sample of it
//               judges history
// Source: found by measuring (docs/lab/layers.md).
#include <cmath>
#include <cstddef>

#include "tile_samples.h"

namespace quincunx::reference {
namespace {

constexpr int kFetchReach = 3;      // texels around the place of a pixel that fetching history may read
constexpr int kSourceTilesMax = 8;  // tiles: what comes from places farther apart counts as split

bool is_marked(const TemporalInputs& in, int tile_x, int tile_y) {
  for (int y = std::max(tile_y - 1, 0); y <= std::min(tile_y + 1, in.tiles_y() - 1); ++y) {
    for (int x = std::max(tile_x - 1, 0); x <= std::min(tile_x + 1, in.tiles_x() - 1); ++x) {
      if (in.split_marks[index_of(in.tiles_x(), x, y)] != 0) return true;
    }
  }
  return false;
}

// The previous frame's tile that the middle of a tile comes from.
template <typename Real>
std::size_t tile_before(const TemporalInputs& in, int tile_x, int tile_y, const std::array<Real, 2>& motion) {
  return tile_index_at<Real>(
      in, {tile_x * kTile + kTile / 2 + motion[0], tile_y * kTile + kTile / 2 + motion[1]});
}

// On one axis of the tiles that a tile's texels, and those around them, come from.
template <typename Real>
SampleRange tiles_before(int tile, double least, double most, double scale, int count) {
  const Real first = tile * kTile + Real(least) * scale - kFetchReach;
  const Real last = (tile + 1) * kTile + Real(most) * scale + kFetchReach;
  return {floor_within(first / kTile, 0, count - 1), floor_within(last / kTile, 0, count - 1)};
}

template <typename Real>
bool comes_from_split(const TemporalInputs& in, int tile_x, int tile_y) {
  const MotionRange motion = motion_in(in, samples_around_tile<Real>(in, tile_x, tile_y));
  const SampleRange columns =
      tiles_before<Real>(tile_x, motion.least[0], motion.most[0], in.reprojection_scale(0), in.tiles_x());
  const SampleRange rows =
      tiles_before<Real>(tile_y, motion.least[1], motion.most[1], in.reprojection_scale(1), in.tiles_y());
  if (columns.last - columns.first > kSourceTilesMax || rows.last - rows.first > kSourceTilesMax) return true;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      if (in.layers_before[index_of(in.tiles_x(), x, y)].is_split) return true;
    }
  }
  return false;
}

// Returns the mean depth of the far, or only, layer.
template <typename Real>
Real mean_depth(const TemporalInputs& in, int tile_x, int tile_y) {
  const auto [columns, rows] = samples_of_tile<Real>(in, tile_x, tile_y);
  Real sum = 0;
  int count = 0;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const std::size_t i = index_of(in.frame.width, x, y);
      sum += in.splits[i].is_split() ? in.splits[i].far_depth : in.frame.depth[i];
      ++count;
    }
  }
  return sum / count;
}

template <typename Real>
LayerTileOf<Real> near_layer(const TemporalInputs& in, int tile_x, int tile_y) {
  LayerTileOf<Real> tile;
  if (!is_marked(in, tile_x, tile_y)) return tile;
  std::array<double, 2> least = {1e9, 1e9}, most = {-1e9, -1e9};
  Real between = 0, near_depth = 0;
  int count = 0;
  const auto [columns, rows] = samples_around_tile<Real>(in, tile_x, tile_y);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const LayerSplit& split = in.splits[index_of(in.frame.width, x, y)];
      if (!split.is_split()) continue;
      least = {std::min(least[0], split.motion[0]), std::min(least[1], split.motion[1])};
      most = {std::max(most[0], split.motion[0]), std::max(most[1], split.motion[1])};
      between += .5 * (Real(split.near_depth) + split.far_depth);
      near_depth += split.near_depth;
      ++count;
    }
  }
  if (count == 0) return tile;
  tile.is_split = true;
  tile.between = between / count;
  tile.motion_range = max(Real(most[0]) - least[0], Real(most[1]) - least[1]);
  if (tile.motion_range > kRigidMotionRangeMax) return tile;

  std::array<Real, 2> motion;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    motion[axis] = .5 * (Real(most[axis]) + least[axis]);
    if (abs(motion[axis]) < kStillMotionMax) motion[axis] = 0;
  }
  tile.is_rigid = true;
  const std::size_t from = tile_before(in, tile_x, tile_y, motion);
  const LayerTile& before = in.layers_before[from];
  const bool was_near = before.is_split && near_depth / count > before.between;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double phase = was_near ? before.phase[axis] : in.before[from].reprojection.phase[axis];
    const Real place = phase - motion[axis];
    tile.phase[axis] = place - split(place + .5).whole;
  }
  return tile;
}

// A rigid tile of a thing that was a near layer where it comes from goes on with that layer's phase. Returns
// whether it does.
template <typename Real>
bool take_near_phase(const TemporalInputs& in, int tile_x, int tile_y, TileReprojectionOf<Real>& tile) {
  std::array<Real, 2> motion;
  for (std::size_t axis = 0; axis < 2; ++axis)
    motion[axis] = tile.source_phase[axis] - tile.phase[axis] - tile.step[axis];
  const LayerTile& before = in.layers_before[tile_before(in, tile_x, tile_y, motion)];
  if (!before.is_split || !(mean_depth<Real>(in, tile_x, tile_y) > before.between)) return false;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Real place = before.phase[axis] - motion[axis];
    tile.source_phase[axis] = before.phase[axis];
    tile.step[axis] = split(place + .5).whole;
    tile.phase[axis] = place - tile.step[axis];
  }
  return true;
}

}  // namespace

template <typename Real>
LayeredTileOf<Real> layer_tile(const TemporalInputs& in, const TileReprojectionOf<Real>& reprojection,
                               int tile_x, int tile_y) {
  LayeredTileOf<Real> tile{near_layer<Real>(in, tile_x, tile_y), reprojection};
  const bool from_split = comes_from_split<Real>(in, tile_x, tile_y);
  tile.layers.is_layered = tile.layers.is_split || from_split;
  if (tile.layers.is_split) tile.reprojection.has_motion_edge = true;
  tile.is_hidden =
      from_split && (!reprojection.is_rigid || take_near_phase(in, tile_x, tile_y, tile.reprojection));
  return tile;
}

template LayeredTileOf<double> layer_tile(const TemporalInputs&, const TileReprojectionOf<double>&, int, int);
template LayeredTileOf<Bounded> layer_tile(const TemporalInputs&, const TileReprojectionOf<Bounded>&, int,
                                           int);

}  // namespace quincunx::reference
