// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "pass_rig.h"
#include "two_frame_cases.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// Two bilinear samples (8 * 2^-24 of the largest tap, see scale_test.cpp), a share of the previous frame that
// five operations and a division of 2.5 ulp leave within 16 * 2^-24, which weighs a difference of at most
// twice the largest tap, and three operations more.
constexpr double kResolveError = (8 + 2 * 16 + 4) * 0x1p-24;
constexpr double kDenormal = 0x1p-126;

struct Variant {
  VelocitySource velocity;
  bool reactive;
  Storage storage;
  PixelFormat colour;
  PixelFormat velocity_format;
  PixelFormat resolved;
  Sampling sampling = Sampling::kBilinear;
};

class Resolve : public ::testing::TestWithParam<Variant>, protected testing::TwoFrameCases {
 protected:
  Resolve() {
    const Variant& v = GetParam();
    settings_ = {.method = Method::kQuincunx,
                 .colour = v.colour,
                 .velocity = v.velocity_format,
                 .targets = {.storage = v.storage},
                 .output = {.linear = v.resolved}};
    settings_.quincunx.sampling = v.sampling;
    const bool moves = v.velocity == VelocitySource::kTarget;
    const SceneNeeds needs{.moving_objects = moves, .camera_motion = moves, .transparents = v.reactive};
    formats_ = {.storage = v.storage,
                .colour = v.colour,
                .velocity = v.velocity_format,
                .with_velocity = v.velocity == VelocitySource::kTarget,
                .with_reactive = v.reactive};
    pass_ = std::make_unique<PassRig>(needs, settings_, "resolve_quincunx");
  }

  template <typename Enqueue>
  Resolved run(Rig& rig, Extent output, Enqueue enqueue) {
    const ImageView view = rig.output(settings_.output.linear, output);
    const Counter counter = rig.counter();
    enqueue(view, counter);
    Resolved result{rig.bytes(view, output), {}, 0};
    result.pixels = testing::decode(settings_.output.linear, result.bytes);
    result.non_finite = rig.count(counter);
    return result;
  }

  Resolved resolve(Rig& rig, const TestFrame& current, const TestFrame& previous, Extent output) override {
    return run(rig, output, [&](const ImageView& view, Counter counter) {
      pass_->run(current.inputs, previous.inputs, output, counter, {{Resource::kResolved, view}});
    });
  }

  // Resolves this frame alone.
  Resolved single(Rig& rig, const TestFrame& current, Extent output) {
    ResolveSettings settings = settings_;
    const bool point = GetParam().sampling == Sampling::kPoint;
    settings.method = point ? Method::kPoint : Method::kBilinear;
    PassRig scale({}, settings, point ? "scale_point" : "scale_bilinear");
    return run(rig, output, [&](const ImageView& view, Counter counter) {
      scale.run(current.inputs, {}, output, counter, {{Resource::kResolved, view}});
    });
  }

  TestFrame with_motion(TestFrame made) const override {
    made.inputs.velocity_scale = {-.5f, .75f};
    made.reference.velocity_scale = {-.5, .75};
    return made;
  }

  reference::Picture expected(const TestFrame& current, const TestFrame& previous, Extent output) const {
    const auto weight = GetParam().velocity == VelocitySource::kNone ? reference::Weight::kMean
                                                                     : reference::Weight::kVelocity;
    return reference::resolve_quincunx(current.reference, previous.reference, weight,
                                       GetParam().sampling == Sampling::kPoint, GetParam().reactive, 1,
                                       output.width, output.height);
  }

  void compare(const FrameSpec& now, const FrameSpec& before, Extent output) override {
    Rig rig;
    const TestFrame current = frame(rig, now);
    const TestFrame previous = frame(rig, before);
    const Resolved actual = resolve(rig, current, previous, output);
    const reference::Picture picture = expected(current, previous, output);
    const auto bound = [&](std::size_t i) {
      return kResolveError * picture.largest[i] + kDenormal +
             testing::output_rounding(settings_.output.linear, picture.largest[i]);
    };
    const std::string what = testing::name_of(now, before, output);
    testing::expect_close(picture, actual.pixels, bound, what, settings_.output.linear);
    EXPECT_EQ(actual.non_finite, picture.non_finite) << what;
  }

  std::unique_ptr<PassRig> pass_;
};

TEST_P(Resolve, MatchesTheReferenceAtEverySizeScaleAndInput) {
  compare_at_every_size_scale_and_input({257, 129});
}

TEST_P(Resolve, AnySpeedAndTheWidestRowsMatchToo) {
  compare_at_any_speed_and_with_the_widest_rows();
}

TEST_P(Resolve, PoisonOutsideTheViewportChangesNoBit) {
  poison_outside_the_viewport_changes_no_bit();
}

TEST_P(Resolve, ATightImageGivesTheSameBits) {
  a_tight_image_gives_the_same_bits();
}

TEST_P(Resolve, TwoRunsAgreeBitForBit) {
  two_runs_agree_bit_for_bit();
}

TEST_P(Resolve, AConstantStaysConstant) {
  Rig rig;
  const TestFrame current =
      frame(rig, {.render = {45, 23}, .jitter = {.25f, .25f}, .colour = Pattern::kConstant});
  const TestFrame previous =
      frame(rig, {.render = {50, 31}, .jitter = {-.25f, -.25f}, .colour = Pattern::kConstant});
  const Pixel value = current.reference.colour.front();
  for (const Pixel& pixel : resolve(rig, current, previous, {64, 33}).pixels) {
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_NEAR(pixel[c], value[c],
                  kResolveError * value[c] + testing::output_rounding(settings_.output.linear, value[c]));
    }
  }
}

// A previous frame that is NaN throughout leaves no trace: the picture is that of the scale pass, bit for
// bit.
TEST_P(Resolve, NothingOfANonFinitePreviousFrameSurvives) {
  if (!testing::holds_non_finite(GetParam().colour)) return;
  Rig rig;
  const FrameSpec before{.render = {60, 40}, .jitter = {-.25f, -.25f}};
  const TestFrame current = frame(rig, {.render = {45, 23}, .jitter = {.25f, .25f}});
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Pixel> spoilt(60 * 40, Pixel{std::nan(""), infinity, 1, -infinity});
  const TestFrame previous = frame(rig, before, spoilt);
  const Resolved resolved = resolve(rig, current, previous, {64, 33});
  EXPECT_EQ(resolved.bytes, single(rig, current, {64, 33}).bytes);
  EXPECT_EQ(resolved.non_finite, 64 * 33);
}

TEST_P(Resolve, ANonFiniteTexelChangesItsFootprintOnly) {
  if (!testing::holds_non_finite(GetParam().colour)) return;
  const Extent output{90, 40};
  const Extent render = testing::scaled(output, .71, .71);
  const std::vector<Pixel> clean = pattern_pixels(Pattern::kNoise, render, 9);
  std::vector<Pixel> spoilt = clean;
  spoilt[static_cast<std::size_t>(12 * render.width + 20)] = {std::nan(""), 1, 1, 1};
  const FrameSpec spec{.render = render, .jitter = {.25f, .25f}};
  Rig rig;
  const TestFrame previous = frame(rig, {.render = render, .jitter = {-.25f, -.25f}, .seed = 8});
  const TestFrame clean_frame = frame(rig, spec, clean);
  const TestFrame spoilt_frame = frame(rig, spec, spoilt);
  const Resolved before = resolve(rig, clean_frame, previous, output);
  const Resolved after = resolve(rig, spoilt_frame, previous, output);
  std::int64_t touched = 0;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const auto i = static_cast<std::size_t>(y * output.width + x);
      const auto sample =
          GetParam().sampling == Sampling::kPoint ? reference::sample_nearest : reference::sample_bilinear;
      if (sample(spoilt_frame.reference, x, y, output.width, output.height).non_finite) {
        ++touched;
      } else {
        EXPECT_EQ(before.pixels[i], after.pixels[i]) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(touched, 0);
  EXPECT_EQ(after.non_finite, touched);
}

// With f = 0 in every pixel the pass is the scale pass, bit for bit.
TEST_P(Resolve, WithoutTrustItIsTheScalePass) {
  if (!GetParam().reactive) return;
  Rig rig;
  TestFrame current = frame(rig, {.render = {45, 23}, .jitter = {.25f, .25f}});
  const TestFrame previous = frame(rig, {.render = {60, 40}, .jitter = {-.25f, -.25f}, .seed = 2});
  current.inputs.reactive = rig.image(PixelFormat::kR8, settings_.targets.storage, {45, 23},
                                      std::vector<Pixel>(45 * 23, Pixel{1, 1, 1, 1}), 0);
  EXPECT_EQ(resolve(rig, current, previous, {64, 33}).bytes, single(rig, current, {64, 33}).bytes);
}

// A linear picture comes back in place from two frames with opposite jitter: a wrong sign in either would
// show.
TEST_P(Resolve, JitterIsTakenBackInBothFrames) {
  if (GetParam().sampling == Sampling::kPoint) return;
  const Extent output{128, 64};
  const Extent render = testing::scaled(output, .71, .71);
  Rig rig;
  const auto ramp = [&](float jitter, Extent extent) {
    std::vector<Pixel> colour;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        colour.push_back({(x + .5 + static_cast<double>(jitter)) / extent.width,
                          (y + .5 + static_cast<double>(jitter)) / extent.height, 0, 1});
      }
    }
    return with_motion(make_frame(rig, formats_, {.render = extent, .jitter = {jitter, jitter}}, colour));
  };
  // The second case would hide a sign that is wrong in both: equal jitters do not cancel.
  const float jitters[][2] = {{.25f, -.25f}, {.25f, .25f}, {0, .5f}};
  for (const auto& jitter : jitters) {
    const Resolved actual = resolve(rig, ramp(jitter[0], render), ramp(jitter[1], {100, 50}), output);
    const double rounding = testing::input_rounding(formats_.colour, 1) + 2 * 0x1p-12;  // a half output's too
    for (int y = 4; y < output.height - 4; ++y) {
      for (int x = 4; x < output.width - 4; ++x) {
        const Pixel& pixel = actual.pixels[static_cast<std::size_t>(y * output.width + x)];
        ASSERT_NEAR(pixel[0], (x + .5) / output.width, rounding);
        ASSERT_NEAR(pixel[1], (y + .5) / output.height, rounding);
      }
    }
  }
}

std::vector<Variant> variants() {
  using enum PixelFormat;
  std::vector<Variant> all;
  for (const VelocitySource velocity : {VelocitySource::kTarget, VelocitySource::kNone}) {
    for (const bool reactive : {true, false}) {
      for (const PixelFormat resolved : {kRGBA32F, kRGBA16F}) {
        for (const PixelFormat colour : {kRGBA16F, kRGBA32F, kRGBA8}) {
          all.push_back({velocity, reactive, Storage::kBuffer, colour, kRG16F, resolved});
          if (velocity == VelocitySource::kTarget) {
            all.push_back({velocity, reactive, Storage::kBuffer, colour, kRG32F, resolved});
          }
        }
        all.push_back({velocity, reactive, Storage::kImage, kRGBA16F, kRG16F, resolved});
        all.push_back({velocity, reactive, Storage::kImage, kRGBA8, kRG16F, resolved});
        all.push_back({velocity, reactive, Storage::kBuffer, kRGBA16F, kRG16F, resolved, Sampling::kPoint});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, Resolve, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(), [](const Variant& v) {
                           return fmt::format(
                               "{}{}{}_{}_{}_{}_to_{}",
                               v.velocity == VelocitySource::kNone ? "mean" : "velocity",
                               v.sampling == Sampling::kPoint ? "_point" : "", v.reactive ? "_reactive" : "",
                               v.storage == Storage::kImage ? "image" : "buffer", name_of(v.colour),
                               name_of(v.velocity_format), name_of(v.resolved));
                         }));

// v is counted in pixels of its frame's viewport, whatever the output: at the same uv velocity a larger
// viewport trusts the previous frame less.
TEST(ResolveWeight, CountsRenderPixels) {
  ResolveSettings settings = {.method = Method::kQuincunx};
  settings.quincunx.velocity_weight = 2;
  PassRig pass({.transparents = false}, settings, "resolve_quincunx");
  const testing::FrameFormats formats{.with_velocity = true};
  const Extent output{50, 30};
  for (const Extent render : {Extent{40, 20}, Extent{80, 40}}) {
    Rig rig;
    const Extent before{60, 33};
    const auto plain = [&](Extent extent, Pixel pixel) {
      return std::vector<Pixel>(static_cast<std::size_t>(extent.area()), pixel);
    };
    TestFrame current = make_frame(rig, formats, {.render = render}, plain(render, {0, 0, 0, 0}));
    TestFrame previous = make_frame(rig, formats, {.render = before}, plain(before, {1, 1, 1, 1}));
    const Pixel uv0 = {.015625, -.0625, 0, 0};
    const Pixel uv1 = {-.03125, .0078125, 0, 0};
    current.inputs.velocity = rig.image(PixelFormat::kRG16F, Storage::kBuffer, render, plain(render, uv0), 0);
    previous.inputs.velocity =
        rig.image(PixelFormat::kRG16F, Storage::kBuffer, before, plain(before, uv1), 0);
    const ImageView view = rig.output(PixelFormat::kRGBA32F, output);
    pass.run(current.inputs, previous.inputs, output, rig.counter(), {{Resource::kResolved, view}});
    const double v0 = std::hypot(uv0[0] * render.width, uv0[1] * render.height);
    const double v1 = std::hypot(uv1[0] * before.width, uv1[1] * before.height);
    const double f = 1 / (1 + 2 * (v0 * v0 + v1 * v1));
    EXPECT_NEAR(rig.pixels(view, output).front()[0], f / (1 + f), kResolveError);
  }
}

}  // namespace
}  // namespace quincunx
