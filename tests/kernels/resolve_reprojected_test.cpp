// SPDX-License-Identifier: MIT
// The reprojected form of the two-frame resolve: where samples were, and the picture made of both frames.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "../reference/reproject.h"
#include "expected.h"
#include "pass_rig.h"
#include "passes/frame_params.h"
#include "two_frame_cases.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

constexpr double kRounding = 0x1p-24;
constexpr double kDenormal = 0x1p-126;

// A fraction is rounded to 2^-25; moved, the sum rounds by 2^-24 of fraction + motion. Of (1 - d^2/r^2)^3 the
// slope is below 2 for r >= .875; its square, product, difference and cube add 11 roundings, the mixing with
// bilinear's 3 more, all of values below 1. A sample's weight is the product of two such.
double weight_error(double motion) {
  const double position = .5 * kRounding + (1 + std::abs(motion)) * kRounding;
  return 2 * (2 * position + 14 * kRounding);
}

// Error of the steps after the weights: normalised (a sum of products and a division), weighed by brightness (two
// roundings and a division), 8 products and 7 sums.
constexpr double kBlendError = 24 * kRounding;

struct Variant {
  bool moves = true;
  bool reactive = false;
  bool residual = false;
  Storage storage = Storage::kBuffer;
  PixelFormat colour = PixelFormat::kRGBA16F;
  PixelFormat velocity = PixelFormat::kRG16F;
  PixelFormat resolved = PixelFormat::kRGBA32F;
};

std::string name_of(const Variant& v) {
  return fmt::format("{}{}{}_{}_{}_{}_to_{}", v.moves ? "moving" : "still", v.residual ? "_residual" : "",
                     v.reactive ? "_reactive" : "", v.storage == Storage::kImage ? "image" : "buffer",
                     quincunx::name_of(v.colour), quincunx::name_of(v.velocity),
                     quincunx::name_of(v.resolved));
}

class Reprojected : public ::testing::TestWithParam<Variant>, protected testing::TwoFrameCases {
 protected:
  Reprojected() {
    const Variant& v = GetParam();
    settings_ = {.method = Method::kQuincunx,
                 .colour = v.colour,
                 .velocity = v.velocity,
                 .targets = {.storage = v.storage},
                 .output = {.linear = v.resolved}};
    settings_.output.present = false;
    settings_.quincunx.form = TwoFrameForm::kReprojected;
    settings_.quincunx.residual_weight = v.residual ? .5f : 0;
    formats_ = {.storage = v.storage,
                .colour = v.colour,
                .velocity = v.velocity,
                .with_velocity = v.moves,
                .with_depth = v.moves,
                .with_reactive = v.reactive};
  }

  // One for all frames of an output, up to twice its size.
  PassChain& chain_for(Extent output) {
    if (!chain_ || settings_.output_extent != output) {
      const Variant& v = GetParam();
      settings_.output_extent = output;
      settings_.target_extent = {2 * output.width + 3, 2 * output.height};
      const SceneNeeds needs{.moving_objects = v.moves, .camera_motion = v.moves, .transparents = v.reactive};
      chain_.emplace(testing::device(), PlanFacts(needs, settings_));
    }
    return *chain_;
  }

  Resolved resolve(Rig& rig, const TestFrame& current, const TestFrame& previous, Extent output) override {
    PassChain& chain = chain_for(output);
    const ImageView view = rig.output(settings_.output.linear, output);
    const Counter counter = rig.counter();
    FrameReport report;
    FrameInputs inputs = current.inputs;
    inputs.exposure = 1;  // with which exposed light is light as it is
    chain.run(chain.frame(inputs, &previous.inputs, {.linear = view}, counter), {.linear = view}, report,
              nullptr);
    Resolved run{rig.bytes(view, output), {}, rig.count(counter)};
    run.pixels = testing::decode(settings_.output.linear, run.bytes);
    reprojections_.assign(current.reference.colour.size(), {0, 0, 1});
    if (const ImageView found = chain.newest(Resource::kReprojection)) {
      const std::vector<Pixel> pixels = rig.pixels(found, current.inputs.render_extent);
      std::transform(pixels.begin(), pixels.end(), reprojections_.begin(), [](const Pixel& pixel) {
        return reference::Reprojection{pixel[0], pixel[1], pixel[2]};
      });
    }
    return run;
  }

  // The camera walks backwards and turns; its matrix is not normalised.
  TestFrame with_motion(TestFrame made) const override {
    made.inputs.velocity_scale = {-.5f, .75f};
    made.reference.velocity_scale = {-.5, .75};
    auto& camera = made.inputs.camera.clip_to_previous_clip;
    camera = {1, 0, 0, .05f, 0, 1, 0, -.04f, .1f, .2f, 1.25f, -.6f, 0, 0, 0, 1.22f};
    std::copy(camera.begin(), camera.end(), made.reference.clip_to_previous_clip.begin());
    return made;
  }

  void compare_reprojections(const TestFrame& current, const TestFrame& previous, const std::string& what) {
    const Variant& v = GetParam();
    if (!v.moves) return;
    const auto expected = testing::expected_reprojections(
        current.reference, previous.reference,
        {.reactive = v.reactive, .residual_weight = static_cast<double>(settings_.quincunx.residual_weight)});
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto& [value, bound, undecided] = expected[i];
      const reference::Reprojection& actual = reprojections_[i];
      ASSERT_NEAR(value.x, actual.x, bound.x.error) << what << ", sample " << i;
      ASSERT_NEAR(value.y, actual.y, bound.y.error) << what << ", sample " << i;
      ++compared_;
      if (undecided) continue;
      ++decided_;
      ASSERT_EQ(std::isnan(value.trust), std::isnan(actual.trust)) << what << ", sample " << i;
      if (std::isnan(value.trust)) continue;
      ASSERT_NEAR(value.trust, actual.trust, bound.trust.error) << what << ", sample " << i;
    }
  }

  // The picture from the device's own reprojections, so that no rounding before it matters.
  void compare(const FrameSpec& now, const FrameSpec& before, Extent output) override {
    Rig rig;
    const TestFrame current = frame(rig, now);
    const TestFrame previous = frame(rig, before);
    const Resolved run = resolve(rig, current, previous, output);
    const std::string what = testing::name_of(now, before, output);
    compare_reprojections(current, previous, what);
    if (HasFatalFailure()) return;
    const auto expected =
        reference::resolve_reprojected(current.reference, previous.reference, reprojections_,
                                       !GetParam().moves && GetParam().reactive, output.width, output.height);
    const auto bound = [&](std::size_t i) {
      return weight_error(expected.motion[i]) * expected.condition[i] + kBlendError * expected.largest[i] +
             16 * kDenormal + testing::output_rounding(settings_.output.linear, expected.largest[i]);
    };
    testing::expect_close(expected, run.pixels, bound, what, settings_.output.linear);
    EXPECT_GE(run.non_finite, expected.non_finite) << what;
    EXPECT_LE(run.non_finite, expected.non_finite + expected.undecided) << what;
  }

  std::optional<PassChain> chain_;
  std::vector<reference::Reprojection> reprojections_;  // those of the frame resolved last
  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
};

TEST_P(Reprojected, MatchesTheReferenceAtEverySizeScaleAndInput) {
  compare_at_every_size_scale_and_input({130, 65});
  // Where roundings decide everywhere, nothing was compared.
  EXPECT_GE(decided_, compared_ * 9 / 10);
}

TEST_P(Reprojected, AnySpeedAndTheWidestRowsMatchToo) {
  compare_at_any_speed_and_with_the_widest_rows();
}

TEST_P(Reprojected, PoisonOutsideTheViewportChangesNoBit) {
  poison_outside_the_viewport_changes_no_bit();
}

TEST_P(Reprojected, ATightImageGivesTheSameBits) {
  a_tight_image_gives_the_same_bits();
}

TEST_P(Reprojected, TwoRunsAgreeBitForBit) {
  two_runs_agree_bit_for_bit();
}

// The fast and the careful way through a block give the same bits.
TEST_P(Reprojected, ANonFiniteTexelChangesItsFootprintOnly) {
  if (!testing::holds_non_finite(GetParam().colour)) return;
  const Extent output{90, 40};
  const Extent render = testing::scaled(output, .71, .71);
  const std::vector<Pixel> clean = pattern_pixels(Pattern::kNoise, render, 9);
  std::vector<Pixel> spoilt = clean;
  spoilt[static_cast<std::size_t>(12 * render.width + 20)] = {std::nan(""), 1, 1, 1};
  const FrameSpec spec{.render = render, .jitter = {.25f, .25f}};
  Rig rig;
  const TestFrame previous = frame(rig, {.render = render, .jitter = {-.25f, -.25f}, .seed = 8});
  const Resolved before = resolve(rig, frame(rig, spec, clean), previous, output);
  const Resolved after = resolve(rig, frame(rig, spec, spoilt), previous, output);
  int changed = 0;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const auto i = static_cast<std::size_t>(y * output.width + x);
      if (before.pixels[i] == after.pixels[i]) continue;
      ++changed;
      EXPECT_LT(std::abs((x + .5) * .71 - 20.75), 1.1) << x << ", " << y;
      EXPECT_LT(std::abs((y + .5) * .71 - 12.75), 1.1) << x << ", " << y;
    }
  }
  EXPECT_GT(changed, 0);
  EXPECT_GE(after.non_finite, changed);
}

// A previous frame that is NaN throughout leaves no trace: the picture is bilinear's of this one, where
// nothing is bright.
TEST_P(Reprojected, NothingOfANonFinitePreviousFrameSurvives) {
  if (!testing::holds_non_finite(GetParam().colour)) return;
  Rig rig;
  const Extent output{64, 33};
  std::vector<Pixel> dark = pattern_pixels(Pattern::kNoise, {45, 23}, 1);
  for (Pixel& pixel : dark) {
    for (double& value : pixel)
      value /= 2;
  }
  const TestFrame current = frame(rig, {.render = {45, 23}, .jitter = {.25f, .25f}}, dark);
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Pixel> spoilt(60 * 40, Pixel{std::nan(""), infinity, 1, -infinity});
  const TestFrame previous = frame(rig, {.render = {60, 40}, .jitter = {-.25f, -.25f}}, spoilt);
  const Resolved run = resolve(rig, current, previous, output);
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const reference::Sample bilinear =
          reference::sample_bilinear(current.reference, x, y, output.width, output.height);
      const Pixel& pixel = run.pixels[static_cast<std::size_t>(y * output.width + x)];
      for (std::size_t c = 0; c < 4; ++c) {
        // Eight weights at most, each off by its error, over a sum of 1.
        ASSERT_NEAR(pixel[c], bilinear.value[c],
                    (8 * weight_error(0) + kBlendError) * bilinear.largest +
                        testing::output_rounding(settings_.output.linear, bilinear.largest))
            << x << ", " << y;
      }
    }
  }
}

std::vector<Variant> variants() {
  using enum PixelFormat;
  std::vector<Variant> all;
  for (const bool reactive : {true, false}) {
    all.push_back({.reactive = reactive, .residual = true});
    for (const bool residual : {true, false}) {
      all.push_back({.reactive = reactive, .residual = residual, .velocity = kRG32F});
      all.push_back({.reactive = reactive, .residual = residual, .storage = Storage::kImage});
      all.push_back(
          {.reactive = reactive, .residual = residual, .storage = Storage::kImage, .colour = kRGBA8});
    }
    for (const PixelFormat resolved : {kRGBA32F, kRGBA16F}) {
      for (const PixelFormat colour : {kRGBA16F, kRGBA32F, kRGBA8}) {
        all.push_back({.moves = false, .reactive = reactive, .colour = colour, .resolved = resolved});
        all.push_back({.reactive = reactive, .colour = colour, .resolved = resolved});
      }
      all.push_back({.moves = false, .reactive = reactive, .storage = Storage::kImage, .resolved = resolved});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, Reprojected, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(), [](const Variant& v) { return name_of(v); }));

}  // namespace
}  // namespace quincunx
