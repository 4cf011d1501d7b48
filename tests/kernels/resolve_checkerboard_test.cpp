// SPDX-License-Identifier: MIT
// resolve_checkerboard: the other half of a frame in which every other pixel is shaded.
#include "../reference/resolve_checkerboard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "expected.h"
#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// Error of a velocity from depth, over its condition: tests/kernels/velocity_from_depth_test.cpp.
constexpr double kCameraError = (2 * (12 + 4) + 5 + 2) * 0x1p-24;

// A turn and a step forward.
constexpr std::array<float, 16> kCameraStep = {1.0f,  0.01f,  0, 0.02f, -0.01f, 1.0f,   0, 0.005f,
                                               0.03f, -0.02f, 1, 0.01f, 0.004f, 0.006f, 0, 1.0f};

enum class Moves { kNothing, kCamera, kAll };

struct Variant {
  Storage storage;
  PixelFormat colour;
  PixelFormat velocity;
  Moves moves;
  bool keeps_velocity;  // for later passes
  bool reactive;
};

// Returns the value of a texel that nothing has written to.
double untouched_value(PixelFormat format) {
  return format == PixelFormat::kRGBA8 || format == PixelFormat::kR8 ? .2 : -7;
}

// RGBA8 colour is mixed as codes.
double in_codes(double stored) {
  return std::round(255 * stored);
}

struct Filled {
  ImageView colour, depth, velocity, reactive;
};

class Checkerboard : public ::testing::TestWithParam<Variant> {
 protected:
  Checkerboard() {
    const Variant& v = GetParam();
    settings_.method = v.keeps_velocity ? Method::kQuincunx : Method::kBilinear;
    settings_.targets.shading = Shading::kCheckerboard;
    settings_.targets.storage = v.storage;
    settings_.colour = v.colour;
    settings_.velocity = v.velocity;
    const SceneNeeds needs{.moving_objects = v.moves == Moves::kAll,
                           .camera_motion = v.moves != Moves::kNothing,
                           .transparents = v.reactive};
    pass_ = std::make_unique<PassRig>(needs, settings_, "resolve_checkerboard");
  }

  // Surfaces in blocks of 4 x 3 pixels of a picture of 16 x 12, at three distances, each a slanting plane: those of two
  // frames agree in most places.
  std::vector<Pixel> depths(const FrameSpec& spec, bool non_finite) const {
    std::vector<Pixel> made;
    std::mt19937 random(spec.seed);
    for (int y = 0; y < spec.render.height; ++y) {
      for (int x = 0; x < spec.render.width; ++x) {
        const double u = (x + .5) / spec.render.width, v = (y + .5) / spec.render.height;
        const unsigned block = static_cast<unsigned>(u * 4) * 7 + static_cast<unsigned>(v * 4) * 3;
        double depth = block % 3 == 0 ? 0 : block % 3 == 1 ? .1 + .02 * u : .3 - .05 * v;
        if (non_finite && random() % 16 == 0) depth = random() % 2 == 0 ? std::nan("") : HUGE_VAL;
        made.push_back({depth, 0, 0, 0});
      }
    }
    return made;
  }

  // Depth of surfaces instead of a pattern's, and `unshaded` in all targets where nothing is shaded.
  TestFrame frame(Rig& rig, const FrameSpec& spec, int parity, bool filled,
                  double unshaded = std::nan("")) const {
    const Variant& v = GetParam();
    TestFrame made = make_frame(rig,
                                {.storage = v.storage,
                                 .colour = v.colour,
                                 .velocity = v.velocity,
                                 .with_velocity = true,
                                 .with_depth = true,
                                 .with_reactive = v.reactive},
                                spec);
    made.inputs.parity = parity;
    made.inputs.camera.clip_to_previous_clip = kCameraStep;
    std::copy(kCameraStep.begin(), kCameraStep.end(), made.reference.clip_to_previous_clip.begin());
    std::vector<Pixel> colour = made.reference.colour;
    if (v.colour == PixelFormat::kRGBA8) {
      for (Pixel& pixel : made.reference.colour) {
        for (double& value : pixel)
          value = in_codes(testing::stored_value(v.colour, value));
      }
    }
    std::vector<Pixel> depth = depths(spec, spec.velocity == Pattern::kNonFinite), velocity, reactive;
    std::mt19937 random(spec.seed);
    for (std::size_t i = 0; i < colour.size(); ++i) {
      const int x = static_cast<int>(i) % spec.render.width, y = static_cast<int>(i) / spec.render.width;
      const bool hole = !filled && (x + y) % 2 != parity;
      if (hole) colour[i] = {unshaded, unshaded, unshaded, unshaded};
      if (hole) depth[i][0] = unshaded;
      const auto& moved = made.reference.velocity[i];
      velocity.push_back(hole ? colour[i] : Pixel{moved[0], moved[1], 0, 0});
      if (v.reactive) {
        if (random() % 8 != 0) made.reference.reactive[i] = 0;
        reactive.push_back({hole ? 1 : made.reference.reactive[i], 0, 0, 0});
      }
      made.reference.depth[i] = testing::stored_value(PixelFormat::kR32F, depth[i][0]);
    }
    const auto put = [&](PixelFormat format, const std::vector<Pixel>& pixels) {
      return rig.image(format, v.storage, spec.render, pixels, spec.outside, spec.tight);
    };
    made.inputs.colour = put(v.colour, colour);
    made.inputs.depth = put(PixelFormat::kR32F, depth);
    made.inputs.velocity = put(v.velocity, velocity);
    if (v.reactive) made.inputs.reactive = put(PixelFormat::kR8, reactive);
    return made;
  }

  Filled run(Rig& rig, const TestFrame& now, const TestFrame& before, bool tight = false) {
    const Extent render = now.inputs.render_extent;
    const auto output = [&](PixelFormat format) {
      const double value = untouched_value(format);
      const std::vector<Pixel> untouched(static_cast<std::size_t>(render.area()),
                                         Pixel{value, value, value, value});
      return rig.image(format, settings_.targets.storage, render, untouched, value, tight);
    };
    const Filled filled = {output(settings_.colour), output(PixelFormat::kR32F), output(settings_.velocity),
                           output(PixelFormat::kR8)};
    pass_->run(now.inputs, before.inputs, {1, 1}, {},
               {{Resource::kColour, filled.colour},
                {Resource::kDepth, filled.depth},
                {Resource::kVelocity, filled.velocity},
                {Resource::kReactive, filled.reactive}});
    for (const ImageView& view : {filled.colour, filled.depth, filled.velocity}) {
      const std::vector<Pixel> all = rig.pixels(view, view.extent);
      for (int i = 0; i < view.extent.area(); ++i) {
        const int x = i % view.extent.width, y = i / view.extent.width;
        if (x < render.width && y < render.height) continue;
        EXPECT_EQ(all[static_cast<std::size_t>(i)][0], untouched_value(view.format)) << "beyond the viewport";
      }
    }
    return filled;
  }

  // Returns the bits of all targets.
  std::vector<unsigned char> bits(const Rig& rig, const Filled& filled, Extent render) const {
    std::vector<unsigned char> all;
    for (const ImageView& view : {filled.colour, filled.depth, filled.velocity, filled.reactive}) {
      const auto bytes = rig.bytes(view, render);
      all.insert(all.end(), bytes.begin(), bytes.end());
    }
    return all;
  }

  std::vector<unsigned char> run_bits(Rig& rig, const TestFrame& now, const TestFrame& before,
                                      bool tight = false) {
    return bits(rig, run(rig, now, before, tight), now.inputs.render_extent);
  }

  void compare(const FrameSpec& spec, const FrameSpec& spec_before, int parity);

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
  std::int64_t compared_ = 0, undecided_ = 0, trusted_ = 0, hidden_ = 0, unknown_ = 0;
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void Checkerboard::compare(const FrameSpec& spec, const FrameSpec& spec_before, int parity) {
  Rig rig;
  const Variant& v = GetParam();
  const TestFrame now = frame(rig, spec, parity, false), before = frame(rig, spec_before, parity, true);
  const Filled filled = run(rig, now, before);
  std::vector<Pixel> colour = rig.pixels(filled.colour, spec.render);
  for (std::size_t i = 0; v.colour == PixelFormat::kRGBA8 && i < colour.size(); ++i)
    std::transform(colour[i].begin(), colour[i].end(), colour[i].begin(), in_codes);
  // In codes; expect_near() knows what other formats round.
  const double rounding = v.colour == PixelFormat::kRGBA8 ? .5 : 0;
  const std::vector<Pixel> depth = rig.pixels(filled.depth, spec.render);
  const std::vector<Pixel> velocity = rig.pixels(filled.velocity, spec.render);
  const std::vector<Pixel> reactive = rig.pixels(filled.reactive, spec.render);
  reference::CheckerboardInputs in{.current = now.reference,
                                   .parity = parity,
                                   .previous = before.reference,
                                   .reactive = v.reactive,
                                   .moves = v.moves == Moves::kAll};
  if (v.moves == Moves::kCamera) move_camera(in, kCameraError);
  for (int y = 0; y < spec.render.height; ++y) {
    for (int x = 0; x < spec.render.width; ++x) {
      const std::size_t i = reference::index_of(spec.render.width, x, y);
      const std::string what = fmt::format("{}x{} ({}, {})", spec.render.width, spec.render.height, x, y);
      std::size_t from = i;
      if ((x + y) % 2 == parity) {
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_TRUE(same(colour[i][c], now.reference.colour[i][c])) << what;
      } else {
        const auto [value, bound, undecided] = reference::expected_of(
            [&](auto zero) { return reference::resolve_checkerboard<decltype(zero)>(in, x, y); });
        ++compared_;
        undecided_ += undecided ? 1 : 0;
        if (undecided) continue;
        trusted_ += value.near_trust > .5 ? 1 : 0;
        hidden_ += value.near_trust < .5 && value.far_trust > .5 ? 1 : 0;
        unknown_ += value.near_trust == 0 && value.far_trust == 0 ? 1 : 0;
        for (std::size_t c = 0; c < 4; ++c) {
          reference::Bounded rounded = bound.colour[c];
          rounded.error += rounding;
          testing::expect_near(value.colour[c], rounded, colour[i][c], what, v.colour, v.storage);
          if (HasFatalFailure()) return;
        }
        from = reference::index_of(spec.render.width, value.x, value.y);
      }
      ASSERT_TRUE(same(depth[i][0], now.reference.depth[from])) << what;
      if (v.keeps_velocity && v.moves == Moves::kAll) {
        ASSERT_TRUE(same(velocity[i][0], now.reference.velocity[from][0])) << what;
        ASSERT_TRUE(same(velocity[i][1], now.reference.velocity[from][1])) << what;
      }
      if (!v.reactive) continue;
      ASSERT_EQ(reactive[i][0], now.reference.reactive[from]) << what;
    }
  }
}

TEST_P(Checkerboard, MatchesTheReference) {
  unsigned seed = 0;
  for (const Extent render : {Extent{1, 2}, {2, 1}, {1, 7}, {9, 1}, {7, 5}, {64, 64}, {129, 33}}) {
    for (const Pattern pattern : testing::all_patterns()) {
      for (const int parity : {0, 1}) {
        const Pattern motion = pattern == Pattern::kNonFinite ? Pattern::kNonFinite : Pattern::kNoise;
        FrameSpec now{.render = render, .colour = pattern, .velocity = motion, .seed = ++seed};
        now.outside = std::nan("");
        now.speed = .01;
        FrameSpec before = now;
        before.seed = ++seed;
        compare(now, before, parity);  // the same places
        if (HasFatalFailure()) return;
        now.jitter = {.25f, -.125f};
        before.jitter = {-.25f, .375f};
        before.render = {std::max(render.width - 2, 1), render.height + 3};
        compare(now, before, parity);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_LT(undecided_, compared_ / 16) << "of " << compared_;
  EXPECT_GT(trusted_, compared_ / 8) << "of " << compared_;
  EXPECT_GT(hidden_, compared_ / 512) << "of " << compared_;
  EXPECT_GT(unknown_, compared_ / 64) << "of " << compared_;
}

TEST_P(Checkerboard, PoisonOutsideTheViewportAndInPixelsThatAreNotShadedChangesNoBit) {
  for (const Extent render : {Extent{1, 2}, {1, 9}, {9, 1}, {45, 23}}) {
    for (const int parity : {0, 1}) {
      Rig rig;
      FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}};
      const auto clean = run_bits(rig, frame(rig, spec, parity, false, 0), frame(rig, spec, parity, true));
      for (const double poison : testing::kPoisons) {
        spec.outside = poison;
        EXPECT_EQ(clean,
                  run_bits(rig, frame(rig, spec, parity, false, poison), frame(rig, spec, parity, true)));
      }
    }
  }
}

// Under a memory checker this also shows that nothing beyond the viewport is read or written.
TEST_P(Checkerboard, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 2}, {1, 9}, {9, 1}, {13, 7}, {16, 2}}) {
    for (const int parity : {0, 1}) {
      Rig rig;
      FrameSpec spec{.render = render};
      const auto roomy = run_bits(rig, frame(rig, spec, parity, false), frame(rig, spec, parity, true));
      spec.tight = true;
      EXPECT_EQ(roomy, run_bits(rig, frame(rig, spec, parity, false), frame(rig, spec, parity, true), true));
    }
  }
}

TEST_P(Checkerboard, TwoRunsAgreeBitForBit) {
  Rig rig;
  const FrameSpec spec{.render = {183, 92}, .colour = Pattern::kNonFinite, .velocity = Pattern::kNonFinite};
  const TestFrame now = frame(rig, spec, 1, false), before = frame(rig, spec, 1, true);
  EXPECT_EQ(run_bits(rig, now, before), run_bits(rig, now, before));
}

const std::vector<Variant> kVariants = {
    {Storage::kBuffer, PixelFormat::kRGBA16F, PixelFormat::kRG16F, Moves::kAll, true, true},
    {Storage::kBuffer, PixelFormat::kRGBA16F, PixelFormat::kRG16F, Moves::kAll, false, false},
    {Storage::kBuffer, PixelFormat::kRGBA32F, PixelFormat::kRG32F, Moves::kAll, true, false},
    {Storage::kBuffer, PixelFormat::kRGBA16F, PixelFormat::kRG16F, Moves::kCamera, false, false},
    {Storage::kBuffer, PixelFormat::kRGBA32F, PixelFormat::kRG16F, Moves::kNothing, false, true},
    {Storage::kBuffer, PixelFormat::kRGBA8, PixelFormat::kRG16F, Moves::kAll, true, true},
    {Storage::kImage, PixelFormat::kRGBA16F, PixelFormat::kRG16F, Moves::kAll, true, true},
    {Storage::kImage, PixelFormat::kRGBA8, PixelFormat::kRG16F, Moves::kCamera, false, false}};
INSTANTIATE_TEST_SUITE_P(Variants, Checkerboard, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return fmt::format("{}{}{}_{}_{}_{}",
                                              v.moves == Moves::kAll      ? "moving"
                                              : v.moves == Moves::kCamera ? "camera"
                                                                          : "still",
                                              v.keeps_velocity ? "_velocity" : "",
                                              v.reactive ? "_reactive" : "",
                                              v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.colour), name_of(v.velocity));
                         }));

}  // namespace
}  // namespace quincunx
