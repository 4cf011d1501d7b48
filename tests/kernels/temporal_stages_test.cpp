// SPDX-License-Identifier: MIT
// The kernels of the temporal upscaler, each on its own, against its reference. How far a result may be off
// follows from running error analysis beside the reference; where a rounding may turn a decision nothing is
// compared.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "expected.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using reference::Bounded;
using testing::expect_near;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::StageInputs;
using testing::StageSpec;
using testing::StageVariant;
using testing::TemporalStages;

class Temporal : public ::testing::TestWithParam<StageVariant> {
 protected:
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
    compare(reference, actual.pixels, spec.output, GetParam().history, name_of(spec));
    if (HasFatalFailure() || !GetParam().alpha) return;
    const auto alpha = [&]<typename Real>(Real, int x, int y) {
      const Real value = reference::resolve_temporal<Real>(in.reference, tiles, options, x, y).alpha;
      return reference::PixelOf<Real>{value, value, value, value};
    };
    std::vector<Pixel> alphas;
    for (const double value : actual.alpha)
      alphas.push_back({value, value, value, value});
    compare(alpha, alphas, spec.output, GetParam().history, name_of(spec) + ", alpha");
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
};

TEST_P(Temporal, ResolveMatchesTheReferenceAtEverySizeScaleAndInput) {
  const TemporalStages stages(GetParam());
  for (const StageSpec& spec : testing::all_stage_specs(testing::all_patterns())) {
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

// A sample that is not shaded gives way to one that is.
TEST_P(Temporal, SamplesOfACheckerboardMatchTheReference) {
  const TemporalStages stages(GetParam());
  for (StageSpec spec : testing::all_stage_specs({Pattern::kNoise, Pattern::kNonFinite})) {
    spec.parity = static_cast<int>(spec.seed % 2);
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto tiles = stages.tiles(in, spec.seed);
    compare_resolve(in, tiles, {}, stages.run_resolve(rig, in, tiles), spec);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(decided_, compared_ * 3 / 4);
}

// Tiles that are copied without a look at each sample's reprojection equal those that are looked at.
TEST_P(Temporal, CopyableTilesGiveTheSameBits) {
  if (!GetParam().moves) return;  // all are
  const TemporalStages stages(GetParam());
  for (const StageSpec& spec : testing::all_stage_specs({Pattern::kNoise})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    auto tiles = stages.tiles(in, spec.seed);
    const auto copied = stages.run_resolve(rig, in, tiles);
    for (reference::Tile& tile : tiles)
      tile.reprojection.is_trusted = false;
    EXPECT_EQ(copied.bytes, stages.run_resolve(rig, in, tiles).bytes) << name_of(spec);
  }
}

TEST_P(Temporal, HistoryOfFourAndOf36TapsMatchesToo) {
  const TemporalStages stages(GetParam());
  if (!GetParam().moves) return;  // it changes nothing
  for (const StageSpec& spec : testing::all_stage_specs({Pattern::kNoise})) {
    Rig rig;
    const StageInputs in = stages.inputs(rig, spec);
    const auto tiles = stages.tiles(in, spec.seed);
    compare_resolve(in, tiles, {.taps = 4}, stages.run_resolve(rig, in, tiles, {TemporalPreset::kFast}),
                    spec);
    compare_resolve(in, tiles, {.taps = 36}, stages.run_resolve(rig, in, tiles, {TemporalPreset::kQuality}),
                    spec);
    if (HasFatalFailure()) return;
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
    SCOPED_TRACE(name_of(spec));
    testing::expect_same_whatever_is_outside(spec, bytes);
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

// Gives texels two layers, as the sign of their confidence tells: none, all or some in each block of 32x16.
void give_layers(reference::TemporalInputs& in, unsigned seed) {
  std::mt19937 random(seed);
  for (int y = 0; y < in.output_height; ++y) {
    for (int x = 0; x < in.output_width; ++x) {
      std::mt19937 block(seed + static_cast<unsigned>(y / 16 * 64 + x / 32));
      const auto share = block() % 3;
      double& confidence = in.history[reference::index_of(in.output_width, x, y)][3];
      if (share == 2 || (share == 1 && random() % 2 == 0)) confidence = -confidence;
    }
  }
}

TEST_P(Temporal, DisplayMatchesTheReference) {
  const StageVariant& v = GetParam();
  const TemporalStages stages(v);
  for (const StageSpec& spec : testing::all_stage_specs({Pattern::kNoise})) {
    Rig rig;
    StageInputs in = stages.inputs(rig, spec);
    in.exposure = {1, 1, 1, 1};
    give_layers(in.reference, spec.seed);
    using Shown = TemporalStages::Shown;
    for (const Shown& shown : {Shown{}, {TemporalPreset::kFast}, {.first = true}}) {
      const reference::DisplayOptions options{shown.preset != TemporalPreset::kFast && !shown.first};
      const auto actual = stages.run_display(rig, in, in.reference.before, shown);
      const auto reference = [&]<typename Real>(Real, int x, int y) {
        return reference::temporal_display<Real>(in.reference, in.reference.before, options, x, y);
      };
      compare(reference, actual.pixels, spec.output, v.resolved, name_of(spec));
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(decided_, compared_);
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{},
          {.colour = kRGBA32F},
          {.colour = kRGBA8},
          {.storage = Storage::kImage, .colour = kRGBA8},
          {.history = kRGBA16F, .resolved = kRGBA16F},
          {.storage = Storage::kImage},
          {.alpha = true},
          {.history = kRGBA16F, .moves = false, .reactive = true, .alpha = true},
          {.moves = false},
          {.moves = false, .reactive = true},
          {.storage = Storage::kImage, .moves = false, .reactive = true}};
}

INSTANTIATE_TEST_SUITE_P(Variants, Temporal, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(),
                                               [](const StageVariant& v) { return testing::name_of(v); }));

}  // namespace
}  // namespace quincunx
