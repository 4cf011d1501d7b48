// SPDX-License-Identifier: MIT
// Particles in a viewport of their own: their light, what hides them, and that nothing else in their targets counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render_fixture.h"

namespace quincunx::scenes::testing {
namespace {

constexpr Extent kFrame{95, 53};  // odd: a texel covers another number of samples than its neighbour

// Discs before and behind a near plate, over a far one and over nothing.
Scene particle_scene() {
  Scene scene;
  scene.materials = {unlit({0.2f, 0.3f, 0.1f, 1}), unlit({0.05f, 0.1f, 0.4f, 1})};
  scene.meshes = {plate({0.8f, 1.2f}, 0), plate({2.5f, 1.2f}, 1)};
  scene.instances.push_back({0, glm::rotate(glm::mat4(1), 0.4f, glm::vec3(0, 0.3f, 1)), {}});
  scene.instances.push_back({1, glm::translate(glm::mat4(1), glm::vec3(0, -1, -4)), {}});
  scene.camera = fixed_camera({0, 0, 4}, {0, 0, 0});
  scene.particles = [](double seconds, std::vector<Particle>& particles) {
    for (int i = 0; i < 24; ++i) {
      const auto along = static_cast<float>(i) / 23 + static_cast<float>(seconds) * 0.1f;
      const float depth = i % 2 == 0 ? 0.6f : -2.0f;
      const float alpha = i % 3 == 0 ? 0 : 0.3f;
      particles.push_back({{4 * along - 2, std::sin(9 * along), depth}, 0.4f, {0.5f, 0.4f, 0.3f, alpha}});
    }
  };
  return scene;
}

struct Frame {
  Picture frame, particles;
};

// Draws with particles of their own where `own` is not empty. All targets hold `before` first.
Frame draw_apart(Renderer& renderer, FrameView view, Extent own, float before = 0) {
  const gl::RenderTargets targets =
      gl::RenderTargets::create({.target_extent = kFrame, .checkerboard = view.parity.has_value()}).value();
  const gl::RenderTargets layer =
      gl::RenderTargets::create({.target_extent = kFrame, .velocity = false}).value();
  fill_with(layer, before);
  view.particles = own;
  const Status status = renderer.draw(targets, view, {.particles = own == Extent() ? nullptr : &layer});
  EXPECT_TRUE(status.ok()) << status.message();
  return {read_back(targets), read_back(layer)};
}

class ParticleLayerTest : public RenderTest {};

// Over and under are associative: what is drawn apart and laid over the rest is what is drawn in turn, but for the half
// floats in between.
TEST_F(ParticleLayerTest, LaidOverAtTheFramesResolutionTheyAreThePicture) {
  Renderer renderer = renderer_of(particle_scene());
  const FrameView view = view_of_size(kFrame, {0.25f, -0.25f}, 0.5, 0.4);
  const Frame together = draw_apart(renderer, view, {});
  const Frame apart = draw_apart(renderer, view, kFrame);
  EXPECT_EQ(together.frame.depth, apart.particles.depth);
  int covered = 0;
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      const std::size_t i = apart.frame.index(x, y);
      const float through = 1 - apart.particles.colour[4 * i + 3];
      const glm::vec3 laid = apart.particles.rgb(x, y) + through * apart.frame.rgb(x, y);
      const glm::vec3 drawn = together.frame.rgb(x, y);
      covered += apart.particles.reactive[i] > 0 ? 1 : 0;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(laid[c], drawn[c], 0.004f * (drawn[c] + 0.1f)) << x << ", " << y;
      const float mark = apart.particles.reactive[i];
      const float marked = mark + (1 - mark) * apart.frame.reactive[i];
      ASSERT_NEAR(marked, together.frame.reactive[i], 3.0f / 255) << x << ", " << y;
    }
  }
  EXPECT_GT(covered, kFrame.area() / 8);
}

TEST_F(ParticleLayerTest, DepthIsTheNearestAndTheFarthestOfTheSamplesInTurns) {
  Renderer renderer = renderer_of(particle_scene());
  for (const Extent own : {Extent{48, 27}, {31, 20}, {95, 7}, {1, 1}}) {
    for (const std::optional<int> parity : {std::optional<int>(), std::optional<int>(1)}) {
      FrameView view = view_of_size(kFrame);
      view.parity = parity;
      const Frame drawn = draw_apart(renderer, view, own);
      for (int y = 0; y < own.height; ++y) {
        for (int x = 0; x < own.width; ++x) {
          int left = x * kFrame.width / own.width, right = ((x + 1) * kFrame.width - 1) / own.width;
          int top = y * kFrame.height / own.height, bottom = ((y + 1) * kFrame.height - 1) / own.height;
          if (parity) {
            left = std::min(left, kFrame.width - 2), top = std::min(top, kFrame.height - 2);
            right = std::max(right, left + 1), bottom = std::max(bottom, top + 1);
          }
          float nearest = 0, farthest = 1;
          for (int j = top; j <= bottom; ++j) {
            for (int i = left; i <= right; ++i) {
              if (parity && (i + j) % 2 != *parity) continue;
              nearest = std::max(nearest, drawn.frame.depth[drawn.frame.index(i, j)]);
              farthest = std::min(farthest, drawn.frame.depth[drawn.frame.index(i, j)]);
            }
          }
          ASSERT_EQ(drawn.particles.depth[drawn.particles.index(x, y)], (x + y) % 2 == 0 ? nearest : farthest)
              << x << ", " << y << " of " << own.width << "x" << own.height;
        }
      }
    }
  }
}

TEST_F(ParticleLayerTest, WhatTheTargetsHeldBeforeChangesNoBitOfTheViewport) {
  Renderer renderer = renderer_of(particle_scene());
  const Extent own{31, 20};
  const Frame clean = draw_apart(renderer, view_of_size(kFrame), own);
  const Frame poisoned = draw_apart(renderer, view_of_size(kFrame), own, std::nanf(""));
  EXPECT_EQ(clean.frame.colour, poisoned.frame.colour);
  for (int y = 0; y < own.height; ++y) {
    for (int x = 0; x < own.width; ++x) {
      const std::size_t i = clean.particles.index(x, y);
      ASSERT_EQ(clean.particles.depth[i], poisoned.particles.depth[i]);
      ASSERT_EQ(clean.particles.reactive[i], poisoned.particles.reactive[i]);
      for (std::size_t c = 4 * i; c < 4 * i + 4; ++c)
        ASSERT_EQ(clean.particles.colour[c], poisoned.particles.colour[c]);
    }
  }
}

TEST_F(ParticleLayerTest, TheFrameItselfHasNone) {
  Scene without = particle_scene();
  without.particles = {};
  Renderer renderer = renderer_of(particle_scene()), bare = renderer_of(without);
  const FrameView view = view_of_size(kFrame);
  const Frame apart = draw_apart(renderer, view, {20, 20}), empty = draw_apart(bare, view, {});
  EXPECT_EQ(apart.frame.colour, empty.frame.colour);
  EXPECT_EQ(apart.frame.reactive, empty.frame.reactive);
}

TEST_F(ParticleLayerTest, AViewportThatDoesNotFitIsRefused) {
  Renderer renderer = renderer_of(particle_scene());
  const auto targets = gl::RenderTargets::create({.target_extent = kFrame}).value();
  const auto layer = gl::RenderTargets::create({.target_extent = {40, 40}, .velocity = false}).value();
  FrameView view = view_of_size(kFrame);
  for (const Extent own : {Extent{0, 4}, {41, 4}, {4, 54}, {-1, 4}}) {
    view.particles = own;
    const Status status = renderer.draw(targets, view, {.particles = &layer});
    ASSERT_FALSE(status.ok()) << own.width;
    EXPECT_NE(status.message().find("FrameView::particles"), std::string::npos) << status.message();
  }
  view.particles = {8, 8};
  EXPECT_FALSE(renderer.draw(targets, view).ok()) << "there are no targets for them";
  Scene without = particle_scene();
  without.particles = {};
  EXPECT_FALSE(renderer_of(without).draw(targets, view, {.particles = &layer}).ok());
}

}  // namespace
}  // namespace quincunx::scenes::testing
