// SPDX-License-Identifier: MIT
// velocity_from_depth: velocity from depth and the camera's motion.
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

using testing::FrameFormats;
using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

// With u = 2^-24: ndc is column * step + start, each rounded once, of at most 2 + 1: 4 roundings of at most
// 3, 12 u, where its own magnitude may be near 0; a sum of four products adds 4 u of the magnitudes; the
// division 2.5 ulp. `condition` is the largest sum of magnitudes over w, so x / w is within (12 + 4 + 2
// * 2.5)
// * u of twice that (numerator and w); the final difference and factor are exact or within one rounding each.
constexpr double kVelocityError = (2 * (12 + 4) + 5 + 2) * 0x1p-24;
// Where w has lost this much to cancellation its sign is not certain.
constexpr double kCancelled = kVelocityError;

struct Variant {
  Storage storage;
  PixelFormat velocity;
};

// A turn and a step forward: uv change over the picture and with depth.
constexpr std::array<float, 16> kCameraStep = {1.0f,  0.01f,  0, 0.02f, -0.01f, 1.0f,   0, 0.005f,
                                               0.03f, -0.02f, 1, 0.01f, 0.004f, 0.006f, 0, 1.0f};
// A turn of more than a right angle: much of the picture was behind the camera.
constexpr std::array<float, 16> kAboutTurn = {-0.2f, 0, 0, -0.98f, 0,     1, 0, 0,
                                              0,     0, 1, 0,      0.98f, 0, 0, -0.2f};

class Velocity : public ::testing::TestWithParam<Variant> {
 protected:
  Velocity() {
    settings_.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    pass_ = std::make_unique<PassRig>(SceneNeeds{.moving_objects = false}, settings_, "velocity_from_depth");
  }

  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::array<float, 16>& camera = kCameraStep) const {
    TestFrame made = make_frame(rig, {.storage = settings_.storage, .with_depth = true}, spec);
    made.inputs.camera.clip_to_previous_clip = camera;
    std::copy(camera.begin(), camera.end(), made.reference.clip_to_previous_clip.begin());
    return made;
  }

  std::vector<unsigned char> run(Rig& rig, const TestFrame& frame, bool tight = false) {
    const Extent render = frame.inputs.render;
    const std::vector<Pixel> before(static_cast<std::size_t>(render.area()), Pixel{-7, -7, -7, -7});
    const ImageView view = rig.image(settings_.velocity, settings_.storage, render, before, -7, tight);
    pass_->run(frame.inputs, {}, {1, 1}, {}, {{Resource::kVelocity, view}});
    const Extent target = view.extent;
    const std::vector<Pixel> all = rig.pixels(view, target);
    for (int y = 0; y < target.height; ++y) {
      for (int x = 0; x < target.width; ++x) {
        if (x < render.width && y < render.height) continue;
        EXPECT_EQ(all[static_cast<std::size_t>(y * target.width + x)][0], -7) << "beyond the viewport";
      }
    }
    return rig.bytes(view, render);
  }

  void compare(const FrameSpec& spec, const std::array<float, 16>& camera) {
    Rig rig;
    const TestFrame made = frame(rig, spec, camera);
    const std::vector<Pixel> actual = testing::decode(settings_.velocity, run(rig, made));
    const auto expected = reference::velocity_from_depth(made.reference);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const reference::CameraVelocity& wanted = expected[i];
      if (std::abs(wanted.w_part) < kCancelled && std::isfinite(wanted.velocity[0])) continue;
      for (std::size_t c = 0; c < 2; ++c) {
        if (std::isnan(wanted.velocity[c])) {
          ASSERT_TRUE(std::isnan(actual[i][c])) << i;
          continue;
        }
        const double magnitude = std::abs(wanted.velocity[c]);
        const double rounding = testing::velocity_rounding(settings_.velocity, settings_.storage, magnitude);
        const double bound = kVelocityError * wanted.condition + rounding;
        testing::record_error({.error = std::abs(actual[i][c] - wanted.velocity[c]),
                               .bound = bound,
                               .largest = wanted.condition,
                               .stored = settings_.velocity});
        ASSERT_NEAR(actual[i][c], wanted.velocity[c], bound)
            << spec.render.width << "x" << spec.render.height << ", texel " << i;
      }
    }
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

TEST_P(Velocity, MatchesTheReference) {
  unsigned seed = 0;
  for (const Extent render : {Extent{1, 1}, {2, 3}, {3, 2}, {7, 5}, {64, 64}, {257, 129}, {8192, 3}}) {
    // Images end at 8192 on some devices, the margin included.
    if (render.width == 8192 && settings_.storage == Storage::kImage) continue;
    for (const Pattern depth : {Pattern::kConstant, Pattern::kRamp, Pattern::kNoise, Pattern::kNonFinite}) {
      for (const auto& camera : {kCameraStep, kAboutTurn, CameraMotion{}.clip_to_previous_clip}) {
        compare({.render = render, .jitter = {.25f, -.5f}, .velocity = depth, .seed = ++seed}, camera);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(Velocity, ACameraThatStandsStillGivesZero) {
  // To a few ulp of ndc: x / w is the same number again.
  Rig rig;
  const TestFrame made = frame(rig, {.render = {61, 43}}, CameraMotion{}.clip_to_previous_clip);
  for (const Pixel& pixel : testing::decode(settings_.velocity, run(rig, made))) {
    ASSERT_NEAR(pixel[0], 0, 2 * 0x1p-24);
    ASSERT_NEAR(pixel[1], 0, 2 * 0x1p-24);
  }
}

TEST_P(Velocity, PoisonOutsideTheViewportChangesNoBit) {
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
TEST_P(Velocity, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {13, 7}, {16, 2}}) {
    Rig rig;
    FrameSpec spec{.render = render};
    const auto roomy = run(rig, frame(rig, spec));
    spec.tight = true;
    EXPECT_EQ(roomy, run(rig, frame(rig, spec), true));
  }
}

TEST_P(Velocity, TwoRunsAgreeBitForBit) {
  Rig rig;
  const TestFrame made = frame(rig, {.render = {183, 92}, .velocity = Pattern::kNonFinite});
  EXPECT_EQ(run(rig, made), run(rig, made));
}

INSTANTIATE_TEST_SUITE_P(Variants, Velocity,
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
