// SPDX-License-Identifier: MIT
// temporal_tiles, with one layer and with two, against its reference. How far a result may be off follows from
// running error analysis beside the reference; where a rounding may turn a decision nothing is compared.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "expected.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using reference::Bounded;
using testing::expect_near;
using testing::Pattern;
using testing::Rig;
using testing::StageInputs;
using testing::StageSpec;
using testing::StageVariant;
using testing::TemporalStages;

struct ExpectedTile {
  // With one layer the kernel finds the reprojection alone.
  reference::Expected<reference::LayeredTileOf<double>, reference::LayeredTileOf<Bounded>> tile;
  reference::Expected<reference::TileEvidence, reference::TileEvidenceOf<Bounded>> evidence;
};

ExpectedTile expected_tile(const reference::TemporalInputs& in, int x, int y) {
  const auto tile = reference::expected_of([&]<typename Real>(Real) {
    const auto reprojection = reference::reproject_tile<Real>(in, x, y);
    if (in.has_layers()) return reference::layer_tile(in, reprojection, x, y);
    return reference::LayeredTileOf<Real>{{}, reprojection};
  });
  const auto evidence = reference::expected_of([&]<typename Real>(Real) {
    if (tile.value.is_hidden) return reference::TileEvidenceOf<Real>{};
    if constexpr (std::is_same_v<Real, double>)
      return reference::judge_history(in, tile.value.reprojection, x, y);
    else
      return reference::judge_history(in, tile.bound.reprojection, x, y);
  });
  return {tile, evidence};
}

class TemporalTiles : public ::testing::TestWithParam<StageVariant> {
 protected:
  void compare_tile(const ExpectedTile& expected, const testing::KernelTile& actual,
                    const std::string& what) {
    ++compared_;
    if (expected.tile.undecided) return;
    const reference::TileReprojection& tile = expected.tile.value.reprojection;
    const auto& tile_bound = expected.tile.bound.reprojection;
    ASSERT_EQ(tile.is_rigid, actual.is_rigid != 0) << what;
    ASSERT_EQ(tile.is_trusted, actual.is_trusted != 0) << what;
    ASSERT_EQ(tile.has_motion_edge, actual.has_motion_edge != 0) << what;
    ASSERT_EQ(tile.step[0], actual.step_x) << what;
    ASSERT_EQ(tile.step[1], actual.step_y) << what;
    ASSERT_EQ(tile.source_phase[0], static_cast<double>(actual.source_phase_x)) << what;
    ASSERT_EQ(tile.source_phase[1], static_cast<double>(actual.source_phase_y)) << what;
    expect_near(tile.phase[0], tile_bound.phase[0], static_cast<double>(actual.phase_x), what + " phase_x");
    expect_near(tile.phase[1], tile_bound.phase[1], static_cast<double>(actual.phase_y), what + " phase_y");
    rigid_ += tile.is_rigid ? 1 : 0;
    trusted_ += tile.is_trusted ? 1 : 0;
    motion_edges_ += tile.has_motion_edge ? 1 : 0;
    rigid_motion_edges_ += tile.is_rigid && tile.has_motion_edge ? 1 : 0;
    const auto& [evidence, bound, undecided] = expected.evidence;
    if (undecided) return;
    ++decided_;
    ASSERT_EQ(evidence.brighter, static_cast<int>(actual.brighter)) << what;
    ASSERT_EQ(evidence.outliers, static_cast<int>(actual.outliers)) << what;
    outliers_ += evidence.outliers > 0 ? 1 : 0;
    expect_near(evidence.brightening, bound.brightening, static_cast<double>(actual.brightening),
                what + " brightening");
    expect_near(evidence.light, bound.light, static_cast<double>(actual.light), what + " light");
    expect_near(evidence.history_error, bound.history_error, static_cast<double>(actual.history_error),
                what + " history_error");
    expect_near(evidence.neighbour_error, bound.neighbour_error, static_cast<double>(actual.neighbour_error),
                what + " neighbour_error");
    expect_near(evidence.lag, bound.lag, static_cast<double>(actual.lag), what + " lag");
    expect_near(evidence.lit, bound.lit, static_cast<double>(actual.lit), what + " lit");
    for (std::size_t c = 0; c < 4; ++c) {
      const CellEvidence& cell = actual.TileEvidence::cells[c];
      ASSERT_EQ(evidence.cells[c].count, static_cast<int>(cell.count)) << what << " cell " << c;
      ASSERT_EQ(evidence.cells[c].brighter, static_cast<int>(cell.brighter)) << what << " cell " << c;
      expect_near(evidence.cells[c].brightening, bound.cells[c].brightening,
                  static_cast<double>(cell.brightening), what + " cell's brightening");
    }
  }

  static void expect_layered_ones_listed(const TemporalStages::Tiles& actual, const std::string& what) {
    std::vector<cl_int> layered, listed = actual.listed;
    for (std::size_t i = 0; i < actual.layers.size(); ++i) {
      if (actual.layers[i].is_layered != 0) layered.push_back(static_cast<cl_int>(i));
    }
    std::sort(listed.begin(), listed.end());
    ASSERT_EQ(layered, listed) << what;
  }

  void compare_layers(const ExpectedTile& expected, const LayerTile& actual, const std::string& what) {
    if (expected.tile.undecided) return;
    const reference::LayerTile& tile = expected.tile.value.layers;
    const auto& bound = expected.tile.bound.layers;
    ASSERT_EQ(tile.is_rigid, actual.is_rigid != 0) << what;
    ASSERT_EQ(tile.is_split, actual.is_split != 0) << what;
    ASSERT_EQ(tile.is_layered, actual.is_layered != 0) << what;
    expect_near(tile.phase[0], bound.phase[0], static_cast<double>(actual.phase_x), what + " near phase_x");
    expect_near(tile.phase[1], bound.phase[1], static_cast<double>(actual.phase_y), what + " near phase_y");
    expect_near(tile.between, bound.between, static_cast<double>(actual.between), what + " between");
    expect_near(tile.motion_range, bound.motion_range, static_cast<double>(actual.motion_range),
                what + " motion_range");
    split_ += tile.is_split ? 1 : 0;
    rigid_near_ += tile.is_rigid ? 1 : 0;
    layered_ += tile.is_layered ? 1 : 0;
    hidden_ += expected.tile.value.is_hidden ? 1 : 0;
    hidden_rigid_ += expected.tile.value.is_hidden && expected.tile.value.reprojection.is_rigid ? 1 : 0;
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t outliers_ = 0;
  std::int64_t rigid_ = 0;
  std::int64_t trusted_ = 0;
  std::int64_t motion_edges_ = 0;
  std::int64_t rigid_motion_edges_ = 0;
  std::int64_t split_ = 0;
  std::int64_t rigid_near_ = 0;
  std::int64_t layered_ = 0;
  std::int64_t hidden_ = 0;
  std::int64_t hidden_rigid_ = 0;
};

constexpr double kLeastChanged = .03;  // part of a tile's light: a larger error of history is a change
constexpr double kUsualLag = .005;     // part of a tile's light: a larger lag is not usual
constexpr double kLagMax = 4;

// How far the totals may be off.
struct Allowed {
  double sum = 0;
  int changed = 0;
  std::array<reference::LagTotalOf<double>, kLagParts> lags = {};
};

// Units of a tile's lag: the more tiles a part of the picture has, the larger.
double lag_units(const reference::TemporalInputs& in) {
  const int most = (in.tiles_x() / kLagColumns + 1) * (in.tiles_y() / kLagRows + 1);
  return std::min(static_cast<double>(kLagUnits), 0x1p30 / (kLagMax * most));
}

// Adds the lag of tile i to that of its part of the picture.
void add_lag(reference::TotalLight& total, Allowed& allowed, const ExpectedTile& expected,
             const reference::TemporalInputs& in, int i) {
  if (expected.evidence.value.count == 0) return;
  const int column = i % in.tiles_x() * kLagColumns / in.tiles_x(),
            row = i / in.tiles_x() * kLagRows / in.tiles_y();
  const auto part = static_cast<std::size_t>(row * kLagColumns + column);
  const double units = lag_units(in);
  const reference::Bounded count = expected.evidence.value.count;
  const reference::TileEvidenceOf<Bounded>& tile = expected.evidence.bound;
  const Bounded light = tile.lit + .02 * count;
  const Bounded lag = units * clamp(tile.lag / light, -kLagMax, kLagMax), lit = units * (tile.lit / light);
  const Bounded usual = units * clamp(tile.lag / light, -kUsualLag, kUsualLag);
  const bool is_usual = std::abs(lag.value) < kUsualLag * units;
  const bool may_be_either = std::abs(std::abs(lag.value) - kUsualLag * units) <= lag.error;
  reference::LagTotalOf<double>&sum = total.lags[part], &more = allowed.lags[part];
  sum.lag += lag.value;
  sum.lit += lit.value;
  sum.usual_lag += usual.value;
  sum.usual_lit += is_usual ? lit.value : 0;
  more.lag += 1 + lag.error;
  more.lit += 1 + lit.error;
  more.usual_lag += 1 + usual.error;
  more.usual_lit += 1 + lit.error + (may_be_either ? lit.value : 0);
}

// Each tile's part of a total is cut to an integer.
void add_tile(reference::TotalLight& total, Allowed& allowed, const ExpectedTile& expected) {
  const reference::TileEvidence& tile = expected.evidence.value;
  const auto& bound = expected.evidence.bound;
  const double units = static_cast<double>(kLightUnits) / std::max(tile.count, 1);
  total.light += tile.light * units;
  total.history_error += tile.history_error * units;
  total.neighbour_error += tile.neighbour_error * units;
  const bool is_changed = tile.history_error > kLeastChanged * tile.light;
  total.changed += is_changed ? 1 : 0;
  const double margin = bound.history_error.error + kLeastChanged * bound.light.error;
  if (std::abs(tile.history_error - kLeastChanged * tile.light) <= margin) ++allowed.changed;
  allowed.sum +=
      1 + 2 * units * std::max({bound.light.error, bound.history_error.error, bound.neighbour_error.error});
}

TEST_P(TemporalTiles, MatchTheReferenceAtEverySizeAndScale) {
  const TemporalStages stages(GetParam());
  int totals = 0;
  for (StageSpec spec : testing::all_stage_specs({Pattern::kNoise, Pattern::kNonFinite, Pattern::kImpulse})) {
    spec.parity = static_cast<int>(spec.seed % 3) - 1;
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto actual = stages.run_tiles(in);
    reference::TotalLight total;
    Allowed allowed;
    bool undecided = false;
    for (std::size_t i = 0; i < actual.tiles.size(); ++i) {
      const int tiles_x = in.reference.tiles_x();
      const ExpectedTile expected =
          expected_tile(in.reference, static_cast<int>(i) % tiles_x, static_cast<int>(i) / tiles_x);
      const std::string what = fmt::format("{}: tile {}", name_of(spec), i);
      compare_tile(expected, actual.tiles[i], what);
      if (GetParam().layers) compare_layers(expected, actual.layers[i], what);
      if (HasFatalFailure()) return;
      add_tile(total, allowed, expected);
      add_lag(total, allowed, expected, in.reference, static_cast<int>(i));
      undecided = undecided || expected.tile.undecided || expected.evidence.undecided;
    }
    expect_layered_ones_listed(actual, name_of(spec));
    if (HasFatalFailure()) return;
    if (undecided) continue;
    ++totals;
    ASSERT_NEAR(total.light, actual.total.light, allowed.sum) << name_of(spec);
    ASSERT_NEAR(total.history_error, actual.total.history_error, allowed.sum) << name_of(spec);
    ASSERT_NEAR(total.neighbour_error, actual.total.neighbour_error, allowed.sum) << name_of(spec);
    ASSERT_NEAR(total.changed, actual.total.changed, allowed.changed) << name_of(spec);
    for (std::size_t part = 0; part < total.lags.size(); ++part) {
      const reference::LagTotalOf<double>&sum = total.lags[part], &more = allowed.lags[part];
      const LagTotal& found = actual.total.lags[part];
      const std::string where = fmt::format("{}: part {}", name_of(spec), part);
      ASSERT_NEAR(sum.lag, found.lag, more.lag) << where;
      ASSERT_NEAR(sum.lit, found.lit, more.lit) << where;
      ASSERT_NEAR(sum.usual_lag, found.usual_lag, more.usual_lag) << where;
      ASSERT_NEAR(sum.usual_lit, found.usual_lit, more.usual_lit) << where;
    }
  }
  EXPECT_GE(decided_, compared_ * 3 / 4);
  if (GetParam().colour != PixelFormat::kRGBA8) {  // what has been tone mapped is never so bright
    EXPECT_GT(outliers_, compared_ / 256);
  }
  EXPECT_GE(rigid_, compared_ / 4);
  EXPECT_GE(trusted_, compared_ / 8);
  if (GetParam().moves) {
    EXPECT_GE(rigid_ - trusted_, compared_ / 32);
    EXPECT_GE(rigid_motion_edges_, compared_ / 64);
    EXPECT_GE(motion_edges_ - rigid_motion_edges_, compared_ / 32);
    EXPECT_GE(compared_ - motion_edges_, compared_ / 4);
  }
  if (GetParam().layers) {
    EXPECT_GE(split_, compared_ / 8);
    EXPECT_GE(compared_ - layered_, compared_ / 8);
    EXPECT_GE(rigid_near_, split_ / 8);
    EXPECT_GE(split_ - rigid_near_, split_ / 8);
    EXPECT_GE(layered_ - split_, compared_ / 64);
    EXPECT_GE(layered_ - hidden_, compared_ / 16);
    EXPECT_GE(hidden_rigid_, compared_ / 64);
    EXPECT_GE(hidden_ - hidden_rigid_, compared_ / 64);
  }
  EXPECT_GT(totals, 20);
}

// Where no frame had two layers, and this one has none, a plan with layers finds what one without does.
TEST_P(TemporalTiles, WithoutASplitSampleAreThoseOfOneLayer) {
  if (!GetParam().layers) return;
  StageVariant variant = GetParam();
  const TemporalStages layered(variant);
  variant.layers = false;
  const TemporalStages plain(variant);
  for (const StageSpec& spec : testing::all_stage_specs({Pattern::kNoise})) {
    Rig rig;
    StageInputs in = layered.inputs(rig, spec);
    std::fill(in.reference.splits.begin(), in.reference.splits.end(), reference::LayerSplit{});
    testing::store_reprojections(rig, spec, in, {});
    std::fill(in.reference.split_marks.begin(), in.reference.split_marks.end(), 0);
    std::fill(in.reference.layers_before.begin(), in.reference.layers_before.end(), reference::LayerTile{});
    const auto made = layered.run_tiles(in);
    EXPECT_EQ(testing::bytes_of(plain.run_tiles(in).tiles), testing::bytes_of(made.tiles)) << name_of(spec);
    for (const LayerTile& tile : made.layers)
      ASSERT_EQ(tile.is_split + tile.is_layered + tile.is_rigid, 0) << name_of(spec);
  }
}

TEST_P(TemporalTiles, PoisonOutsideTheViewportChangesNoBit) {
  if (!GetParam().layers) return;  // temporal_stages_test.cpp has the others
  const TemporalStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    StageSpec spec{
        .output = {64, 33}, .render = render, .previous = {render.height, render.width}, .seed = 5};
    Rig rig;
    const auto bytes = [&] {
      const auto made = stages.run_tiles(stages.inputs(rig, spec));
      auto all = testing::bytes_of(made.tiles);
      const auto layers = testing::bytes_of(made.layers);
      all.insert(all.end(), layers.begin(), layers.end());
      return all;
    };
    SCOPED_TRACE(name_of(spec));
    testing::expect_same_whatever_is_outside(spec, bytes);
  }
}

// Small, for a memory checker.
TEST_P(TemporalTiles, ATightFrameIsReadWithinItsEdges) {
  if (!GetParam().layers) return;  // temporal_stages_test.cpp has the others
  const TemporalStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{7, 3}}) {
    const StageSpec spec{.output = {13, 9},
                         .render = render,
                         .previous = {render.height, render.width},
                         .seed = 7,
                         .tight = true};
    Rig rig;
    EXPECT_EQ(stages.run_tiles(stages.inputs(rig, spec)).layers.size(), 4u);
  }
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{.layers = true},
          {.colour = kRGBA32F, .layers = true},
          {.colour = kRGBA8, .layers = true},
          {.history = kRGBA16F, .layers = true},
          {.storage = Storage::kImage, .layers = true},
          {},
          {.colour = kRGBA32F},
          {.colour = kRGBA8},
          {.storage = Storage::kImage, .colour = kRGBA8},
          {.history = kRGBA16F},
          {.storage = Storage::kImage},
          {.moves = false},
          {.storage = Storage::kImage, .moves = false}};
}

INSTANTIATE_TEST_SUITE_P(Variants, TemporalTiles, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(),
                                               [](const StageVariant& v) { return testing::name_of(v); }));

}  // namespace
}  // namespace quincunx
