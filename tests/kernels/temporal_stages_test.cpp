// SPDX-License-Identifier: MIT
// The kernels of the temporal upscaler, each on its own, against its reference. How far a result may be off
// follows from running error analysis beside the reference; where a rounding may turn a decision nothing is
// compared.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "error_table.h"
#include "expected.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using reference::Bounded;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::StageInputs;
using testing::StageSpec;
using testing::StageVariant;
using testing::TemporalStages;

constexpr double kScales[][2] = {{.33, .4}, {.5, .71}, {.71, .5}, {1, 1}, {1.37, .83}, {2, 1.9}};

std::string what_of(const StageSpec& spec) {
  return fmt::format("{}x{} -> {}x{}, {}, seed {}", spec.render.width, spec.render.height, spec.output.width,
                     spec.output.height, testing::name_of(spec.colour), spec.seed);
}

// One of all specs in many sizes and scales; the largest are few, as references are slow.
std::vector<StageSpec> all_specs(const std::vector<Pattern>& patterns) {
  std::vector<StageSpec> specs;
  unsigned seed = 0;
  for (const Extent output : {Extent{1, 1}, Extent{4, 4}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    for (const auto& scale : kScales) {
      for (const Pattern pattern : patterns) {
        ++seed;
        if (output.width == 257 && seed % 17 != 0) continue;
        const Extent render = testing::scaled(output, scale[0], scale[1]);
        specs.push_back({.output = output,
                         .render = render,
                         .previous = {render.width + 2, std::max(render.height - 1, 1)},
                         .colour = pattern,
                         .seed = seed});
      }
    }
  }
  return specs;
}

struct ExpectedTile {
  reference::Expected<reference::TileReprojection, reference::TileReprojectionOf<Bounded>> reprojection;
  reference::Expected<reference::TileEvidence, reference::TileEvidenceOf<Bounded>> evidence;
};

class Temporal : public ::testing::TestWithParam<StageVariant> {
 protected:
  void expect_near(double expected, const Bounded& bound, double actual, const std::string& what,
                   PixelFormat stored = PixelFormat::kRGBA32F) {
    // The bound is that of the same value: what it is taken through differs by roundings of doubles.
    ASSERT_NEAR(expected, bound.value, 1e-12 * std::max(1.0, std::abs(expected))) << what;
    const double allowed = bound.error + testing::output_rounding(stored, std::abs(expected) + bound.error);
    ASSERT_TRUE(std::isfinite(actual)) << what;
    ASSERT_NEAR(expected, actual, allowed) << what;
    testing::record_error({.error = std::abs(expected - actual),
                           .bound = allowed,
                           .largest = std::abs(expected),
                           .stored = stored});
  }

  // `reference`: what is expected of an output pixel, as for reference::expected_of.
  template <typename Reference>
  void compare(Reference reference, const std::vector<Pixel>& actual, Extent output, PixelFormat stored,
               const std::string& what) {
    const auto expected = testing::expected_pixels(output.width, output.height, reference);
    ASSERT_EQ(expected.size(), actual.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      ++compared_;
      if (expected[i].undecided) continue;
      ++decided_;
      for (std::size_t c = 0; c < 4; ++c) {
        expect_near(
            expected[i].value[c], expected[i].bound[c], actual[i][c],
            fmt::format("{}: pixel ({}, {}) channel {}", what, i % static_cast<std::size_t>(output.width),
                        i / static_cast<std::size_t>(output.width), c),
            stored);
        if (HasFatalFailure()) return;
      }
    }
  }

  void compare_resolve(const StageInputs& in, const std::vector<reference::Tile>& tiles,
                       const reference::TemporalOptions& options, const TemporalStages::Result& actual,
                       const StageSpec& spec) {
    const auto reference = [&]<typename Real>(Real, int x, int y) {
      return reference::resolve_temporal<Real>(in.reference, tiles, options, x, y).texel;
    };
    compare(reference, actual.pixels, spec.output, GetParam().history, what_of(spec));
    if (HasFatalFailure() || !GetParam().alpha) return;
    const auto alpha = [&]<typename Real>(Real, int x, int y) {
      const Real value = reference::resolve_temporal<Real>(in.reference, tiles, options, x, y).alpha;
      return reference::PixelOf<Real>{value, value, value, value};
    };
    std::vector<Pixel> alphas;
    for (const double value : actual.alpha)
      alphas.push_back({value, value, value, value});
    compare(alpha, alphas, spec.output, GetParam().history, what_of(spec) + ", alpha");
  }

  static ExpectedTile expected_tile(const reference::TemporalInputs& in, int x, int y) {
    const auto reprojection = reference::expected_of(
        [&]<typename Real>(Real) { return reference::reproject_tile<Real>(in, x, y); });
    const auto evidence = reference::expected_of([&]<typename Real>(Real) {
      if constexpr (std::is_same_v<Real, double>)
        return reference::judge_history(in, reprojection.value, x, y);
      else
        return reference::judge_history(in, reprojection.bound, x, y);
    });
    return {reprojection, evidence};
  }

  void compare_tile(const ExpectedTile& expected, const testing::KernelTile& actual,
                    const std::string& what) {
    ++compared_;
    const auto& [tile, tile_bound, tile_undecided] = expected.reprojection;
    if (tile_undecided) return;
    ASSERT_EQ(tile.is_rigid, actual.is_rigid != 0) << what;
    ASSERT_EQ(tile.is_copyable, actual.is_copyable != 0) << what;
    ASSERT_EQ(tile.has_motion_edge, actual.has_motion_edge != 0) << what;
    ASSERT_EQ(tile.step[0], actual.step_x) << what;
    ASSERT_EQ(tile.step[1], actual.step_y) << what;
    ASSERT_EQ(tile.source_phase[0], static_cast<double>(actual.source_phase_x)) << what;
    ASSERT_EQ(tile.source_phase[1], static_cast<double>(actual.source_phase_y)) << what;
    expect_near(tile.phase[0], tile_bound.phase[0], static_cast<double>(actual.phase_x), what + " phase_x");
    expect_near(tile.phase[1], tile_bound.phase[1], static_cast<double>(actual.phase_y), what + " phase_y");
    rigid_ += tile.is_rigid ? 1 : 0;
    copyable_ += tile.is_copyable ? 1 : 0;
    motion_edges_ += tile.has_motion_edge ? 1 : 0;
    rigid_motion_edges_ += tile.is_rigid && tile.has_motion_edge ? 1 : 0;
    const auto& [evidence, bound, undecided] = expected.evidence;
    if (undecided) return;
    ++decided_;
    ASSERT_EQ(evidence.brighter, static_cast<int>(actual.brighter)) << what;
    expect_near(evidence.brightening, bound.brightening, static_cast<double>(actual.brightening),
                what + " brightening");
    expect_near(evidence.light, bound.light, static_cast<double>(actual.light), what + " light");
    expect_near(evidence.history_error, bound.history_error, static_cast<double>(actual.history_error),
                what + " history_error");
    expect_near(evidence.neighbour_error, bound.neighbour_error, static_cast<double>(actual.neighbour_error),
                what + " neighbour_error");
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t rigid_ = 0;
  std::int64_t copyable_ = 0;
  std::int64_t motion_edges_ = 0;
  std::int64_t rigid_motion_edges_ = 0;
};

// Each tile's part of a total is cut to an integer.
void add_tile(reference::TotalLight& total, double& allowed, const ExpectedTile& expected) {
  const reference::TileEvidence& tile = expected.evidence.value;
  const auto& bound = expected.evidence.bound;
  const double units = static_cast<double>(kLightUnits) / std::max(tile.count, 1);
  total.brightening += tile.brightening * units;
  total.change += std::abs(tile.brightening) * units;
  total.light += tile.light * units;
  total.history_error += tile.history_error * units;
  total.neighbour_error += tile.neighbour_error * units;
  allowed += 1 + 2 * units *
                     std::max({bound.brightening.error, bound.light.error, bound.history_error.error,
                               bound.neighbour_error.error});
}

TEST_P(Temporal, TilesMatchTheReferenceAtEverySizeAndScale) {
  const TemporalStages stages(GetParam());
  int totals = 0;
  for (const StageSpec& spec : all_specs({Pattern::kNoise, Pattern::kNonFinite, Pattern::kImpulse})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto actual = stages.run_tiles(in);
    reference::TotalLight total;
    double allowed = 0;
    bool undecided = false;
    for (std::size_t i = 0; i < actual.tiles.size(); ++i) {
      const int tiles_x = in.reference.tiles_x();
      const ExpectedTile expected =
          expected_tile(in.reference, static_cast<int>(i) % tiles_x, static_cast<int>(i) / tiles_x);
      compare_tile(expected, actual.tiles[i], fmt::format("{}: tile {}", what_of(spec), i));
      if (HasFatalFailure()) return;
      add_tile(total, allowed, expected);
      undecided = undecided || expected.reprojection.undecided || expected.evidence.undecided;
    }
    if (undecided) continue;
    ++totals;
    ASSERT_NEAR(total.brightening, actual.total.brightening, allowed) << what_of(spec);
    ASSERT_NEAR(total.change, actual.total.change, allowed) << what_of(spec);
    ASSERT_NEAR(total.light, actual.total.light, allowed) << what_of(spec);
    ASSERT_NEAR(total.history_error, actual.total.history_error, allowed) << what_of(spec);
    ASSERT_NEAR(total.neighbour_error, actual.total.neighbour_error, allowed) << what_of(spec);
  }
  EXPECT_GE(decided_, compared_ * 3 / 4);
  EXPECT_GE(rigid_, compared_ / 4);
  EXPECT_GE(copyable_, compared_ / 8);
  if (GetParam().moves) {
    EXPECT_GE(rigid_ - copyable_, compared_ / 32);
    EXPECT_GE(rigid_motion_edges_, compared_ / 64);
    EXPECT_GE(motion_edges_ - rigid_motion_edges_, compared_ / 32);
    EXPECT_GE(compared_ - motion_edges_, compared_ / 4);
  }
  EXPECT_GT(totals, 20);
}

TEST_P(Temporal, ResolveMatchesTheReferenceAtEverySizeScaleAndInput) {
  const TemporalStages stages(GetParam());
  for (const StageSpec& spec : all_specs(testing::all_patterns())) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto tiles = stages.tiles(in, spec.seed);
    const auto actual = stages.run_resolve(rig, in, tiles);
    compare_resolve(in, tiles, {}, actual, spec);
    if (HasFatalFailure()) return;
  }
  // Where a motion is whole pixels a rounding decides between which texels history is read.
  EXPECT_GE(decided_, compared_ * 3 / 4);
}

// What is copied without a look at each sample's reprojection is what a look at them gives.
TEST_P(Temporal, CopyableTilesGiveTheSameBits) {
  if (!GetParam().moves) return;  // all are
  const TemporalStages stages(GetParam());
  for (const StageSpec& spec : all_specs({Pattern::kNoise})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    auto tiles = stages.tiles(in, spec.seed);
    const auto copied = stages.run_resolve(rig, in, tiles);
    for (reference::Tile& tile : tiles)
      tile.reprojection.is_copyable = false;
    EXPECT_EQ(copied.bytes, stages.run_resolve(rig, in, tiles).bytes) << what_of(spec);
  }
}

// What the presets change.
TEST_P(Temporal, BilinearHistoryAndTrustMatchToo) {
  const TemporalStages stages(GetParam());
  if (!GetParam().moves) return;  // they change nothing
  for (const TemporalPreset preset : {TemporalPreset::kFast, TemporalPreset::kQuality}) {
    const bool fast = preset == TemporalPreset::kFast;
    const reference::TemporalOptions options{fast ? 4 : 16, !fast};
    for (const StageSpec& spec : all_specs({Pattern::kNoise})) {
      Rig rig;
      const StageInputs in = stages.inputs(rig, spec);
      const auto tiles = stages.tiles(in, spec.seed);
      const auto actual = stages.run_resolve(rig, in, tiles, preset);
      compare_resolve(in, tiles, options, actual, spec);
      if (HasFatalFailure()) return;
    }
  }
  // Where a motion is whole pixels a rounding decides between which texels history is read.
  EXPECT_GE(decided_, compared_ * 3 / 4);
}

TEST_P(Temporal, PoisonOutsideTheViewportChangesNoBit) {
  const TemporalStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    StageSpec spec{
        .output = {64, 33}, .render = render, .previous = {render.height, render.width}, .seed = 5};
    Rig rig;
    const auto bytes = [&] {
      const StageInputs in = stages.inputs(rig, spec);
      auto all = stages.run_resolve(rig, in, stages.tiles(in, 1)).bytes;
      const auto tiles = testing::bytes_of(stages.run_tiles(in).tiles);
      const auto shown = stages.run_display(rig, in, in.reference.before, {}).bytes;
      all.insert(all.end(), tiles.begin(), tiles.end());
      all.insert(all.end(), shown.begin(), shown.end());
      return all;
    };
    const auto clean = bytes();
    for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
      spec.outside = poison;
      EXPECT_EQ(clean, bytes()) << render.width << "x" << render.height << ", poison " << poison;
    }
    spec.outside = 0;
    spec.tight = true;
    EXPECT_EQ(clean, bytes()) << render.width << "x" << render.height << ", tight";
    EXPECT_EQ(clean, bytes()) << "twice";
  }
}

// Small, for a memory checker.
TEST_P(Temporal, ATightFrameIsReadWithinItsEdges) {
  const TemporalStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{7, 3}}) {
    const StageSpec spec{.output = {13, 9},
                         .render = render,
                         .previous = {render.height, render.width},
                         .seed = 7,
                         .tight = true};
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto made = stages.run_tiles(in);
    EXPECT_EQ(made.tiles.size(), 4u);
    for (const Pixel& pixel : stages.run_resolve(rig, in, stages.tiles(in, 1)).pixels) {
      for (const double value : pixel)
        EXPECT_TRUE(std::isfinite(value));
    }
    for (const Pixel& pixel : stages.run_display(rig, in, in.reference.before, {}).pixels) {
      for (const double value : pixel)
        EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST_P(Temporal, DisplayMatchesTheReference) {
  const StageVariant& v = GetParam();
  const TemporalStages stages(v);
  for (const StageSpec& spec : all_specs({Pattern::kNoise})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    using Shown = TemporalStages::Shown;
    for (const Shown& shown : {Shown{}, {TemporalPreset::kFast}, {.first = true}}) {
      const reference::DisplayOptions options{shown.preset != TemporalPreset::kFast && !shown.first};
      const auto actual = stages.run_display(rig, in, in.reference.before, shown);
      const auto reference = [&]<typename Real>(Real, int x, int y) {
        return reference::temporal_display<Real>(in.reference, in.reference.before, options, x, y);
      };
      compare(reference, actual.pixels, spec.output, v.resolved, what_of(spec));
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(decided_, compared_);
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{},
          {.colour = kRGBA32F},
          {.history = kRGBA16F, .resolved = kRGBA16F},
          {.storage = Storage::kImage},
          {.alpha = true},
          {.history = kRGBA16F, .moves = false, .reactive = true, .alpha = true},
          {.moves = false},
          {.moves = false, .reactive = true},
          {.storage = Storage::kImage, .moves = false, .reactive = true}};
}

INSTANTIATE_TEST_SUITE_P(Variants, Temporal, ::testing::ValuesIn(variants()),
                         [](const auto& instance) { return testing::name_of(instance.param); });

}  // namespace
}  // namespace quincunx
