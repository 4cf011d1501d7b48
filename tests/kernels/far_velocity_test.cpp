// SPDX-License-Identifier: MIT
// far_velocity: what is infinitely far away and was drawn without motion.
#include "completed_velocity.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::kAboutTurn;
using testing::kTurn;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

class FarVelocityPass : public testing::CompletedVelocityTest {
 protected:
  FarVelocityPass()
      : CompletedVelocityTest({.conventions = {.sky_motion = SkyMotion::kCamera}}, "far_velocity") {}

  // Makes every third sample of a pattern of velocities and depths far and without motion, every fifth far and every
  // seventh without motion.
  void paint(reference::Frame& frame, const FrameSpec&) const override {
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      if (i % 3 == 0 || i % 5 == 0) frame.depth[i] = i % 2 == 0 ? 0 : static_cast<double>(1e-10f);
      if (i % 3 == 0 || i % 7 == 0) frame.velocity[i] = {0, i % 2 == 0 ? 0. : -0.};
    }
  }

  std::vector<reference::CompletedVelocity> expected(const reference::Frame& frame) const override {
    return reference::far_velocity(frame);
  }
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
  poison_changes_no_bit();
}

TEST_P(FarVelocityPass, ATightImageGivesTheSameBits) {
  a_tight_image_gives_the_same_bits();
}

TEST_P(FarVelocityPass, TwoRunsAgreeBitForBit) {
  two_runs_agree_bit_for_bit();
}

INSTANTIATE_TEST_SUITE_P(Variants, FarVelocityPass, testing::velocity_variants(), testing::variant_name);

}  // namespace
}  // namespace quincunx
