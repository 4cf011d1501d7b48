// SPDX-License-Identifier: MIT
// CompletedVelocityTest: what the tests of passes share that make a velocity from the drawn one, with the camera's
// motion where that is needed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "error_table.h"
#include "velocity_test_base.h"

namespace quincunx::testing {

// A turn with some roll.
inline constexpr std::array<float, 16> kTurn = {1.0f, 0.01f, 0, 0.02f, -0.01f, 1.0f,  0, 0.005f,
                                                0.3f, -0.2f, 1, 0.1f,  0.04f,  0.06f, 0, 1.0f};

class CompletedVelocityTest : public VelocityTest {
 protected:
  // That of velocity_from_depth, whose formula it is, and the product with the units and their own rounding.
  static constexpr double kError = (2 * (12 + 4) + 5 + 2 + 2) * 0x1p-24;

  CompletedVelocityTest(const ResolveSettings& settings, const char* kernel)
      : VelocityTest(SceneNeeds{}, settings, kernel) {}

  // Puts into a frame what the pass looks for.
  virtual void paint(reference::Frame& frame, const FrameSpec& spec) const = 0;
  virtual std::vector<reference::CompletedVelocity> expected(const reference::Frame& frame) const = 0;

  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::array<float, 16>& camera = kTurn,
                  Vec2 scale = {}) const {
    TestFrame made = make_frame(rig,
                                {.storage = settings_.targets.storage,
                                 .velocity = settings_.velocity,
                                 .with_velocity = true,
                                 .with_depth = true},
                                spec);
    paint(made.reference, spec);
    std::vector<Pixel> velocity, depth;
    for (std::size_t i = 0; i < made.reference.depth.size(); ++i) {
      velocity.push_back({made.reference.velocity[i][0], made.reference.velocity[i][1], 0, 0});
      depth.push_back({made.reference.depth[i], 0, 0, 0});
    }
    const auto put = [&](PixelFormat format, const std::vector<Pixel>& pixels) {
      return rig.image(format, settings_.targets.storage, spec.render, pixels, spec.outside, spec.tight);
    };
    made.inputs.velocity = put(settings_.velocity, velocity);
    made.inputs.depth = put(PixelFormat::kR32F, depth);
    made.inputs.velocity_scale = scale;
    if (scale != Vec2{}) made.reference.velocity_scale = {scale.x, scale.y};
    made.inputs.camera.clip_to_previous_clip = camera;
    std::copy(camera.begin(), camera.end(), made.reference.clip_to_previous_clip.begin());
    return made;
  }

  TestFrame turned_frame(Rig& rig, const FrameSpec& spec) const override { return frame(rig, spec); }

  // How many samples got the camera's velocity is added to `from_camera`.
  void compare(const FrameSpec& spec, const std::array<float, 16>& camera, Vec2 scale,
               std::int64_t* from_camera = nullptr) {
    Rig rig;
    const TestFrame made = frame(rig, spec, camera, scale);
    const std::vector<Pixel> actual = decode(settings_.velocity, run(rig, made));
    const auto wanted_of_all = expected(made.reference);
    ASSERT_EQ(actual.size(), wanted_of_all.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const reference::CompletedVelocity& wanted = wanted_of_all[i];
      if (wanted.is_from_camera && std::abs(wanted.w_part) < kError) continue;  // its sign is not certain
      if (wanted.is_from_camera && from_camera != nullptr) ++*from_camera;
      for (std::size_t c = 0; c < 2; ++c) {
        if (!wanted.is_from_camera) {
          const bool same = actual[i][c] == wanted.velocity[c] ||
                            (std::isnan(actual[i][c]) && std::isnan(wanted.velocity[c]));
          ASSERT_TRUE(same) << spec.render.width << "x" << spec.render.height << ", texel " << i
                            << ": a drawn velocity of " << wanted.velocity[c] << " became " << actual[i][c];
          continue;
        }
        const double units = 1 / std::abs(made.reference.velocity_scale[c]);
        const double magnitude = std::abs(wanted.velocity[c]);
        const double rounding = velocity_rounding(settings_.velocity, settings_.targets.storage, magnitude);
        const double bound = kError * wanted.condition * units + rounding;
        record_error({.error = std::abs(actual[i][c] - wanted.velocity[c]),
                      .bound = bound,
                      .largest = wanted.condition * units,
                      .stored = settings_.velocity});
        ASSERT_NEAR(actual[i][c], wanted.velocity[c], bound)
            << spec.render.width << "x" << spec.render.height << ", texel " << i;
      }
    }
  }
};

}  // namespace quincunx::testing
