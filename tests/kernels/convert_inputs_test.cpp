// SPDX-License-Identifier: MIT
// convert_inputs: depth, velocity and rows of other conventions.
#include <array>
#include <cmath>
#include <limits>

#include "error_table.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::Pattern;
using testing::Pixel;
using testing::Rig;

constexpr double kUnit = 0x1p-24;
// Between planes reversed + (1 - reversed) * near / far: four operations and the rounded quotient, each within u of the
// magnitudes of both terms. A distance: a quotient within 2.5 last places.
constexpr double kDepthError = 5 * kUnit;
// The jitter is rounded three times, the difference once.
constexpr double kVelocityError = 3 * kUnit;
constexpr double kFlushed = 0x1p-126;

constexpr Extent kSizes[] = {{1, 1}, {7, 5}, {64, 64}, {257, 129}};
constexpr Vec2 kJitter = {.25f, -.4375f}, kPreviousJitter = {-.5f, .1875f};

struct Variant {
  Storage storage;
  PixelFormat velocity;
};

class ConvertInputs : public ::testing::TestWithParam<Variant> {
 protected:
  // Runs the pass that makes `made` from `given`. What is not made stays.
  std::vector<unsigned char> run(Rig& rig, const InputConventions& conventions, FrameInputs inputs,
                                 Resource made, PixelFormat format, bool tight = false) const {
    const ResolveSettings settings = {.method = Method::kTemporal,
                                      .velocity = GetParam().velocity,
                                      .conventions = conventions,
                                      .targets = {.storage = GetParam().storage}};
    testing::PassRig pass({}, settings, "convert_inputs");
    inputs.jitter = kJitter;
    const FrameInputs previous = {.render_extent = {100, 75}, .jitter = kPreviousJitter};
    const std::vector<Pixel> before(static_cast<std::size_t>(inputs.render_extent.area()),
                                    Pixel{-7, -7, -7, -7});
    const ImageView view =
        rig.image(format, settings.targets.storage, inputs.render_extent, before, -7, tight);
    pass.run(inputs, previous, {1, 1}, {}, {{made, view}});
    const std::vector<Pixel> all = rig.pixels(view, view.extent);
    for (int y = 0; y < view.extent.height; ++y) {
      for (int x = 0; x < view.extent.width; ++x) {
        if (x >= inputs.render_extent.width || y >= inputs.render_extent.height) {
          EXPECT_EQ(all[static_cast<std::size_t>(y * view.extent.width + x)][0], -7) << "beyond the viewport";
        }
      }
    }
    return rig.bytes(view, inputs.render_extent);
  }

  ImageView image(Rig& rig, PixelFormat format, Extent render, const std::vector<Pixel>& pixels,
                  double outside = 0, bool tight = false) const {
    return rig.image(format, GetParam().storage, render, pixels, outside, tight);
  }

  void compare_depth(Extent render, const std::vector<Pixel>& given, DepthConvention kind, float near_plane,
                     float far_plane) const {
    Rig rig;
    FrameInputs inputs = {.render_extent = render, .near_plane = near_plane, .far_plane = far_plane};
    inputs.depth = image(rig, PixelFormat::kR32F, render, given);
    const auto actual = testing::decode(
        PixelFormat::kR32F, run(rig, {.depth = kind}, inputs, Resource::kDepth, PixelFormat::kR32F));
    const bool between = needs_far_plane(kind), forward = kind == DepthConvention::kForward;
    const double far = between ? static_cast<double>(far_plane) : std::numeric_limits<double>::infinity();
    const double near = between ? static_cast<double>(near_plane) : 1;
    for (std::size_t i = 0; i < given.size(); ++i) {
      const double depth = testing::stored_value(PixelFormat::kR32F, given[i][0]);
      const bool linear = kind == DepthConvention::kLinear;
      const double expected = linear ? reference::depth_of_distance(depth, near_plane)
                                     : reference::depth_between_planes(
                                           depth, forward || kind == DepthConvention::kInfinite, near, far);
      if (!std::isfinite(expected)) {
        ASSERT_FALSE(std::isfinite(actual[i][0])) << i;
        continue;
      }
      const double terms = linear ? std::abs(expected) : 1 + std::abs(depth);
      const double bound = kDepthError * terms + kFlushed;
      testing::record_error({.error = std::abs(actual[i][0] - expected), .bound = bound, .largest = terms});
      ASSERT_NEAR(actual[i][0], expected, bound) << name_of(kind) << " " << depth;
      ASSERT_EQ(actual[i][0] == 0, expected == 0) << "what is farthest";
    }
  }
};

TEST_P(ConvertInputs, DepthMatchesTheReference) {
  for (const Extent render : kSizes) {
    for (const Pattern pattern : {Pattern::kConstant, Pattern::kRamp, Pattern::kNoise, Pattern::kNonFinite}) {
      std::vector<Pixel> given = testing::pattern_pixels(pattern, render, 5);
      for (std::size_t i = 0; i < given.size(); i += 5)
        given[i][0] = static_cast<double>(i / 5 % 2);
      compare_depth(render, given, DepthConvention::kReversed, .1f, 1000);
      compare_depth(render, given, DepthConvention::kForward, .1f, 1000);
      compare_depth(render, given, DepthConvention::kInfinite, 0, 0);
      for (Pixel& pixel : given)
        pixel[0] *= 1000;
      compare_depth(render, given, DepthConvention::kLinear, .1f, 0);
      if (HasFatalFailure()) return;
    }
  }
}

TEST_P(ConvertInputs, VelocityMatchesTheReference) {
  for (const Extent render : kSizes) {
    for (const Vec2 scale : {Vec2{}, Vec2{-.5f, .5f}}) {
      Rig rig;
      std::vector<Pixel> given = testing::pattern_pixels(Pattern::kNoise, render, 3);
      for (std::size_t i = 0; i < given.size(); i += 3)
        given[i] = {};
      FrameInputs inputs = {.render_extent = render, .velocity_scale = scale};
      inputs.velocity = image(rig, GetParam().velocity, render, given);
      const auto actual = testing::decode(GetParam().velocity, run(rig, {.velocity_jittered = true}, inputs,
                                                                   Resource::kVelocity, GetParam().velocity));
      const double to_uv[] = {scale == Vec2{} ? 1 : -.5, scale == Vec2{} ? 1 : .5};
      // The picture of a still surface lies at its place - jitter.
      const std::array<double, 2> jitter = {
          (kPreviousJitter.x / 100. - kJitter.x / static_cast<double>(render.width)) / to_uv[0],
          (kPreviousJitter.y / 75. - kJitter.y / static_cast<double>(render.height)) / to_uv[1]};
      for (std::size_t i = 0; i < given.size(); ++i) {
        std::array<double, 2> stored = {};
        for (std::size_t c = 0; c < 2; ++c)
          stored[c] = testing::stored_value(GetParam().velocity, given[i][c]);
        const auto expected = reference::unjittered(stored, jitter);
        for (std::size_t c = 0; c < 2; ++c) {
          const double bound =
              kVelocityError * std::abs(jitter[c]) +
              testing::velocity_rounding(GetParam().velocity, GetParam().storage, std::abs(expected[c])) +
              kUnit * std::abs(expected[c]) + kFlushed;
          testing::record_error({.error = std::abs(actual[i][c] - expected[c]),
                                 .bound = bound,
                                 .largest = std::abs(expected[c]),
                                 .stored = GetParam().velocity});
          ASSERT_NEAR(actual[i][c], expected[c], bound) << i;
        }
      }
    }
  }
}

// Of buffers no pass is needed for that.
TEST_P(ConvertInputs, RowsOfImagesAreTurnedBitForBit) {
  if (GetParam().storage == Storage::kBuffer) return;
  for (const Extent render : kSizes) {
    Rig rig;
    const std::vector<Pixel> given = testing::pattern_pixels(Pattern::kExtremes, render, 4);
    FrameInputs inputs = {.render_extent = render};
    inputs.colour = image(rig, PixelFormat::kRGBA16F, render, given, 3);
    const auto upright = rig.bytes(inputs.colour, render);
    const auto turned =
        run(rig, {.origin = Origin::kBottom}, inputs, Resource::kColour, PixelFormat::kRGBA16F);
    const std::size_t row = upright.size() / static_cast<std::size_t>(render.height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(render.height); ++y) {
      const auto from = upright.begin() + static_cast<std::ptrdiff_t>(y * row);
      const auto to = turned.end() - static_cast<std::ptrdiff_t>((y + 1) * row);
      ASSERT_TRUE(std::equal(from, from + static_cast<std::ptrdiff_t>(row), to)) << y;
    }
  }
}

TEST_P(ConvertInputs, NothingOutsideTheViewportMatters) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {45, 23}}) {
    struct {
      double outside = 0;
      bool tight = false;
    } spec;
    testing::expect_same_whatever_is_outside(spec, [&] {
      Rig rig;
      FrameInputs inputs = {.render_extent = render, .near_plane = .1f, .far_plane = 50};
      inputs.depth = image(rig, PixelFormat::kR32F, render,
                           testing::pattern_pixels(Pattern::kNoise, render, 2), spec.outside, spec.tight);
      return run(rig, {.depth = DepthConvention::kForward}, inputs, Resource::kDepth, PixelFormat::kR32F,
                 spec.tight);
    });
  }
}

const std::vector<Variant> kVariants = {{Storage::kBuffer, PixelFormat::kRG16F},
                                        {Storage::kBuffer, PixelFormat::kRG32F},
                                        {Storage::kImage, PixelFormat::kRG16F}};

INSTANTIATE_TEST_SUITE_P(Variants, ConvertInputs, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return std::string(v.storage == Storage::kImage ? "image_" : "buffer_") +
                                  name_of(v.velocity);
                         }));

}  // namespace
}  // namespace quincunx
