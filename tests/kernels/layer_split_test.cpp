// SPDX-License-Identifier: MIT
// layer_split: which samples have two layers, against its reference.
#include <algorithm>
#include <cmath>

#include "expected.h"
#include "layer_frames.h"

namespace quincunx {
namespace {

using testing::expect_near;
using testing::KernelGrid;
using testing::LayerFrames;
using testing::LayerSpec;
using testing::LayerVariant;
using testing::Pixel;
using testing::RecordStages;
using testing::Rig;
using testing::Surfaces;

class LayerSplits : public ::testing::TestWithParam<LayerVariant> {};

TEST_P(LayerSplits, MatchTheReference) {
  RecordStages stages(GetParam());
  std::int64_t compared = 0, decided = 0, split = 0, by_old = 0, far = 0, begun = 0;
  for (const LayerSpec& spec : testing::all_layer_specs()) {
    Rig rig;
    LayerFrames in = stages.frames(rig, spec);
    const KernelGrid now = stages.run_records(rig, in, spec);
    const reference::RecordGrid grid = to_reference(now);
    const RecordStages::Split actual = stages.run_split(rig, in, spec, now);
    const auto expected = testing::expected_pixels(
        spec.render.width, spec.render.height, [&]<typename Real>(Real, int x, int y) {
          return reference::layer_split<Real>(in.reference, grid, x, y);
        });
    std::vector<int> marks(actual.marks.size());
    bool marks_decided = true;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto& [value, bound, undecided] = expected[i];
      const std::string what = name_of(spec) + ": sample " + std::to_string(i);
      ++compared;
      marks_decided = marks_decided && !undecided;
      if (undecided) continue;
      ++decided;
      const float trust = std::abs(in.open_trust[i]);
      const auto mixed = static_cast<float>(reference::kMixedTrustMax);
      ASSERT_EQ(value.has_begun ? std::min(trust, mixed) : in.open_trust[i], actual.open_trust[i]) << what;
      begun += value.has_begun && trust > mixed ? 1 : 0;
      if (!value.split.is_split()) {
        ASSERT_EQ(in.reprojection[i], actual.reprojection[i]) << what;
        continue;
      }
      ++split;
      const LayerSplit& made = actual.splits[i];
      ASSERT_EQ(value.split.near_depth, static_cast<double>(made.near_depth)) << what;
      ASSERT_EQ(value.split.far_depth, static_cast<double>(made.far_depth)) << what;
      expect_near(value.split.motion[0], bound.split.motion[0], static_cast<double>(made.motion_x), what);
      expect_near(value.split.motion[1], bound.split.motion[1], static_cast<double>(made.motion_y), what);
      marks[static_cast<std::size_t>(value.tile)] = 1;
      expect_near(value.far_motion[0], bound.far_motion[0], actual.reprojection[i][0],
                  what + " far motion x");
      expect_near(value.far_motion[1], bound.far_motion[1], actual.reprojection[i][1],
                  what + " far motion y");
      ASSERT_EQ(static_cast<double>(trust), actual.reprojection[i][2]) << what;
      ASSERT_TRUE(actual.reprojection[i][3] == 0 && std::signbit(actual.reprojection[i][3])) << what;
      by_old += now.keys[i] == 0 || grid.cells[i].age > 0 ? 1 : 0;
      far += in.reference.frame.depth[i] < .5 * (value.split.near_depth + value.split.far_depth) ? 1 : 0;
      if (HasFatalFailure()) return;
    }
    for (std::size_t i = 0; i < marks.size() && marks_decided; ++i)
      ASSERT_EQ(marks[i] != 0, actual.marks[i] != 0) << name_of(spec) << ": tile " << i;
  }
  EXPECT_GE(decided, compared * 99 / 100);
  EXPECT_GE(split, compared / 8);
  EXPECT_GE(compared - split, compared / 8);
  EXPECT_GE(by_old, split / 64);
  EXPECT_GE(begun, split / 64);
  EXPECT_GE(far, split / 8);
  EXPECT_GE(split - far, split / 8);
}

// Records from the previous frame stand among this frame's records afterwards.
TEST_P(LayerSplits, CarriedRecordsJoinThisFrames) {
  RecordStages stages(GetParam());
  std::int64_t carried = 0;
  for (const LayerSpec& spec : testing::all_layer_specs()) {
    Rig rig;
    LayerFrames in = stages.frames(rig, spec);
    const KernelGrid now = stages.run_records(rig, in, spec);
    const reference::RecordGrid grid = to_reference(now);
    const auto records = stages.run_split(rig, in, spec, now).records;
    for (std::size_t i = 0; i < records.size(); ++i) {
      const std::string what = name_of(spec) + ": cell " + std::to_string(i);
      if (grid.cells[i].age <= 0) {
        ASSERT_EQ(std::memcmp(&records[i], &now.records[i], sizeof(LayerRecord)), 0) << what;
        continue;
      }
      ++carried;
      const auto& before = in.reference.before.records[static_cast<std::size_t>(grid.cells[i].origin)];
      const auto expected =
          reference::expected_of([&]<typename Real>(Real) { return reference::advanced<Real>(before); });
      const auto& [value, bound, undecided] = expected;
      ASSERT_FALSE(undecided);
      expect_near(value.place[0], bound.place[0], static_cast<double>(records[i].x), what + " x");
      expect_near(value.place[1], bound.place[1], static_cast<double>(records[i].y), what + " y");
      expect_near(value.motion[0], bound.motion[0], static_cast<double>(records[i].motion_x), what);
      expect_near(value.motion[1], bound.motion[1], static_cast<double>(records[i].motion_y), what);
      ASSERT_EQ(value.drift[0], static_cast<double>(records[i].drift_x)) << what;
      ASSERT_EQ(value.drift[1], static_cast<double>(records[i].drift_y)) << what;
      ASSERT_EQ(value.depth, static_cast<double>(records[i].depth)) << what;
      ASSERT_EQ(records[i].is_thin, 1) << what;
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(carried, 1000);
}

// A wire that all samples miss keeps its layer for eight frames. What is thick is gone at once.
TEST_P(LayerSplits, WiresOutliveTheirSamplesByEightFrames) {
  RecordStages stages(GetParam());
  LayerSpec spec{.output = {129, 77}, .render = {65, 39}, .previous = {65, 39}, .seed = 9, .first = true};
  Rig rig;
  LayerFrames in = stages.frames(rig, spec);
  KernelGrid grid = stages.run_records(rig, in, spec);
  ASSERT_GT(std::count_if(grid.keys.begin(), grid.keys.end(), [](cl_uint key) { return key != 0; }), 100);
  spec.surfaces = Surfaces::kWall;
  for (int age = 1; age <= 9; ++age) {
    in = stages.frames(rig, spec);
    in.before = grid;
    in.reference.before = to_reference(grid);
    grid = stages.run_records(rig, in, spec);
    const auto split = stages.run_split(rig, in, spec, grid);
    grid.records = split.records;
    const reference::RecordGrid now = to_reference(grid);
    int alive = 0, parted = 0;
    for (std::size_t i = 0; i < now.cells.size(); ++i) {
      parted += split.splits[i].near_depth > 0 ? 1 : 0;
      if (!now.cells[i].has_record()) continue;
      ++alive;
      EXPECT_EQ(now.cells[i].age, age);
      EXPECT_TRUE(now.records[i].is_thin);
      // It lies in its cell.
      const auto axes = reference::axes_of<double>(in.reference);
      const int x = static_cast<int>(i) % spec.render.width, y = static_cast<int>(i) / spec.render.width;
      EXPECT_NEAR(axes[0].coordinate(now.records[i].place[0]), x, .5001);
      EXPECT_NEAR(axes[1].coordinate(now.records[i].place[1]), y, .5001);
    }
    EXPECT_EQ(alive > 50, age <= 8) << "age " << age;
    EXPECT_EQ(parted > alive, age <= 8) << "age " << age;
    if (age > 8) {
      EXPECT_EQ(alive + parted, 0);
    }
  }
}

TEST_P(LayerSplits, PoisonOutsideTheViewportChangesNoBit) {
  RecordStages stages(GetParam());
  for (const Surfaces surfaces : {Surfaces::kWires, Surfaces::kNonFinite}) {
    for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
      LayerSpec spec{.output = {64, 33}, .render = render, .previous = {render.height, render.width}};
      spec.surfaces = surfaces;
      spec.seed = 6;
      Rig rig;
      const auto run = [&] {
        LayerFrames in = stages.frames(rig, spec);
        const KernelGrid now = stages.run_records(rig, in, spec);
        return stages.run_split(rig, in, spec, now).bytes;
      };
      SCOPED_TRACE(name_of(spec));
      testing::expect_same_whatever_is_outside(spec, run);
    }
  }
}

// Small, for a memory checker.
TEST_P(LayerSplits, ATightFrameIsReadWithinItsEdges) {
  RecordStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{9, 3}}) {
    LayerSpec spec{.output = {17, 9}, .render = render, .previous = {render.height, render.width}};
    spec.surfaces = Surfaces::kNoise;
    spec.tight = true;
    Rig rig;
    LayerFrames in = stages.frames(rig, spec);
    const KernelGrid now = stages.run_records(rig, in, spec);
    const auto split = stages.run_split(rig, in, spec, now);
    EXPECT_EQ(split.marks.size(), 6u);
    for (const LayerSplit& sample : split.splits)
      EXPECT_TRUE(std::isfinite(sample.motion_x) && std::isfinite(sample.motion_y));
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, LayerSplits, ::testing::ValuesIn(testing::layer_variants()),
                         testing::layer_variant_names);

}  // namespace
}  // namespace quincunx
