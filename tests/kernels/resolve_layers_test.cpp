// SPDX-License-Identifier: MIT
// resolve_layers against its reference, and resolve_temporal, which leaves layered tiles to it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expected.h"
#include "layer_fixture.h"

namespace quincunx {
namespace {

using testing::expect_near;
using testing::LayerStageInputs;
using testing::LayerStages;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::StageSpec;
using testing::StageVariant;
using testing::TemporalStages;

constexpr unsigned char kPoison = 0x7f;

class ResolveLayers : public ::testing::TestWithParam<StageVariant> {
 protected:
  // One texel of each of the three that the kernel writes.
  struct Texel {
    Pixel far, near, state;
    double alpha = 1;  // only from variants that have it
  };

  void compare_texel(const LayerStageInputs& in, int x, int y, const Texel& actual, const std::string& what) {
    const auto [value, bound, undecided] = reference::expected_of(
        [&]<typename Real>(Real) { return reference::resolve_layers<Real>(in.reference, x, y); });
    ++compared_;
    if (undecided) return;
    ++decided_;
    const PixelFormat history = GetParam().history;
    for (std::size_t c = 0; c < 4; ++c) {
      expect_near(value.far[c], bound.far[c], actual.far[c], fmt::format("{} far {}", what, c), history);
      if (HasFatalFailure()) return;
    }
    if (GetParam().alpha) expect_near(value.alpha, bound.alpha, actual.alpha, what + " alpha", history);
    for (std::size_t c = 0; c < 4; ++c) {
      if (std::isnan(value.state[c])) {  // depth that is not finite
        ASSERT_TRUE(std::isnan(actual.state[c])) << what << " state " << c;
        continue;
      }
      expect_near(value.state[c], bound.state[c], actual.state[c], fmt::format("{} state {}", what, c),
                  PixelFormat::kRGBA16F);
      if (HasFatalFailure()) return;
    }
    if (!value.is_split) return;
    ++split_;
    const reference::LayerTile& tile = in.reference.layers[in.reference.past.tile(x, y)];
    crossing_ += tile.motion_range > 1 ? 1 : 0;
    drifting_ += !tile.is_rigid && tile.motion_range <= 1 ? 1 : 0;
    ASSERT_TRUE(std::signbit(actual.far[3])) << what << ": two layers are told by the sign";
    for (std::size_t c = 0; c < 4; ++c) {
      expect_near(value.near[c], bound.near[c], actual.near[c], fmt::format("{} near {}", what, c), history);
      if (HasFatalFailure()) return;
    }
  }

  void compare_resolve(const LayerStageInputs& in, const LayerStages::Resolved& made, const StageSpec& spec) {
    const PixelFormat history = GetParam().history;
    const auto far = testing::decode(history, made.far);
    const auto near = testing::decode(history, made.near);
    const auto states = testing::decode(PixelFormat::kRGBA16F, made.states);
    const reference::LayerHistory& past = in.reference.past;
    std::vector<double> alpha(past.far.size(), 1);
    if (GetParam().alpha) alpha = testing::decode_plane(history, made.alpha, past.far.size());
    for (int y = 0; y < past.height; ++y) {
      for (int x = 0; x < past.width; ++x) {
        const std::size_t i = past.texel(x, y);
        const std::string what = fmt::format("{}: pixel ({}, {})", testing::name_of(spec), x, y);
        if (in.reference.layers[past.tile(x, y)].is_layered)
          compare_texel(in, x, y, {far[i], near[i], states[i], alpha[i]}, what);
        else
          expect_poison(made, i, what);
        if (HasFatalFailure()) return;
      }
    }
  }

  // Returns inputs with a checkerboard where the variant has one.
  static LayerStageInputs inputs(const LayerStages& stages, Rig& rig, StageSpec spec) {
    if (GetParam().checkerboard) spec.parity = static_cast<int>(spec.seed % 2);
    return stages.inputs(rig, spec);
  }

  static void expect_poison(const LayerStages::Resolved& made, std::size_t texel, const std::string& what) {
    for (const auto* bytes : {&made.far, &made.near, &made.states})
      ASSERT_TRUE(is_poison(*bytes, texel, bytes->size() / (made.far.size() / texel_bytes()))) << what;
  }

  static std::size_t texel_bytes() { return bytes_per_pixel(GetParam().history); }

  static bool is_poison(const std::vector<unsigned char>& bytes, std::size_t texel, std::size_t size) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(texel * size);
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(size),
                       [](unsigned char byte) { return byte == kPoison; });
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t split_ = 0;
  std::int64_t crossing_ = 0;  // where near layers may cross
  std::int64_t drifting_ = 0;  // where they only drift apart
};

TEST_P(ResolveLayers, MatchesTheReferenceAtEverySizeScaleAndInput) {
  LayerStages stages(GetParam());
  for (const StageSpec& spec : testing::all_stage_specs(testing::all_patterns())) {
    Rig rig;
    const LayerStageInputs in = inputs(stages, rig, spec);
    compare_resolve(in, stages.run_resolve(rig, in), spec);
    if (HasFatalFailure()) return;
  }
  // Where a motion is whole pixels a rounding decides between which texels history is read.
  EXPECT_GE(decided_, compared_ * 3 / 4);
  EXPECT_GE(decided_, 100'000);
  EXPECT_GE(split_, decided_ / 5);
  EXPECT_GE(decided_ - split_, decided_ / 5);
  EXPECT_GE(crossing_, split_ / 16);
  EXPECT_GE(drifting_, split_ / 16);
}

TEST_P(ResolveLayers, PoisonOutsideTheViewportChangesNoBit) {
  LayerStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    StageSpec spec{
        .output = {64, 33}, .render = render, .previous = {render.height, render.width}, .seed = 5};
    Rig rig;
    const auto bytes = [&] {
      const LayerStageInputs in = inputs(stages, rig, spec);
      const LayerStages::Resolved made = stages.run_resolve(rig, in);
      std::vector<unsigned char> all = made.far;
      all.insert(all.end(), made.near.begin(), made.near.end());
      all.insert(all.end(), made.states.begin(), made.states.end());
      all.insert(all.end(), made.alpha.begin(), made.alpha.end());
      return all;
    };
    SCOPED_TRACE(name_of(spec));
    testing::expect_same_whatever_is_outside(spec, bytes);
  }
}

// Small, for a memory checker.
TEST_P(ResolveLayers, ATightFrameIsReadWithinItsEdges) {
  LayerStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{7, 3}}) {
    const StageSpec spec{.output = {13, 9},
                         .render = render,
                         .previous = {render.height, render.width},
                         .seed = 8,
                         .tight = true};
    Rig rig;
    const LayerStageInputs in = inputs(stages, rig, spec);
    compare_resolve(in, stages.run_resolve(rig, in), spec);
  }
  EXPECT_GT(decided_, 0);
}

TEST_P(ResolveLayers, ResolveTemporalMakesTheOtherTiles) {
  const TemporalStages temporal(GetParam());
  LayerStages stages(GetParam());
  std::int64_t layered = 0;
  std::int64_t others = 0;
  std::int64_t non_finite = 0;
  for (const StageSpec& spec : testing::all_stage_specs({Pattern::kNonFinite})) {
    Rig rig;
    const LayerStageInputs in = inputs(stages, rig, spec);
    const reference::ResolveInputs& r = in.reference;
    const auto without = temporal.run_resolve(rig, in.stage, r.tiles);
    const auto with = temporal.run_resolve(rig, in.stage, r.tiles, {.layers = testing::to_kernel(r.layers)});
    for (int y = 0; y < r.past.height; ++y) {
      for (int x = 0; x < r.past.width; ++x) {
        const std::size_t i = r.past.texel(x, y);
        const std::string what = fmt::format("{}: pixel ({}, {})", testing::name_of(spec), x, y);
        if (r.layers[r.past.tile(x, y)].is_layered) {
          ++layered;
          ASSERT_TRUE(is_poison(with.bytes, i, texel_bytes())) << what;
        } else {
          ++others;
          const auto first = static_cast<std::ptrdiff_t>(i * texel_bytes());
          ASSERT_TRUE(std::equal(with.bytes.begin() + first,
                                 with.bytes.begin() + first + static_cast<std::ptrdiff_t>(texel_bytes()),
                                 without.bytes.begin() + first))
              << what;
        }
      }
    }
    EXPECT_EQ(without.non_finite, with.non_finite + stages.run_resolve(rig, in).non_finite)
        << testing::name_of(spec);
    non_finite += without.non_finite;
  }
  EXPECT_GE(layered, 5000);
  EXPECT_GE(others, 1000);
  EXPECT_GE(non_finite, testing::holds_non_finite(GetParam().colour) ? 1000 : 0);
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{},
          {.alpha = true},
          {.colour = kRGBA8},
          {.checkerboard = true},
          {.alpha = true, .checkerboard = true},
          {.history = kRGBA16F, .resolved = kRGBA16F},
          {.storage = Storage::kImage}};
}

INSTANTIATE_TEST_SUITE_P(Variants, ResolveLayers, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(),
                                               [](const StageVariant& v) { return testing::name_of(v); }));

}  // namespace
}  // namespace quincunx
