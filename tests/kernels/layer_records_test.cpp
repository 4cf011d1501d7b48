// SPDX-License-Identifier: MIT
// layer_records, turn_records and advect_records: the records of near surfaces against their references.
#include <cmath>
#include <set>
#include <tuple>

#include "expected.h"
#include "layer_frames.h"

namespace quincunx {
namespace {

using reference::Bounded;
using testing::expect_near;
using testing::KernelGrid;
using testing::LayerFrames;
using testing::LayerSpec;
using testing::LayerVariant;
using testing::RecordStages;
using testing::Rig;
using testing::Surfaces;

class LayerRecords : public ::testing::TestWithParam<LayerVariant> {
 protected:
  template <typename Expected>
  void compare_record(const Expected& expected, const LayerRecord& actual, const std::string& what) {
    const auto& value = *expected.value;
    const auto& bound = *expected.bound;
    expect_near(value.place[0], bound.place[0], static_cast<double>(actual.x), what + " x");
    expect_near(value.place[1], bound.place[1], static_cast<double>(actual.y), what + " y");
    ASSERT_EQ(value.depth, static_cast<double>(actual.depth)) << what;
    expect_near(value.motion[0], bound.motion[0], static_cast<double>(actual.motion_x), what + " motion x");
    expect_near(value.motion[1], bound.motion[1], static_cast<double>(actual.motion_y), what + " motion y");
    expect_near(value.drift[0], bound.drift[0], static_cast<double>(actual.drift_x), what + " drift x");
    expect_near(value.drift[1], bound.drift[1], static_cast<double>(actual.drift_y), what + " drift y");
    ASSERT_EQ(value.is_thin, actual.is_thin != 0) << what;
    thin_ += value.is_thin ? 1 : 0;
    drifting_ += value.drift != std::array<double, 2>{} ? 1 : 0;
  }

  void compare_records(const LayerFrames& in, const LayerSpec& spec, const KernelGrid& actual) {
    const auto expected = testing::expected_pixels(
        spec.render.width, spec.render.height,
        [&]<typename Real>(Real, int x, int y) { return reference::layer_record<Real>(in.reference, x, y); });
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ++compared_;
      if (expected[i].undecided) continue;
      ++decided_;
      const std::string what = name_of(spec) + ": sample " + std::to_string(i);
      const bool is_near = expected[i].value.has_value();
      ASSERT_EQ(testing::to_key({.age = is_near ? 0 : -1, .origin = static_cast<int>(i)}), actual.keys[i])
          << what;
      near_ += is_near ? 1 : 0;
      if (is_near) compare_record(expected[i], actual.records[i], what);
      if (HasFatalFailure()) return;
    }
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t near_ = 0;
  std::int64_t thin_ = 0;
  std::int64_t drifting_ = 0;
};

TEST_P(LayerRecords, MatchTheReference) {
  RecordStages stages(GetParam());
  for (const LayerSpec& spec : testing::all_layer_specs()) {
    Rig rig;
    const LayerFrames in = stages.frames(rig, spec);
    compare_records(in, spec, stages.find_records(rig, in, spec));
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(decided_, compared_ * 99 / 100);
  EXPECT_GE(near_, compared_ / 8);
  EXPECT_GE(thin_, near_ / 4);
  EXPECT_GE(near_ - thin_, near_ / 64);
  EXPECT_GE(drifting_, near_ / 64);
}

// Things that have turned take their records with them, and end those whose place is not known any more.
TEST_P(LayerRecords, MatchTheReferenceWhereThingsTurn) {
  RecordStages stages(GetParam());
  std::int64_t carried = 0, decided = 0, turned = 0, ended = 0;
  for (const LayerSpec& spec : testing::all_layer_specs()) {
    Rig rig;
    const LayerFrames in = stages.frames(rig, spec);
    const KernelGrid found = stages.find_records(rig, in, spec);
    const reference::RecordGrid now = to_reference(found);
    const auto actual = stages.turn_records(rig, in, spec, found).reference.before.records;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const auto expected = reference::expected_of([&]<typename Real>(Real) {
        return reference::turned_record<Real>(in.reference, now, static_cast<int>(i));
      });
      const reference::LayerRecord& before = in.reference.before.records[i];
      const bool is_carried = before.is_thin && in.reference.before.cells[i].has_record();
      carried += is_carried ? 1 : 0;
      if (expected.undecided) continue;
      decided += is_carried ? 1 : 0;
      const reference::LayerRecord& value = expected.value;
      const std::string what = name_of(spec) + ": record " + std::to_string(i);
      ASSERT_EQ(value.place, actual[i].place) << what;
      ASSERT_EQ(value.depth, actual[i].depth) << what;
      ASSERT_EQ(value.motion, actual[i].motion) << what;
      ASSERT_EQ(value.drift, actual[i].drift) << what;
      ASSERT_EQ(value.is_thin, actual[i].is_thin) << what;
      turned += value.motion != before.motion ? 1 : 0;
      ended += value.is_thin != before.is_thin ? 1 : 0;
    }
  }
  EXPECT_GE(decided, carried * 99 / 100);
  EXPECT_GE(turned, carried / 64);
  EXPECT_GE(ended, carried / 128);
}

// The cells to which a rounding may bring a record.
std::set<std::size_t> undecided_cells(const LayerFrames& in) {
  const reference::LayerInputs& r = in.reference;
  std::set<std::size_t> cells;
  for (int i = 0; i < static_cast<int>(r.before.cells.size()); ++i) {
    const auto expected =
        reference::expected_of([&]<typename Real>(Real) { return reference::advected_cell<Real>(r, i); });
    if (!expected.undecided) continue;
    const auto record = reference::advanced<double>(r.before.records[static_cast<std::size_t>(i)]);
    const auto axes = reference::axes_of<double>(r);
    const int x = static_cast<int>(std::floor(axes[0].coordinate(record.place[0]) + .5));
    const int y = static_cast<int>(std::floor(axes[1].coordinate(record.place[1]) + .5));
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, r.frame.height - 1); ++row) {
      for (int column = std::max(x - 1, 0); column <= std::min(x + 1, r.frame.width - 1); ++column)
        cells.insert(reference::index_of(r.frame.width, column, row));
    }
  }
  return cells;
}

TEST_P(LayerRecords, ThinOnesAreCarriedOverAsTheReferenceDoes) {
  RecordStages stages(GetParam());
  std::int64_t undecided = 0, carried = 0, contested = 0, old = 0;
  for (const LayerSpec& spec : testing::all_layer_specs()) {
    Rig rig;
    LayerFrames in = stages.frames(rig, spec);
    const KernelGrid alone = stages.find_records(rig, in, spec);
    in = stages.turn_records(rig, in, spec, alone);
    const KernelGrid all = stages.advect_records(rig, in, spec, alone);
    const auto found = to_reference(alone).cells;
    const auto expected = reference::advect_records(in.reference, found);
    const std::set<std::size_t> open = undecided_cells(in);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ++compared_;
      if (open.contains(i)) {
        ++undecided;
        continue;
      }
      ASSERT_EQ(testing::to_key(expected[i]), all.keys[i]) << name_of(spec) << ": cell " << i;
      if (found[i].has_record()) {
        ASSERT_EQ(expected[i].age, 0) << "a new record keeps its cell";
      }
      carried += expected[i].age > 0 ? 1 : 0;
      old += expected[i].age == 8 ? 1 : 0;
    }
    // How many want the same cell.
    std::set<int> seen;
    for (int i = 0; i < static_cast<int>(in.before.keys.size()); ++i) {
      const auto cell = reference::advected_cell<double>(in.reference, i);
      if (cell && !seen.insert(*cell).second) ++contested;
    }
  }
  EXPECT_LE(undecided, compared_ / 100);
  EXPECT_GE(carried, compared_ / 40);
  EXPECT_GE(contested, compared_ / 200);
  EXPECT_GE(old, carried / 64);
}

// Motion edges tell where to look: without any nothing is near.
TEST_P(LayerRecords, AreSoughtAtMotionEdgesOnly) {
  RecordStages stages(GetParam());
  const LayerSpec spec{.output = {64, 40}, .render = {45, 23}, .previous = {45, 23}, .seed = 3};
  Rig rig;
  LayerFrames in = stages.frames(rig, spec);
  for (float& trust : in.open_trust)
    trust = std::abs(trust);
  for (const cl_uint key : stages.find_records(rig, in, spec).keys)
    EXPECT_EQ(key, 0u);
}

TEST_P(LayerRecords, PoisonOutsideTheViewportChangesNoBit) {
  RecordStages stages(GetParam());
  for (const Surfaces surfaces : {Surfaces::kWires, Surfaces::kNonFinite}) {
    for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
      LayerSpec spec{.output = {64, 33}, .render = render, .previous = {render.height, render.width}};
      spec.surfaces = surfaces;
      spec.seed = 5;
      Rig rig;
      const auto run = [&] {
        LayerFrames in = stages.frames(rig, spec);
        KernelGrid grid = stages.run_records(rig, in, spec);
        return std::tuple(grid.keys, testing::bytes_of(grid.records), testing::bytes_of(in.before.records));
      };
      SCOPED_TRACE(name_of(spec));
      testing::expect_same_whatever_is_outside(spec, run);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, LayerRecords, ::testing::ValuesIn(testing::layer_variants()),
                         testing::layer_variant_names);

}  // namespace
}  // namespace quincunx
