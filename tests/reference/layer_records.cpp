// SPDX-License-Identifier: MIT
// layer_records and advect_records: the samples of near surfaces beside far ones that move apart from them, and
// those of thin things that live on from earlier frames. d, v: depth and motion of a sample, u: the step to a
// neighbour.
//   near       for one of the eight u: d - d(u) > .03 d, not d(-u) - d > .5 (d - d(u)), which is a plane seen at a
//              slant, and |v - v(u)| > .05 px
//   thin       no 2 x 2 block of samples that contains it has all its depths above .97 d
//   drift      .7 (v - v'), v' of the closest record of age 0 of the previous frame within 1.5 of its samples of
//              place + v whose depth differs by no more than .03 d; 0 if there is none, or it is above v / 4
//   carried    a thin record younger than 8 frames: motion += drift, place -= motion, into the cell that holds it.
//              There the youngest record stays, and of those as young that of the first cell
// turn_records: what becomes of a record of the previous frame that is carried over, where the thing that it is of has
// stopped, started or turned about.
//   found      the new record nearest to the place of the record in this frame (`advanced`), of those in the 7 x 7
//              cells around that differ by no more than .03 of its depth from it; of two alike the first
//   turned     if |v - motion| > .25 px + |v| / 4, v: motion of what was found. If a sample showed the record in the
//              previous frame, its motion becomes v and its drift 0. Else it is not thin any more
// Source: found by measuring (docs/lab/layers.md).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "layers.h"

namespace quincunx::reference {
namespace {

constexpr double kSlantRiseMax = .5;            // part of the step of depth to a neighbour
constexpr double kSameRecordDistanceMax = 1.5;  // samples of the previous frame
constexpr double kDriftShare = .7;              // part of a change of motion
constexpr double kDriftMax = .25;               // part of the motion: more is no steady change
constexpr double kSuddenMotionMin = .25;        // px a frame, and a part
constexpr double kSuddenMotionShare = .25;      // part of the new motion: less is no sudden change
constexpr int kTurnedRecordCells = 3;           // cells around a record
constexpr int kBeyond = 8;                      // samples: no record that far outside the viewport is found

template <typename Real>
Real squared_length(const std::array<Real, 2>& a) {
  return a[0] * a[0] + a[1] * a[1];
}

template <typename Real>
bool is_near(const LayerInputs& in, const SurfaceOf<Real>& own, int x, int y) {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const auto other = surface_at<Real>(in, x + column, y + row);
      if (!other.is_known) continue;
      const Real step = Real(own.depth) - other.depth;
      const Real rise = Real(layer_depth_at(in, x - column, y - row)) - own.depth;
      if (!(step > kLayerGapMin * Real(own.depth)) || rise > kSlantRiseMax * step) continue;
      if (move_apart(own.motion, other.motion)) return true;
    }
  }
  return false;
}

template <typename Real>
bool is_thin(const LayerInputs& in, double depth, int x, int y) {
  const auto is_same = [&](int column, int row) {
    return layer_depth_at(in, column, row) > Real(depth) * (1 - kLayerGapMin);
  };
  for (const int row : {-1, 1}) {
    for (const int column : {-1, 1}) {
      if (is_same(x + column, y) && is_same(x, y + row) && is_same(x + column, y + row)) return false;
    }
  }
  return true;
}

// The record of the same thing in the previous frame; null if it has left none.
template <typename Real>
const LayerRecord* record_before(const LayerInputs& in, const std::array<Real, 2>& place, double depth) {
  const SampleAxis<Real> columns(in.output_width, in.previous_width, in.previous_jitter[0]);
  const SampleAxis<Real> rows(in.output_height, in.previous_height, in.previous_jitter[1]);
  // Outside all cells it does not matter where.
  const int middle_x = floor_within(columns.coordinate(place[0]) + .5, -2, in.previous_width + 1);
  const int middle_y = floor_within(rows.coordinate(place[1]) + .5, -2, in.previous_height + 1);
  const LayerRecord* found = nullptr;
  Real least = kSameRecordDistanceMax * kSameRecordDistanceMax;
  for (int y = std::max(middle_y - 1, 0); y <= std::min(middle_y + 1, in.previous_height - 1); ++y) {
    for (int x = std::max(middle_x - 1, 0); x <= std::min(middle_x + 1, in.previous_width - 1); ++x) {
      const std::size_t i = index_of(in.previous_width, x, y);
      if (in.before.cells[i].age != 0) continue;
      const LayerRecord& record = in.before.records[i];
      const Real distance = squared_length<Real>(
          {(record.place[0] - place[0]) / columns.spacing, (record.place[1] - place[1]) / rows.spacing});
      if (abs(Real(record.depth) - depth) > kLayerGapMin * Real(depth) || !(distance < least)) continue;
      least = distance;
      found = &record;
    }
  }
  return found;
}

// Null if there is none.
template <typename Real>
const LayerRecord* new_record_at(const LayerInputs& in, const RecordGrid& now,
                                 const LayerRecordOf<Real>& record) {
  const auto [columns, rows] = axes_of<Real>(in);
  const std::array<Real, 2> at = {clamp(columns.coordinate(record.place[0]), -kBeyond, 65536),
                                  clamp(rows.coordinate(record.place[1]), -kBeyond, 65536)};
  const int middle_x = floor_within(at[0] + .5, -kTurnedRecordCells - 1, in.frame.width + kTurnedRecordCells);
  const int middle_y =
      floor_within(at[1] + .5, -kTurnedRecordCells - 1, in.frame.height + kTurnedRecordCells);
  const LayerRecord* found = nullptr;
  Real least = 0;
  for (int y = std::max(middle_y - kTurnedRecordCells, 0);
       y <= std::min(middle_y + kTurnedRecordCells, in.frame.height - 1); ++y) {
    for (int x = std::max(middle_x - kTurnedRecordCells, 0);
         x <= std::min(middle_x + kTurnedRecordCells, in.frame.width - 1); ++x) {
      const std::size_t i = index_of(in.frame.width, x, y);
      if (!now.cells[i].has_record()) continue;
      const LayerRecord& other = now.records[i];
      if (abs(Real(other.depth) - record.depth) > kLayerGapMin * Real(record.depth)) continue;
      const Real distance = squared_length<Real>({x - at[0], y - at[1]});
      if (found != nullptr && !(distance < least)) continue;
      least = distance;
      found = &other;
    }
  }
  return found;
}

template <typename Real>
bool moves_otherwise(const LayerRecordOf<Real>& record, const LayerRecord& now) {
  const std::array<Real, 2> motion = {now.motion[0], now.motion[1]};
  const Real most = kSuddenMotionMin + kSuddenMotionShare * sqrt(squared_length(motion));
  return squared_length<Real>({motion[0] - record.motion[0], motion[1] - record.motion[1]}) > most * most;
}

}  // namespace

double layer_depth_at(const LayerInputs& in, int x, int y) {
  return in.frame.depth[index_of(in.frame.width, std::clamp(x, 0, in.frame.width - 1),
                                 std::clamp(y, 0, in.frame.height - 1))];
}

template <typename Real>
SurfaceOf<Real> surface_at(const LayerInputs& in, int x, int y) {
  const auto& velocity = in.frame.velocity[index_of(in.frame.width, std::clamp(x, 0, in.frame.width - 1),
                                                    std::clamp(y, 0, in.frame.height - 1))];
  SurfaceOf<Real> surface{.depth = layer_depth_at(in, x, y)};
  surface.is_known = std::isfinite(velocity[0]) && std::isfinite(velocity[1]) && std::isfinite(surface.depth);
  if (!surface.is_known) return surface;
  const std::array<int, 2> output = {in.output_width, in.output_height};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Real motion = velocity[axis] * Real(-in.frame.velocity_scale[axis] * output[axis]);
    surface.motion[axis] = clamp(motion, -kSurfaceMotionMax, kSurfaceMotionMax);
  }
  return surface;
}

template <typename Real>
std::optional<LayerRecordOf<Real>> layer_record(const LayerInputs& in, int x, int y) {
  const auto own = surface_at<Real>(in, x, y);
  // Depth 0 is infinitely far: nothing lies behind it.
  if (!own.is_known || own.depth <= 0 || !is_near(in, own, x, y)) return {};

  const auto [columns, rows] = axes_of<Real>(in);
  LayerRecordOf<Real> record{.place = {columns.place_of(x), rows.place_of(y)},
                             .depth = own.depth,
                             .motion = own.motion,
                             .is_thin = is_thin<Real>(in, own.depth, x, y)};
  const std::array<Real, 2> place_before = {record.place[0] + own.motion[0], record.place[1] + own.motion[1]};
  const LayerRecord* before = record_before(in, place_before, own.depth);
  if (before == nullptr) return record;
  const std::array<Real, 2> drift = {kDriftShare * (own.motion[0] - before->motion[0]),
                                     kDriftShare * (own.motion[1] - before->motion[1])};
  if (squared_length(drift) > kDriftMax * kDriftMax * squared_length(own.motion)) return record;
  record.drift = drift;
  return record;
}

template <typename Real>
LayerRecordOf<Real> advanced(const LayerRecord& before) {
  LayerRecordOf<Real> record{.depth = before.depth, .is_thin = before.is_thin};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    record.drift[axis] = before.drift[axis];
    record.motion[axis] = Real(before.motion[axis]) + before.drift[axis];
    record.place[axis] = before.place[axis] - record.motion[axis];
  }
  return record;
}

template <typename Real>
LayerRecord turned_record(const LayerInputs& in, const RecordGrid& now, int before) {
  const RecordCell& cell = in.before.cells[static_cast<std::size_t>(before)];
  LayerRecord record = in.before.records[static_cast<std::size_t>(before)];
  if (!cell.has_record() || cell.age >= kRecordAgeMax || !record.is_thin) return record;
  const auto going = advanced<Real>(record);
  const LayerRecord* found = new_record_at<Real>(in, now, going);
  if (found == nullptr || !moves_otherwise(going, *found)) return record;
  if (cell.age > 0) {
    record.is_thin = false;
  } else {
    record.motion = found->motion;
    record.drift = {};
  }
  return record;
}

template <typename Real>
std::optional<int> advected_cell(const LayerInputs& in, int before) {
  const auto i = static_cast<std::size_t>(before);
  const RecordCell& cell = in.before.cells[i];
  if (!cell.has_record() || cell.age >= kRecordAgeMax || !in.before.records[i].is_thin) return {};
  const auto record = advanced<Real>(in.before.records[i]);
  const auto [columns, rows] = axes_of<Real>(in);
  const int x = floor_within(columns.coordinate(record.place[0]) + .5, -1, in.frame.width);
  const int y = floor_within(rows.coordinate(record.place[1]) + .5, -1, in.frame.height);
  if (x < 0 || y < 0 || x >= in.frame.width || y >= in.frame.height) return {};
  return static_cast<int>(index_of(in.frame.width, x, y));
}

std::vector<RecordCell> advect_records(const LayerInputs& in, std::vector<RecordCell> cells) {
  for (int i = 0; i < static_cast<int>(in.before.cells.size()); ++i) {
    const std::optional<int> to = advected_cell<double>(in, i);
    if (!to) continue;
    RecordCell& cell = cells[static_cast<std::size_t>(*to)];
    const int age = in.before.cells[static_cast<std::size_t>(i)].age + 1;
    // Those that come later are of later cells.
    if (!cell.has_record() || age < cell.age) cell = {.age = age, .origin = i};
  }
  return cells;
}

template SurfaceOf<double> surface_at(const LayerInputs&, int, int);
template SurfaceOf<Bounded> surface_at(const LayerInputs&, int, int);
template std::optional<LayerRecordOf<double>> layer_record(const LayerInputs&, int, int);
template std::optional<LayerRecordOf<Bounded>> layer_record(const LayerInputs&, int, int);
template LayerRecordOf<double> advanced(const LayerRecord&);
template LayerRecordOf<Bounded> advanced(const LayerRecord&);
template LayerRecord turned_record<double>(const LayerInputs&, const RecordGrid&, int);
template LayerRecord turned_record<Bounded>(const LayerInputs&, const RecordGrid&, int);
template std::optional<int> advected_cell<double>(const LayerInputs&, int);
template std::optional<int> advected_cell<Bounded>(const LayerInputs&, int);

}  // namespace quincunx::reference
