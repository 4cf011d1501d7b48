// SPDX-License-Identifier: MIT
// undilate_velocity: each sample's own velocity, from that of the nearest of its 3x3.
#include <limits>

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

constexpr std::array<float, 16> kUnknown = CameraMotion{}.clip_to_previous_clip;

class UndilateVelocityPass : public testing::CompletedVelocityTest {
 protected:
  UndilateVelocityPass()
      : CompletedVelocityTest({.conventions = {.drawn_velocity = DrawnVelocity::kDilated}},
                              "undilate_velocity") {}

  // Wires of one and of three samples, blocks of samples each of a depth of its own, a few samples that are not finite
  // or less than 0, before a wall: flat, at a slant, at a slant so steep that neighbours are not within 1/32, or sky.
  void paint(reference::Frame& frame, const FrameSpec& spec) const override {
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const int x = static_cast<int>(i) % frame.width, y = static_cast<int>(i) / frame.width;
      const unsigned wall = spec.seed % 4;
      double depth = wall == 3 ? 0 : .1 * (1 + (wall == 1 ? .004 : wall == 2 ? .1 : 0) * (x + 2 * y));
      const unsigned hash = (static_cast<unsigned>(i) * 2654435761u + spec.seed * 40503u) >> 16;
      if (x > 40 && x < 75 && y < 60) depth = .4 + 1e-5 * static_cast<double>(hash % 1000);
      if (x > 80 && x < 110) depth = .3 + .3 * static_cast<double>(hash % 2);
      if ((x + y) % 11 == 3) depth = .5;
      if (x % 23 == 5 || x % 23 == 6 || x % 23 == 7) depth = .6 + .0001 * y;
      if (hash % 97 == 0) depth = std::numeric_limits<double>::quiet_NaN();
      if (hash % 101 == 0) depth = std::numeric_limits<double>::infinity();
      if (hash % 103 == 0) depth = -.2;
      if (hash % 107 == 0) depth = -std::numeric_limits<double>::infinity();
      frame.depth[i] = static_cast<double>(static_cast<float>(depth));
    }
  }

  std::vector<reference::CompletedVelocity> expected(const reference::Frame& frame) const override {
    return reference::undilate_velocity(frame);
  }
};

TEST_P(UndilateVelocityPass, MatchesTheReference) {
  unsigned seed = 0;
  std::int64_t from_camera = 0;
  for (const Extent render : {Extent{1, 1}, {2, 3}, {3, 2}, {7, 5}, {64, 64}, {257, 129}}) {
    for (const Pattern values : {Pattern::kNoise, Pattern::kNonFinite}) {
      for (const auto& camera : {kTurn, kAboutTurn, kUnknown}) {
        for (const Vec2 scale : {Vec2{}, Vec2{-1.f / 640, -1.f / 360}}) {
          compare({.render = render, .jitter = {.25f, -.5f}, .velocity = values, .seed = ++seed}, camera,
                  scale, &from_camera);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  EXPECT_GT(from_camera, 1000);
}

// Velocities that each sample has of its own come back from their dilation, wherever a sample of the same surface has
// not lost its own: here, wherever the wires leave one.
TEST_P(UndilateVelocityPass, TakesADilationBack) {
  Rig rig;
  const Extent render{40, 20};
  TestFrame made = frame(rig, {.render = render}, kUnknown);
  const auto texel = [&](int x, int y) { return static_cast<std::size_t>(y * render.width + x); };
  const auto is_wire = [](int x, int y) { return x % 9 == 4 || (x + y) % 17 == 8; };
  std::vector<Pixel> own, dilated, depth;
  for (int y = 0; y < render.height; ++y) {
    for (int x = 0; x < render.width; ++x) {
      depth.push_back({is_wire(x, y) ? .5 : .125, 0, 0, 0});
      own.push_back({is_wire(x, y) ? .25 : -.5, is_wire(x, y) ? 0. : .125, 0, 0});
    }
  }
  std::int64_t changed = 0;
  for (int y = 0; y < render.height; ++y) {
    for (int x = 0; x < render.width; ++x) {
      bool is_near = false;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, render.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, render.width - 1); ++i)
          is_near |= is_wire(i, j);
      }
      dilated.push_back(is_near ? Pixel{.25, 0, 0, 0} : own[texel(x, y)]);
      changed += dilated.back() != own[texel(x, y)] ? 1 : 0;
    }
  }
  EXPECT_GT(changed, render.area() / 8);
  made.inputs.depth = rig.image(PixelFormat::kR32F, settings_.targets.storage, render, depth, 0);
  made.inputs.velocity = rig.image(settings_.velocity, settings_.targets.storage, render, dilated, 0);
  const std::vector<Pixel> back = testing::decode(settings_.velocity, run(rig, made));
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(back[i][0], own[i][0]) << i;
    EXPECT_EQ(back[i][1], own[i][1]) << i;
  }
}

TEST_P(UndilateVelocityPass, PoisonOutsideTheViewportChangesNoBit) {
  poison_changes_no_bit();
}

TEST_P(UndilateVelocityPass, ATightImageGivesTheSameBits) {
  a_tight_image_gives_the_same_bits();
}

TEST_P(UndilateVelocityPass, TwoRunsAgreeBitForBit) {
  two_runs_agree_bit_for_bit();
}

INSTANTIATE_TEST_SUITE_P(Variants, UndilateVelocityPass, testing::velocity_variants(), testing::variant_name);

}  // namespace
}  // namespace quincunx
