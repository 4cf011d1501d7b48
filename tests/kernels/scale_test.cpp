// SPDX-License-Identifier: MIT
// Every single-frame filter, in every variant: against its reference, and what holds for all of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "../reference/number_formats.h"
#include "scale_fixture.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::ScaleRig;
using testing::ScaleVariant;
using testing::TestFrame;

class Scale : public ::testing::TestWithParam<ScaleVariant> {
 protected:
  Scale() : scale_(GetParam()) {}

  ScaleRig scale_;
};

TEST_P(Scale, MatchesTheReferenceAtEverySizeScaleAndInput) {
  const double scales[][2] = {{.05, .1}, {.5, .71}, {.71, .5}, {1, 1}, {1.37, .83}, {2, 1.9}};
  const Vec2 jitters[] = {{0, 0}, {.25f, .25f}, {-.25f, .4f}, {-.5f, -1.f}};
  unsigned seed = 0;
  for (const Extent output : testing::sizes_for({257, 129})) {
    for (std::size_t i = 0; i < std::size(scales); ++i) {
      for (const Pattern pattern : testing::patterns_for(output, i)) {
        const Vec2 jitter = jitters[++seed % std::size(jitters)];
        scale_.compare({.render = testing::scaled(output, scales[i][0], scales[i][1]),
                        .jitter = jitter,
                        .colour = pattern,
                        .seed = seed},
                       output);
        if (HasFatalFailure()) return;
      }
    }
  }
}

// A coordinate made in single precision would be off by 2^-11 here.
TEST_P(Scale, TheWidestRowsMatchToo) {
  if (GetParam().storage == Storage::kImage)
    return;  // images end at 8192 on some devices, the margin included
  scale_.compare({.render = {5816, 2}, .jitter = {.25f, -.25f}, .seed = 7}, {8192, 3});
}

// All but the B-spline go through the samples; grain is none at scale 1.
TEST_P(Scale, IsTheIdentityAtScaleOneWithoutJitter) {
  // These two mix a sample with its neighbours everywhere.
  if (GetParam().method == Method::kBSpline || GetParam().method == Method::kMitchell) return;
  for (const Pattern pattern : {Pattern::kNoise, Pattern::kExtremes}) {
    Rig rig;
    const Extent extent{67, 33};
    const TestFrame frame = scale_.frame(rig, {.render = extent, .colour = pattern, .seed = 5});
    std::vector<Pixel> expected = frame.reference.colour;
    for (Pixel& pixel : expected) {
      for (double& value : pixel)
        value = testing::stored_value(GetParam().resolved, value);
    }
    EXPECT_EQ(scale_.run(rig, frame, extent).pixels, expected);
  }
}

// Every code of every channel, as the float nearest to its light.
TEST_P(Scale, EveryCodeOfEncodedColourGivesItsLight) {
  if (GetParam().colour != PixelFormat::kRGBA8 || GetParam().method != Method::kPoint) return;
  std::vector<Pixel> light;
  for (int code = 0; code < 256; ++code) {
    const double value = static_cast<double>(static_cast<float>(reference::linear_of_srgb(code / 255.0)));
    light.push_back({value, value, value, code / 255.0});
  }
  Rig rig;
  const Extent extent{256, 1};
  const TestFrame frame = scale_.frame(rig, {.render = extent}, light);
  const std::vector<Pixel> actual = scale_.run(rig, frame, extent).pixels;
  for (std::size_t code = 0; code < 256; ++code) {
    for (std::size_t c = 0; c < 4; ++c) {
      const auto nearest = static_cast<double>(static_cast<float>(light[code][c]));
      EXPECT_EQ(actual[code][c], testing::stored_value(GetParam().resolved, nearest)) << code << ", " << c;
    }
  }
}

TEST_P(Scale, PoisonOutsideTheViewportChangesNoBit) {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    const ScaleRig::Run clean = scale_.run(rig, scale_.frame(rig, spec), {64, 33});
    for (const double poison : testing::kPoisons) {
      spec.outside = poison;
      const ScaleRig::Run poisoned = scale_.run(rig, scale_.frame(rig, spec), {64, 33});
      EXPECT_EQ(clean.bytes, poisoned.bytes) << render.width << "x" << render.height << ", poison " << poison;
      EXPECT_EQ(poisoned.non_finite, 0);
    }
  }
}

// Under a memory checker this also shows that nothing beyond the viewport is read.
TEST_P(Scale, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{2, 2}, Extent{13, 7}}) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    const ScaleRig::Run roomy = scale_.run(rig, scale_.frame(rig, spec), {16, 9});
    spec.tight = true;
    EXPECT_EQ(roomy.bytes, scale_.run(rig, scale_.frame(rig, spec), {16, 9}).bytes);
  }
}

TEST_P(Scale, ANonFiniteTexelChangesItsFootprintOnly) {
  if (!testing::holds_non_finite(GetParam().colour)) return;
  const Extent output{90, 40};
  const Extent render = testing::scaled(output, .71, .71);
  const std::vector<Pixel> clean = pattern_pixels(Pattern::kNoise, render, 9);
  std::vector<Pixel> spoilt = clean;
  spoilt[static_cast<std::size_t>(12 * render.width + 20)] = {std::nan(""), 1, 1, 1};
  spoilt[static_cast<std::size_t>(20 * render.width + 40)] = {1, -std::numeric_limits<double>::infinity(), 1,
                                                              1};
  const FrameSpec spec{.render = render, .jitter = {.25f, .25f}};
  Rig rig;
  const TestFrame spoilt_frame = scale_.frame(rig, spec, spoilt);
  const ScaleRig::Run before = scale_.run(rig, scale_.frame(rig, spec, clean), output);
  const ScaleRig::Run after = scale_.run(rig, spoilt_frame, output);
  const reference::Sampler expected = scale_.sampler(spoilt_frame, output);
  std::int64_t touched = 0;
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const bool inside = expected(x, y).non_finite;
      touched += inside ? 1 : 0;
      if (inside) continue;
      const auto i = static_cast<std::size_t>(y * output.width + x);
      EXPECT_EQ(before.pixels[i], after.pixels[i]) << x << ", " << y;
    }
  }
  EXPECT_GT(touched, 0);
  EXPECT_EQ(after.non_finite, touched);
}

TEST_P(Scale, TwoRunsAgreeBitForBit) {
  Rig rig;
  const FrameSpec spec{.render = {183, 92}, .jitter = {.25f, -.25f}, .colour = Pattern::kNonFinite};
  const TestFrame frame = scale_.frame(rig, spec);
  EXPECT_EQ(scale_.run(rig, frame, {257, 129}).bytes, scale_.run(rig, frame, {257, 129}).bytes);
}

// All but Lanczos reproduce a linear picture: sampled at jittered places it must come back in place.
TEST_P(Scale, JitterIsTakenBack) {
  if (testing::takes_one_sample(GetParam().method) || GetParam().method == Method::kLanczos2 ||
      GetParam().method == Method::kLanczos3) {
    return;
  }
  const Extent output{128, 64};
  for (const double scale : {.5, .71, 1.0, 1.37}) {
    for (const float jitter : {-.25f, .25f, .5f}) {
      const Extent render = testing::scaled(output, scale, scale);
      std::vector<Pixel> colour;
      for (int y = 0; y < render.height; ++y) {
        for (int x = 0; x < render.width; ++x) {
          const double px = (x + .5 + static_cast<double>(jitter)) / render.width;
          const double py = (y + .5 + static_cast<double>(jitter)) / render.height;
          colour.push_back({px, py, px + py, 1});
        }
      }
      Rig rig;
      const ScaleRig::Run actual =
          scale_.run(rig, scale_.frame(rig, {.render = render, .jitter = {jitter, jitter}}, colour), output);
      // Inputs are rounded, some weights are negative, and a half output rounds again.
      const double rounding = 2 * testing::input_rounding(GetParam().colour, 1) + 2 * 0x1p-11;
      const int margin = 4;
      for (int y = margin; y < output.height - margin; ++y) {
        for (int x = margin; x < output.width - margin; ++x) {
          const Pixel& pixel = actual.pixels[static_cast<std::size_t>(y * output.width + x)];
          ASSERT_NEAR(pixel[0], (x + .5) / output.width, rounding)
              << "scale " << scale << " jitter " << jitter;
          ASSERT_NEAR(pixel[1], (y + .5) / output.height, rounding)
              << "scale " << scale << " jitter " << jitter;
        }
      }
    }
  }
}

// Filters are known by their values at whole distances, a sum of 1 at every place but for Lanczos' ripple, nothing
// beyond their support, and no step where their pieces meet.
TEST(ReferenceFilters, AreWhatTheirSourcesSay) {
  const std::map<std::string, std::array<double, 3>> at_whole_distances = {
      {"bilinear", {1, 0, 0}},    {"b-spline", {2. / 3, 1. / 6, 0}},
      {"catmull-rom", {1, 0, 0}}, {"mitchell", {8. / 9, 1. / 18, 0}},
      {"lanczos2", {1, 0, 0}},    {"lanczos3", {1, 0, 0}}};
  for (const reference::Filter& filter : reference::all_filters()) {
    const auto& expected = at_whole_distances.at(filter.name);
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_NEAR(filter.value(static_cast<double>(d)), expected[d], 1e-15) << filter.name << " at " << d;
    EXPECT_EQ(filter.value(filter.support), 0) << filter.name;
    EXPECT_EQ(filter.value(filter.support + .5), 0) << filter.name;
    // A windowed sinc does not quite sum to 1: of two lobes by .019, of three by .0058.
    const std::string name = filter.name;
    const double ripple = name == "lanczos2" ? .019 : name == "lanczos3" ? .0058 : 1e-14;
    double least = 0;
    for (double d = 0; d < filter.support; d += 0x1p-10) {
      const double value = filter.value(d);
      least = std::min(least, value);
      EXPECT_NEAR(value, filter.value(d + 1e-9), 1e-8) << filter.name << " at " << d;
      double sum = 0;
      for (int i = -4; i <= 4; ++i)
        sum += filter.value(std::abs(d - i));
      if (d < 1) {
        EXPECT_NEAR(sum, 1, ripple) << filter.name << " at " << d;
      }
    }
    EXPECT_EQ(least < -1e-12, filter.rings) << filter.name;
  }
}

std::vector<ScaleVariant> variants() {
  using enum Method;
  std::vector<ScaleVariant> all;
  for (const Method method :
       {kPoint, kBilinear, kBSpline, kCatmullRom, kMitchell, kLanczos2, kLanczos3, kNoise, kNoiseOffset}) {
    for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
      for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F, PixelFormat::kRGBA8}) {
        for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F})
          all.push_back({method, storage, colour, resolved});
      }
    }
    if (testing::rings(method)) all.push_back({.method = method, .clamp_ringing = false});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, Scale, ::testing::ValuesIn(variants()),
                         testing::sample_names(
                             variants(), [](const ScaleVariant& v) { return testing::name_of(v); },
                             [](const ScaleVariant& v) {
                               return std::string(name_of(v.method)) +
                                      (v.storage == Storage::kImage ? " image" : " buffer") +
                                      (v.colour == PixelFormat::kRGBA8 ? " encoded" : "");
                             }));

}  // namespace
}  // namespace quincunx
