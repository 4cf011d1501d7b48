// SPDX-License-Identifier: MIT
// velocity_from_depth: velocity from depth and the camera's motion.
#include <algorithm>
#include <cmath>

#include "error_table.h"
#include "velocity_test_base.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::kAboutTurn;
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

// A turn and a step forward: uv change over the picture and with depth.
constexpr std::array<float, 16> kCameraStep = {1.0f,  0.01f,  0, 0.02f, -0.01f, 1.0f,   0, 0.005f,
                                               0.03f, -0.02f, 1, 0.01f, 0.004f, 0.006f, 0, 1.0f};
class Velocity : public testing::VelocityTest {
 protected:
  Velocity() : VelocityTest(SceneNeeds{.moving_objects = false}, {}, "velocity_from_depth") {}

  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::array<float, 16>& camera = kCameraStep) const {
    TestFrame made = make_frame(rig, {.storage = settings_.targets.storage, .with_depth = true}, spec);
    made.inputs.camera.clip_to_previous_clip = camera;
    std::copy(camera.begin(), camera.end(), made.reference.clip_to_previous_clip.begin());
    return made;
  }

  TestFrame turned_frame(Rig& rig, const FrameSpec& spec) const override { return frame(rig, spec); }

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
        const double rounding =
            testing::velocity_rounding(settings_.velocity, settings_.targets.storage, magnitude);
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
};

TEST_P(Velocity, MatchesTheReference) {
  unsigned seed = 0;
  for (const Extent render : {Extent{1, 1}, {2, 3}, {3, 2}, {7, 5}, {64, 64}, {257, 129}, {8192, 3}}) {
    // Images end at 8192 on some devices, the margin included.
    if (render.width == 8192 && settings_.targets.storage == Storage::kImage) continue;
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
  poison_changes_no_bit();
}

TEST_P(Velocity, ATightImageGivesTheSameBits) {
  a_tight_image_gives_the_same_bits();
}

TEST_P(Velocity, TwoRunsAgreeBitForBit) {
  two_runs_agree_bit_for_bit();
}

INSTANTIATE_TEST_SUITE_P(Variants, Velocity, testing::velocity_variants(), testing::variant_name);

}  // namespace
}  // namespace quincunx
