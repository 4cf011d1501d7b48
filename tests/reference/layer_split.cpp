// SPDX-License-Identifier: MIT
// layer_split: which samples have two layers. r: the record within 1.7 samples of a sample whose squared distance
// + .4 of its age is least; b: the closest of the sample's 3 x 3 that lies behind r, d(b) < .97 d(r).
//   split       if |v(r) - v(b)| > .05 px: the layers are r's and b's
//   begun       r is of age 0, and no cell of the 5 x 5 around where it comes from has a record of the previous frame
//   far motion  the sample's own if its depth is below half-way between the layers, else b's
// The first of two alike counts, row by row.
// Source: found by measuring (docs/lab/layers.md).
#include <algorithm>
#include <cstddef>

#include "layers.h"
#include "temporal.h"

namespace quincunx::reference {
namespace {

constexpr double kRecordDistanceMax = 1.7;  // samples
constexpr double kRecordAgeCost = .4;       // samples, squared, for each frame of a record's age
constexpr int kKnownRecordCells = 2;        // cells

template <typename Real>
LayerRecordOf<Real> record_of(const LayerInputs& in, const RecordGrid& now, std::size_t i) {
  const RecordCell& cell = now.cells[i];
  if (cell.age > 0) return advanced<Real>(in.before.records[static_cast<std::size_t>(cell.origin)]);
  const LayerRecord& own = now.records[i];
  return {
      .place = {own.place[0], own.place[1]}, .depth = own.depth, .motion = {own.motion[0], own.motion[1]}};
}

template <typename Real>
struct FoundRecord {
  LayerRecordOf<Real> record;
  int age = 0;
};

// Finds that of sample (x, y).
template <typename Real>
std::optional<FoundRecord<Real>> find_record(const LayerInputs& in, const RecordGrid& now, int x, int y) {
  const auto [columns, rows] = axes_of<Real>(in);
  std::optional<FoundRecord<Real>> found;
  Real least = 0;
  // A record lies within half a sample of its cell's centre.
  constexpr int kSampleReachMax = 2;
  for (int row = std::max(y - kSampleReachMax, 0); row <= std::min(y + kSampleReachMax, in.frame.height - 1);
       ++row) {
    for (int column = std::max(x - kSampleReachMax, 0);
         column <= std::min(x + kSampleReachMax, in.frame.width - 1); ++column) {
      const std::size_t i = index_of(in.frame.width, column, row);
      const RecordCell& cell = now.cells[i];
      if (!cell.has_record()) continue;
      const auto record = record_of<Real>(in, now, i);
      Real distance = (column - x) * (column - x) + (row - y) * (row - y);  // a new one lies at its sample
      if (cell.age > 0) {
        const Real apart_x = columns.coordinate(record.place[0]) - x;
        const Real apart_y = rows.coordinate(record.place[1]) - y;
        distance = apart_x * apart_x + apart_y * apart_y;
      }
      if (!(distance <= Real(kRecordDistanceMax) * kRecordDistanceMax)) continue;
      const Real cost = distance + kRecordAgeCost * Real(cell.age);
      if (found && !(cost < least)) continue;
      least = cost;
      found = {record, cell.age};
    }
  }
  return found;
}

// Whether the previous frame has a record around the place that `record` comes from.
template <typename Real>
bool was_known(const LayerInputs& in, const LayerRecordOf<Real>& record) {
  const SampleAxis<Real> columns(in.output_width, in.previous_width, in.previous_jitter[0]);
  const SampleAxis<Real> rows(in.output_height, in.previous_height, in.previous_jitter[1]);
  // Outside all cells it does not matter where.
  const int middle_x = floor_within(columns.coordinate(record.place[0] + record.motion[0]) + .5,
                                    -kKnownRecordCells - 1, in.previous_width + kKnownRecordCells);
  const int middle_y = floor_within(rows.coordinate(record.place[1] + record.motion[1]) + .5,
                                    -kKnownRecordCells - 1, in.previous_height + kKnownRecordCells);
  for (int y = std::max(middle_y - kKnownRecordCells, 0);
       y <= std::min(middle_y + kKnownRecordCells, in.previous_height - 1); ++y) {
    for (int x = std::max(middle_x - kKnownRecordCells, 0);
         x <= std::min(middle_x + kKnownRecordCells, in.previous_width - 1); ++x) {
      if (in.before.cells[index_of(in.previous_width, x, y)].has_record()) return true;
    }
  }
  return false;
}

// The closest of the 3 x 3 samples that lies behind `depth`.
template <typename Real>
std::optional<SurfaceOf<Real>> find_behind(const LayerInputs& in, double depth, int x, int y) {
  std::optional<SurfaceOf<Real>> found;
  int least = 0;
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const int distance = row * row + column * column;
      if (found && distance >= least) continue;
      const auto other = surface_at<Real>(in, x + column, y + row);
      if (!other.is_known || !(other.depth < Real(depth) * (1 - kLayerGapMin))) continue;
      least = distance;
      found = other;
    }
  }
  return found;
}

}  // namespace

template <typename Real>
LayerSampleOf<Real> layer_split(const LayerInputs& in, const RecordGrid& now, int x, int y) {
  const auto found = find_record<Real>(in, now, x, y);
  if (!found) return {};
  const LayerRecordOf<Real>* record = &found->record;
  const auto behind = find_behind<Real>(in, record->depth, x, y);
  if (!behind || !move_apart(record->motion, behind->motion)) return {};

  LayerSampleOf<Real> sample;
  sample.split = {.near_depth = record->depth, .far_depth = behind->depth, .motion = record->motion};
  sample.has_begun = found->age == 0 && !was_known(in, *record);
  const auto own = surface_at<Real>(in, x, y);
  const bool is_far = own.is_known && own.depth < .5 * (Real(record->depth) + behind->depth);
  const std::array<Real, 2>& motion = is_far ? own.motion : behind->motion;
  const std::array<double, 2> to_previous = {static_cast<double>(in.previous_width) / in.output_width,
                                             static_cast<double>(in.previous_height) / in.output_height};
  for (std::size_t axis = 0; axis < 2; ++axis)
    sample.far_motion[axis] = clamp(motion[axis] * to_previous[axis], -kSurfaceMotionMax, kSurfaceMotionMax);
  const auto [columns, rows] = axes_of<Real>(in);
  const int tiles_x = (in.output_width + kTile - 1) / kTile;
  const int tiles_y = (in.output_height + kTile - 1) / kTile;
  const int tile_x = floor_within(columns.place_of(x) / kTile, 0, tiles_x - 1);
  const int tile_y = floor_within(rows.place_of(y) / kTile, 0, tiles_y - 1);
  sample.tile = static_cast<int>(index_of(tiles_x, tile_x, tile_y));
  return sample;
}

template LayerSampleOf<double> layer_split(const LayerInputs&, const RecordGrid&, int, int);
template LayerSampleOf<Bounded> layer_split(const LayerInputs&, const RecordGrid&, int, int);

}  // namespace quincunx::reference
