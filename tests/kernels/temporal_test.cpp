// SPDX-License-Identifier: MIT
// The kernels of the temporal upscaler, each on its own, against its reference. How far a result may be off
// follows from running error analysis in the reference; where a rounding turns a decision it says so, and
// nothing is compared.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "error_table.h"
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

class Temporal : public ::testing::TestWithParam<StageVariant> {
 protected:
  void expect_near(const Bounded& expected, double actual, const std::string& what,
                   PixelFormat stored = PixelFormat::kRGBA32F) {
    const double allowed =
        expected.error + testing::output_rounding(stored, std::abs(expected.value) + expected.error);
    ASSERT_TRUE(std::isfinite(actual)) << what;
    ASSERT_NEAR(expected.value, actual, allowed) << what;
    testing::record_error({.error = std::abs(expected.value - actual),
                           .bound = allowed,
                           .largest = std::abs(expected.value),
                           .stored = stored});
  }

  void compare(const std::vector<reference::HistoryTexel>& expected, const std::vector<Pixel>& actual,
               int width, PixelFormat stored, const std::string& what) {
    ASSERT_EQ(expected.size(), actual.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      ++compared_;
      if (expected[i].undecided) continue;
      ++decided_;
      for (std::size_t c = 0; c < 4; ++c) {
        expect_near(expected[i].value[c], actual[i][c],
                    fmt::format("{}: pixel ({}, {}) channel {}", what, i % static_cast<std::size_t>(width),
                                i / static_cast<std::size_t>(width), c),
                    stored);
        if (HasFatalFailure()) return;
      }
    }
  }

  void compare_tile(const reference::Tile& expected, const testing::KernelTile& actual,
                    const std::string& what) {
    ++compared_;
    if (expected.undecided) return;
    ASSERT_EQ(expected.rigid, actual.is_rigid != 0) << what;
    ASSERT_EQ(expected.plain, actual.is_copyable != 0) << what;
    ASSERT_EQ(expected.torn, actual.has_motion_edge != 0) << what;
    ASSERT_EQ(expected.step[0], actual.step_x) << what;
    ASSERT_EQ(expected.step[1], actual.step_y) << what;
    ASSERT_EQ(expected.source[0], static_cast<double>(actual.source_phase_x)) << what;
    ASSERT_EQ(expected.source[1], static_cast<double>(actual.source_phase_y)) << what;
    expect_near(expected.offset[0], static_cast<double>(actual.phase_x), what + " offset_x");
    expect_near(expected.offset[1], static_cast<double>(actual.phase_y), what + " offset_y");
    rigid_ += expected.rigid ? 1 : 0;
    plain_ += expected.plain ? 1 : 0;
    torn_ += expected.torn ? 1 : 0;
    rigid_and_torn_ += expected.rigid && expected.torn ? 1 : 0;
    if (expected.unsure) return;
    ++decided_;
    ASSERT_EQ(expected.brighter, static_cast<int>(actual.brighter)) << what;
    expect_near(expected.brightening, static_cast<double>(actual.brightening), what + " brightening");
    expect_near(expected.light, static_cast<double>(actual.light), what + " light");
    expect_near(expected.history_error, static_cast<double>(actual.history_error), what + " history_error");
    expect_near(expected.neighbour_error, static_cast<double>(actual.neighbour_error),
                what + " neighbour_error");
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t rigid_ = 0;
  std::int64_t plain_ = 0;
  std::int64_t torn_ = 0;
  std::int64_t rigid_and_torn_ = 0;
};

// Each tile's part of a total is cut to an integer.
void add_tile(reference::TotalLight& total, double& allowed, const reference::Tile& tile) {
  const double units = static_cast<double>(kLightUnits) / std::max(tile.samples, 1);
  total.brightening += tile.brightening.value * units;
  total.change += std::abs(tile.brightening.value) * units;
  total.light += tile.light.value * units;
  total.history_error += tile.history_error.value * units;
  total.neighbour_error += tile.neighbour_error.value * units;
  allowed += 1 + 2 * units *
                     std::max({tile.brightening.error, tile.light.error, tile.history_error.error,
                               tile.neighbour_error.error});
}

TEST_P(Temporal, TilesMatchTheReferenceAtEverySizeAndScale) {
  const TemporalStages stages(GetParam());
  int totals = 0;
  for (const StageSpec& spec : all_specs({Pattern::kNoise, Pattern::kNonFinite, Pattern::kImpulse})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto expected = reference::temporal_tiles(in.reference);
    const auto actual = stages.run_tiles(in);
    reference::TotalLight total;
    double allowed = 0;
    bool unsure = false;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      compare_tile(expected[i], actual.tiles[i], fmt::format("{}: tile {}", what_of(spec), i));
      if (HasFatalFailure()) return;
      add_tile(total, allowed, expected[i]);
      unsure = unsure || expected[i].undecided || expected[i].unsure;
    }
    if (unsure) continue;
    ++totals;
    ASSERT_NEAR(total.brightening, actual.total.brightening, allowed) << what_of(spec);
    ASSERT_NEAR(total.change, actual.total.change, allowed) << what_of(spec);
    ASSERT_NEAR(total.light, actual.total.light, allowed) << what_of(spec);
    ASSERT_NEAR(total.history_error, actual.total.history_error, allowed) << what_of(spec);
    ASSERT_NEAR(total.neighbour_error, actual.total.neighbour_error, allowed) << what_of(spec);
  }
  EXPECT_GE(decided_, compared_ * 3 / 4);
  EXPECT_GE(rigid_, compared_ / 4);
  EXPECT_GE(plain_, compared_ / 8);
  if (GetParam().moves) {
    EXPECT_GE(rigid_ - plain_, compared_ / 32);
    EXPECT_GE(rigid_and_torn_, compared_ / 64);
    EXPECT_GE(torn_ - rigid_and_torn_, compared_ / 32);
    EXPECT_GE(compared_ - torn_, compared_ / 4);
  }
  EXPECT_GT(totals, 20);
}

TEST_P(Temporal, ResolveMatchesTheReferenceAtEverySizeScaleAndInput) {
  const StageVariant& v = GetParam();
  const TemporalStages stages(v);
  for (const StageSpec& spec : all_specs(testing::all_patterns())) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto tiles = stages.tiles(in, spec.seed);
    const auto actual = stages.run_resolve(rig, in, tiles);
    compare(reference::resolve_temporal(in.reference, tiles, {}), actual.pixels, spec.output.width, v.history,
            what_of(spec));
    if (HasFatalFailure()) return;
  }
  // Moves by whole pixels leave it to a rounding which texels hold the cubic in.
  EXPECT_GE(decided_, compared_ * 3 / 4);
}

// What is copied without looking at each sample is what looking at them gives.
TEST_P(Temporal, PlainTilesGiveTheSameBits) {
  if (!GetParam().moves) return;  // all are
  const TemporalStages stages(GetParam());
  for (const StageSpec& spec : all_specs({Pattern::kNoise})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    auto tiles = stages.tiles(in, spec.seed);
    const auto plain = stages.run_resolve(rig, in, tiles);
    for (reference::Tile& tile : tiles)
      tile.plain = false;
    EXPECT_EQ(plain.bytes, stages.run_resolve(rig, in, tiles).bytes) << what_of(spec);
  }
}

// What the presets change.
TEST_P(Temporal, BilinearHistoryAndTrustMatchToo) {
  const StageVariant& v = GetParam();
  const TemporalStages stages(v);
  if (!v.moves) return;  // they change nothing
  for (const TemporalPreset preset : {TemporalPreset::kFast, TemporalPreset::kQuality}) {
    const bool fast = preset == TemporalPreset::kFast;
    const reference::TemporalOptions options{fast ? 4 : 16, !fast};
    for (const StageSpec& spec : all_specs({Pattern::kNoise})) {
      Rig rig;
      const StageInputs in = stages.inputs(rig, spec);
      const auto tiles = stages.tiles(in, spec.seed);
      const auto actual = stages.run_resolve(rig, in, tiles, preset);
      compare(reference::resolve_temporal(in.reference, tiles, options), actual.pixels, spec.output.width,
              v.history, what_of(spec));
      if (HasFatalFailure()) return;
    }
  }
  // Moves by whole pixels leave it to a rounding which texels hold the cubic in.
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
    for (const Shown& shown : {Shown{}, {TemporalPreset::kFast, true}, {.first = true}}) {
      const reference::DisplayOptions options{shown.preset != TemporalPreset::kFast && !shown.first,
                                              !shown.background};
      const auto actual = stages.run_display(rig, in, in.reference.before, shown);
      compare(reference::temporal_display(in.reference, in.reference.before, options), actual.pixels,
              spec.output.width, v.resolved, what_of(spec));
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
          {.moves = false},
          {.moves = false, .reactive = true},
          {.storage = Storage::kImage, .moves = false, .reactive = true}};
}

INSTANTIATE_TEST_SUITE_P(Variants, Temporal, ::testing::ValuesIn(variants()),
                         [](const auto& instance) { return testing::name_of(instance.param); });

}  // namespace
}  // namespace quincunx
