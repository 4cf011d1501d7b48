// SPDX-License-Identifier: MIT
// far_velocity: what is infinitely far away and was drawn without motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "error_table.h"
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

// That of velocity_from_depth, whose formula it is, and the product with the units and their own rounding.
constexpr double kError = (2 * (12 + 4) + 5 + 2 + 2) * 0x1p-24;

struct Variant {
  Storage storage;
  PixelFormat velocity;
};

// A turn with some roll, and one of more than a right angle, which leaves much of the picture behind the camera.
constexpr std::array<float, 16> kTurn = {1.0f, 0.01f, 0, 0.02f, -0.01f, 1.0f,  0, 0.005f,
                                         0.3f, -0.2f, 1, 0.1f,  0.04f,  0.06f, 0, 1.0f};
constexpr std::array<float, 16> kAboutTurn = {-0.2f, 0, 0, -0.98f, 0,     1, 0, 0,
                                              0,     0, 1, 0,      0.98f, 0, 0, -0.2f};

class FarVelocityPass : public ::testing::TestWithParam<Variant> {
 protected:
  FarVelocityPass() {
    settings_.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    settings_.far = FarMotion::kCamera;
    pass_ = std::make_unique<PassRig>(SceneNeeds{}, settings_, "far_velocity");
  }

  // Of a pattern of velocities and depths every third sample is far and without motion, every fifth far and every
  // seventh without motion.
  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::array<float, 16>& camera = kTurn,
                  Vec2 scale = {}) const {
    TestFrame made = make_frame(rig,
                                {.storage = settings_.storage,
                                 .velocity = settings_.velocity,
                                 .with_velocity = true,
                                 .with_depth = true},
                                spec);
    std::vector<Pixel> velocity, depth;
    for (std::size_t i = 0; i < made.reference.depth.size(); ++i) {
      auto& drawn = made.reference.velocity[i];
      double& distance = made.reference.depth[i];
      if (i % 3 == 0 || i % 5 == 0) distance = i % 2 == 0 ? 0 : static_cast<double>(1e-10f);
      if (i % 3 == 0 || i % 7 == 0) drawn = {0, i % 2 == 0 ? 0. : -0.};
      velocity.push_back({drawn[0], drawn[1], 0, 0});
      depth.push_back({distance, 0, 0, 0});
    }
    const auto put = [&](PixelFormat format, const std::vector<Pixel>& pixels) {
      return rig.image(format, settings_.storage, spec.render, pixels, spec.outside, spec.tight);
    };
    made.inputs.velocity = put(settings_.velocity, velocity);
    made.inputs.depth = put(PixelFormat::kR32F, depth);
    made.inputs.velocity_scale = scale;
    if (scale != Vec2{}) made.reference.velocity_scale = {scale.x, scale.y};
    made.inputs.camera.clip_to_previous_clip = camera;
    std::copy(camera.begin(), camera.end(), made.reference.clip_to_previous_clip.begin());
    return made;
  }

  std::vector<unsigned char> run(Rig& rig, const TestFrame& frame, bool tight = false) {
    const Extent render = frame.inputs.render;
    const std::vector<Pixel> before(static_cast<std::size_t>(render.area()), Pixel{-7, -7, -7, -7});
    const ImageView view = rig.image(settings_.velocity, settings_.storage, render, before, -7, tight);
    pass_->run(frame.inputs, {}, {1, 1}, {}, {{Resource::kVelocity, view}});
    const std::vector<Pixel> all = rig.pixels(view, view.extent);
    for (int y = 0; y < view.extent.height; ++y) {
      for (int x = 0; x < view.extent.width; ++x) {
        if (x < render.width && y < render.height) continue;
        EXPECT_EQ(all[static_cast<std::size_t>(y * view.extent.width + x)][0], -7) << "beyond the viewport";
      }
    }
    return rig.bytes(view, render);
  }

  void compare(const FrameSpec& spec, const std::array<float, 16>& camera, Vec2 scale) {
    Rig rig;
    const TestFrame made = frame(rig, spec, camera, scale);
    const std::vector<Pixel> actual = testing::decode(settings_.velocity, run(rig, made));
    const auto expected = reference::far_velocity(made.reference);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const reference::FarVelocity& wanted = expected[i];
      if (wanted.is_from_camera && std::abs(wanted.w_part) < kError) continue;  // its sign is not certain
      for (std::size_t c = 0; c < 2; ++c) {
        if (!wanted.is_from_camera) {
          const bool same = actual[i][c] == wanted.velocity[c] ||
                            (std::isnan(actual[i][c]) && std::isnan(wanted.velocity[c]));
          ASSERT_TRUE(same) << i << ": a drawn velocity of " << wanted.velocity[c] << " became "
                            << actual[i][c];
          continue;
        }
        const double units = 1 / std::abs(made.reference.velocity_scale[c]);
        const double magnitude = std::abs(wanted.velocity[c]);
        const double rounding = testing::velocity_rounding(settings_.velocity, settings_.storage, magnitude);
        const double bound = kError * wanted.condition * units + rounding;
        testing::record_error({.error = std::abs(actual[i][c] - wanted.velocity[c]),
                               .bound = bound,
                               .largest = wanted.condition * units,
                               .stored = settings_.velocity});
        ASSERT_NEAR(actual[i][c], wanted.velocity[c], bound)
            << spec.render.width << "x" << spec.render.height << ", texel " << i;
      }
    }
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

TEST_P(FarVelocityPass, MatchesTheReference) {
  unsigned seed = 0;
  for (const Extent render : {Extent{1, 1}, {2, 3}, {3, 2}, {7, 5}, {64, 64}, {257, 129}}) {
    for (const Pattern values : {Pattern::kConstant, Pattern::kRamp, Pattern::kNoise, Pattern::kNonFinite}) {
      for (const auto& camera : {kTurn, kAboutTurn, CameraMotion{}.clip_to_previous_clip}) {
        for (const Vec2 scale : {Vec2{}, Vec2{-1.f / 640, -1.f / 360}, Vec2{.5f, -.5f}}) {
          compare({.render = render, .jitter = {.25f, -.5f}, .velocity = values, .seed = ++seed}, camera,
                  scale);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST_P(FarVelocityPass, AScaleOfZeroKeepsEverythingStill) {
  Rig rig;
  const TestFrame made = frame(rig, {.render = {19, 7}}, kTurn, {0, 1});
  const std::vector<Pixel> actual = testing::decode(settings_.velocity, run(rig, made));
  for (std::size_t i = 0; i < actual.size(); i += 3) {
    ASSERT_EQ(actual[i][0], 0) << i;
    ASSERT_NE(actual[i][1], 0) << i;
  }
}

TEST_P(FarVelocityPass, PoisonOutsideTheViewportChangesNoBit) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {45, 23}}) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}};
    const auto clean = run(rig, frame(rig, spec));
    for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
      spec.outside = poison;
      EXPECT_EQ(clean, run(rig, frame(rig, spec)));
    }
  }
}

// Under a memory checker this also shows that nothing beyond the viewport is read or written.
TEST_P(FarVelocityPass, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {13, 7}, {16, 2}}) {
    Rig rig;
    FrameSpec spec{.render = render};
    const auto roomy = run(rig, frame(rig, spec));
    spec.tight = true;
    EXPECT_EQ(roomy, run(rig, frame(rig, spec), true));
  }
}

TEST_P(FarVelocityPass, TwoRunsAgreeBitForBit) {
  Rig rig;
  const TestFrame made = frame(rig, {.render = {183, 92}, .velocity = Pattern::kNonFinite});
  EXPECT_EQ(run(rig, made), run(rig, made));
}

INSTANTIATE_TEST_SUITE_P(Variants, FarVelocityPass,
                         ::testing::Values(Variant{Storage::kBuffer, PixelFormat::kRG16F},
                                           Variant{Storage::kBuffer, PixelFormat::kRG32F},
                                           Variant{Storage::kImage, PixelFormat::kRG16F}),
                         [](const auto& instance) {
                           const Variant& v = instance.param;
                           return fmt::format("{}_{}", v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.velocity));
                         });

}  // namespace
}  // namespace quincunx
