// SPDX-License-Identifier: MIT
// CompletedVelocityTest: what the tests of passes share that make a velocity from the drawn one, with the camera's
// motion where that is needed.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "error_table.h"
#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx::testing {

struct VelocityVariant {
  Storage storage;
  PixelFormat velocity;
};

// A turn with some roll, and one of more than a right angle, which leaves much of the picture behind the camera.
inline constexpr std::array<float, 16> kTurn = {1.0f, 0.01f, 0, 0.02f, -0.01f, 1.0f,  0, 0.005f,
                                                0.3f, -0.2f, 1, 0.1f,  0.04f,  0.06f, 0, 1.0f};
inline constexpr std::array<float, 16> kAboutTurn = {-0.2f, 0, 0, -0.98f, 0,     1, 0, 0,
                                                     0,     0, 1, 0,      0.98f, 0, 0, -0.2f};

class CompletedVelocityTest : public ::testing::TestWithParam<VelocityVariant> {
 protected:
  // That of velocity_from_depth, whose formula it is, and the product with the units and their own rounding.
  static constexpr double kError = (2 * (12 + 4) + 5 + 2 + 2) * 0x1p-24;

  CompletedVelocityTest(ResolveSettings settings, const char* kernel) : settings_(settings) {
    settings_.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    pass_ = std::make_unique<PassRig>(SceneNeeds{}, settings_, kernel);
  }

  // Puts into a frame what the pass looks for.
  virtual void paint(reference::Frame& frame, const FrameSpec& spec) const = 0;
  virtual std::vector<reference::CompletedVelocity> expected(const reference::Frame& frame) const = 0;

  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::array<float, 16>& camera = kTurn,
                  Vec2 scale = {}) const {
    TestFrame made = make_frame(rig,
                                {.storage = settings_.storage,
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
        const double rounding = velocity_rounding(settings_.velocity, settings_.storage, magnitude);
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

  void poison_changes_no_bit(Extent render) {
    Rig rig;
    FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}};
    const auto clean = run(rig, frame(rig, spec));
    for (const double poison : {std::nan(""), static_cast<double>(INFINITY), 1e30}) {
      spec.outside = poison;
      EXPECT_EQ(clean, run(rig, frame(rig, spec)));
    }
  }

  // Under a memory checker this also shows that nothing beyond the viewport is read or written.
  void a_tight_image_gives_the_same_bits(Extent render) {
    Rig rig;
    FrameSpec spec{.render = render};
    const auto roomy = run(rig, frame(rig, spec));
    spec.tight = true;
    EXPECT_EQ(roomy, run(rig, frame(rig, spec), true));
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

inline auto velocity_variants() {
  return ::testing::Values(VelocityVariant{Storage::kBuffer, PixelFormat::kRG16F},
                           VelocityVariant{Storage::kBuffer, PixelFormat::kRG32F},
                           VelocityVariant{Storage::kImage, PixelFormat::kRG16F});
}

inline std::string variant_name(const ::testing::TestParamInfo<VelocityVariant>& instance) {
  const VelocityVariant& v = instance.param;
  return fmt::format("{}_{}", v.storage == Storage::kImage ? "image" : "buffer", name_of(v.velocity));
}

}  // namespace quincunx::testing
