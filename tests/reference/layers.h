// SPDX-License-Identifier: MIT
// The second layer of history, kernel by kernel: the specification, which docs/layers.md explains. Each
// function makes what one work-item makes of a sample or a record. error_bound.h tells what `Real` may be.
//
// Where a *near* surface moves apart from a *far* one, a texel keeps the history of either. Lengths are output
// pixels, motions lead from a place to that in the previous frame, and depths are reversed: the larger the
// nearer.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

// A sample of a near surface beside a far one that moves apart from it.
template <typename Real>
struct LayerRecordOf {
  std::array<Real, 2> place = {};
  double depth = 0;
  std::array<Real, 2> motion = {};
  std::array<Real, 2> drift = {};  // what motion grows by from frame to frame
  bool is_thin = false;            // what it shows: so it outlives its sample
};
using LayerRecord = LayerRecordOf<double>;

// The two layers at a sample.
template <typename Real>
struct LayerSplitOf {
  double near_depth = 0;  // 0: there is one layer
  double far_depth = 0;
  std::array<Real, 2> motion = {};  // motion of the near layer

  bool is_split() const { return near_depth > 0; }
};
using LayerSplit = LayerSplitOf<double>;

// The layers of a tile, besides its TileReprojection, which is the far layer's.
template <typename Real>
struct LayerTileOf {
  std::array<Real, 2> phase = {};  // phase of the near layer's texels; 0 unless rigid
  Real between = 0;                // mean of the depths half-way between the layers of its samples
  Real motion_range = 0;           // range over its samples' near layers, on the axis where it is larger
  bool is_rigid = false;           // the near layer
  bool is_split = false;           // a sample in it or next to it has two layers
  bool is_layered = false;         // split, or texels of two layers may be where it was
};
using LayerTile = LayerTileOf<double>;

// A cell of a grid of records. Each sample of a viewport has one.
struct RecordCell {
  int age = -1;    // frames since a sample showed the cell's record; -1: the cell has none
  int origin = 0;  // the cell that it comes from: of age 0 this one, else one of the previous frame's grid

  bool has_record() const { return age >= 0; }
};

struct RecordGrid {
  std::vector<RecordCell> cells;
  std::vector<LayerRecord> records;  // one for each cell, where it has one
};

struct LayerInputs {
  Frame frame;  // velocity, depth, jitter
  int previous_width = 0;
  int previous_height = 0;
  std::array<double, 2> previous_jitter = {};
  int output_width = 0;
  int output_height = 0;
  RecordGrid before;  // records of the previous frame
};

// layer_records: of sample (x, y), if it is one of a near surface.
template <typename Real>
std::optional<LayerRecordOf<Real>> layer_record(const LayerInputs& in, int x, int y);

// A record of the previous frame in this one.
template <typename Real>
LayerRecordOf<Real> advanced(const LayerRecord& before);

// turn_records: the record of a cell of the previous frame's grid as it leaves it. `now`: the new records.
template <typename Real>
LayerRecord turned_record(const LayerInputs& in, const RecordGrid& now, int before);

// advect_records: the cell of this frame's grid to which the record of a cell of the previous one goes; nowhere
// if it is not carried over.
template <typename Real>
std::optional<int> advected_cell(const LayerInputs& in, int before);
// The grid of this frame's records after those of the previous one have come.
std::vector<RecordCell> advect_records(const LayerInputs& in, std::vector<RecordCell> cells);

// The findings of layer_split at a sample.
template <typename Real>
struct LayerSampleOf {
  LayerSplitOf<Real> split = {};
  // If it is split:
  std::array<Real, 2> far_motion = {};  // pixels of the previous viewport
  int tile = 0;                         // in which it lies
  bool has_begun = false;               // only now do its layers move apart: history holds both
};

// `now`: this frame's grid with the records of age 0.
template <typename Real>
LayerSampleOf<Real> layer_split(const LayerInputs& in, const RecordGrid& now, int x, int y);

// ---- What these share.

constexpr double kLayerGapMin = .03;   // part of the nearer depth: surfaces closer together are one layer
constexpr double kMixedTrustMax = .2;  // trust in history that holds both layers, at most
constexpr int kRecordAgeMax = 8;       // frames for which a record outlives its sample
constexpr double kLayerMotionMin =
    .05;  // output pixels a frame: surfaces whose motion differs by less are, too

constexpr double kSurfaceMotionMax = 65504;  // pixels a frame: beyond any picture

// Depth and motion of a sample.
template <typename Real>
struct SurfaceOf {
  double depth = 0;
  std::array<Real, 2> motion = {};
  bool is_known = false;  // velocity and depth are finite
};

// Clamped to the edge.
double layer_depth_at(const LayerInputs& in, int x, int y);
template <typename Real>
SurfaceOf<Real> surface_at(const LayerInputs& in, int x, int y);

template <typename Real>
bool move_apart(const std::array<Real, 2>& a, const std::array<Real, 2>& b) {
  const Real dx = a[0] - b[0];
  const Real dy = a[1] - b[1];
  return dx * dx + dy * dy > Real(kLayerMotionMin) * kLayerMotionMin;
}

// The centres of an axis's samples: i * spacing + start.
template <typename Real>
struct SampleAxis {
  Real spacing;
  Real start;

  SampleAxis(int output, int render, double jitter)
      : spacing(static_cast<double>(output) / render), start((Real(.5) + jitter) * spacing) {}
  Real place_of(int i) const { return i * spacing + start; }
  // In samples, 0 at the first, 1 at the next.
  Real coordinate(const Real& place) const { return (place - start) / spacing; }
};
template <typename Real>
std::array<SampleAxis<Real>, 2> axes_of(const LayerInputs& in) {
  return {SampleAxis<Real>(in.output_width, in.frame.width, in.frame.jitter_x),
          SampleAxis<Real>(in.output_height, in.frame.height, in.frame.jitter_y)};
}

}  // namespace quincunx::reference
