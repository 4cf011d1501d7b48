// SPDX-License-Identifier: MIT
// turn_records: what becomes of a record of the previous frame that is carried over, where the thing that it is of has
// stopped, started or turned about.
//   found      the new record nearest to the place of the record in this frame (`advanced`), of those in the 7 x 7
//              cells around that differ by no more than .03 of its depth from it; of two alike the first
//   turned     if |v - motion| > .25 px + |v| / 4, v: motion of what was found. If a sample showed the record in the
//              previous frame, its motion becomes v and its drift 0. Else it is not thin any more
// Source: found by measuring (docs/layers.md).
#include <algorithm>
#include <cstddef>

#include "layers.h"

namespace quincunx::reference {
namespace {

constexpr double kSteady = .25;  // pixels a frame, and part of a new motion: less is no sudden change
constexpr int kTurnReach = 3;    // cells
constexpr int kBeyond = 8;       // samples: no record that far outside the viewport is found

template <typename Real>
Real squared_length(const std::array<Real, 2>& a) {
  return a[0] * a[0] + a[1] * a[1];
}

// Null if there is none.
template <typename Real>
const LayerRecord* new_record_at(const LayerInputs& in, const RecordGrid& now,
                                 const LayerRecordOf<Real>& record) {
  const auto [columns, rows] = axes_of<Real>(in);
  const std::array<Real, 2> at = {clamp(columns.coordinate(record.place[0]), -kBeyond, 65536),
                                  clamp(rows.coordinate(record.place[1]), -kBeyond, 65536)};
  const int middle_x = floor_within(at[0] + .5, -kTurnReach - 1, in.frame.width + kTurnReach);
  const int middle_y = floor_within(at[1] + .5, -kTurnReach - 1, in.frame.height + kTurnReach);
  const LayerRecord* found = nullptr;
  Real least = 0;
  for (int y = std::max(middle_y - kTurnReach, 0); y <= std::min(middle_y + kTurnReach, in.frame.height - 1);
       ++y) {
    for (int x = std::max(middle_x - kTurnReach, 0); x <= std::min(middle_x + kTurnReach, in.frame.width - 1);
         ++x) {
      const std::size_t i = index_of(in.frame.width, x, y);
      if (!now.cells[i].has_record()) continue;
      const LayerRecord& other = now.records[i];
      if (abs(Real(other.depth) - record.depth) > kLayerGap * Real(record.depth)) continue;
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
  const Real most = kSteady + kSteady * sqrt(squared_length(motion));
  return squared_length<Real>({motion[0] - record.motion[0], motion[1] - record.motion[1]}) > most * most;
}

}  // namespace

template <typename Real>
LayerRecord turned_record(const LayerInputs& in, const RecordGrid& now, int before) {
  const RecordCell& cell = in.before.cells[static_cast<std::size_t>(before)];
  LayerRecord record = in.before.records[static_cast<std::size_t>(before)];
  if (!cell.has_record() || cell.age >= kOldestRecord || !record.is_thin) return record;
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

template LayerRecord turned_record<double>(const LayerInputs&, const RecordGrid&, int);
template LayerRecord turned_record<Bounded>(const LayerInputs&, const RecordGrid&, int);

}  // namespace quincunx::reference
