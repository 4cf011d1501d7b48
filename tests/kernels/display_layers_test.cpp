// SPDX-License-Identifier: MIT
// display_layers against its reference.
#include <fmt/format.h>

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

class DisplayLayers : public ::testing::TestWithParam<StageVariant> {
 protected:
  void compare_display(const LayerStageInputs& in, const std::vector<Pixel>& actual, const StageSpec& spec) {
    const reference::LayerHistory& history = in.reference.past;
    for (int y = 0; y < history.height; ++y) {
      for (int x = 0; x < history.width; ++x) {
        const std::size_t i = history.texel(x, y);
        const std::string what = fmt::format("{}: pixel ({}, {})", testing::name_of(spec), x, y);
        if (!history.has_two(x, y)) {
          ASSERT_EQ(in.picture[i], actual[i]) << what;
          continue;
        }
        ++compared_;
        const auto [value, bound, undecided] = reference::expected_of([&]<typename Real>(Real) {
          return reference::display_layers<Real>(history, in.picture[i], x, y);
        });
        if (undecided) continue;
        ++decided_;
        for (std::size_t c = 0; c < 4; ++c) {
          expect_near(value[c], bound[c], actual[i][c], fmt::format("{} channel {}", what, c),
                      GetParam().resolved);
          if (HasFatalFailure()) return;
        }
      }
    }
  }

  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
};

TEST_P(DisplayLayers, MatchesTheReferenceAndLeavesOtherPixelsAlone) {
  LayerStages stages(GetParam());
  for (const StageSpec& spec :
       testing::all_stage_specs({Pattern::kNoise, Pattern::kConstant, Pattern::kRamp})) {
    Rig rig;
    const LayerStageInputs in = stages.inputs(rig, spec);
    compare_display(in, stages.run_display(rig, in), spec);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(decided_, compared_ * 9 / 10);
  EXPECT_GE(decided_, 20'000);
}

TEST_P(DisplayLayers, PoisonOutsideTheViewportChangesNoBit) {
  LayerStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    StageSpec spec{
        .output = {64, 33}, .render = render, .previous = {render.height, render.width}, .seed = 5};
    Rig rig;
    const auto pixels = [&] { return stages.run_display(rig, stages.inputs(rig, spec)); };
    SCOPED_TRACE(name_of(spec));
    testing::expect_same_whatever_is_outside(spec, pixels);
  }
}

// Small, for a memory checker.
TEST_P(DisplayLayers, ATightFrameIsReadWithinItsEdges) {
  LayerStages stages(GetParam());
  for (const Extent render : {Extent{1, 1}, Extent{7, 3}}) {
    const StageSpec spec{.output = {13, 9}, .render = render, .previous = render, .seed = 8, .tight = true};
    Rig rig;
    const LayerStageInputs in = stages.inputs(rig, spec);
    compare_display(in, stages.run_display(rig, in), spec);
  }
  EXPECT_GT(decided_, 0);
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{},
          {.alpha = true},
          {.colour = kRGBA8},
          {.history = kRGBA16F, .resolved = kRGBA16F, .alpha = true},
          {.history = kRGBA16F, .resolved = kRGBA16F},
          {.storage = Storage::kImage}};
}

INSTANTIATE_TEST_SUITE_P(Variants, DisplayLayers, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(),
                                               [](const StageVariant& v) { return testing::name_of(v); }));

}  // namespace
}  // namespace quincunx
