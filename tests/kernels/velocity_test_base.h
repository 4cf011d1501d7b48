// SPDX-License-Identifier: MIT
// VelocityTest: what the tests of all passes that write velocity share.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx::testing {

struct VelocityVariant {
  Storage storage;
  PixelFormat velocity;
};

// More than a right angle, which leaves much of the picture behind the camera.
inline constexpr std::array<float, 16> kAboutTurn = {-0.2f, 0, 0, -0.98f, 0,     1, 0, 0,
                                                     0,     0, 1, 0,      0.98f, 0, 0, -0.2f};

class VelocityTest : public ::testing::TestWithParam<VelocityVariant> {
 protected:
  VelocityTest(const SceneNeeds& needs, ResolveSettings settings, const char* kernel) : settings_(settings) {
    settings_.targets.storage = GetParam().storage;
    settings_.velocity = GetParam().velocity;
    pass_ = std::make_unique<PassRig>(needs, settings_, kernel);
  }

  // Returns a frame of a camera that turns.
  virtual TestFrame turned_frame(Rig& rig, const FrameSpec& spec) const = 0;

  std::vector<unsigned char> run(Rig& rig, const TestFrame& frame, bool tight = false) {
    const Extent render = frame.inputs.render_extent;
    const std::vector<Pixel> before(static_cast<std::size_t>(render.area()), Pixel{-7, -7, -7, -7});
    const ImageView view =
        rig.image(settings_.velocity, settings_.targets.storage, render, before, -7, tight);
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

  void poison_changes_no_bit() {
    for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {45, 23}}) {
      Rig rig;
      FrameSpec spec{.render = render, .jitter = {-.5f, -.5f}};
      const auto clean = run(rig, turned_frame(rig, spec));
      for (const double poison : kPoisons) {
        spec.outside = poison;
        EXPECT_EQ(clean, run(rig, turned_frame(rig, spec)));
      }
    }
  }

  // Under a memory checker this also shows that nothing beyond the viewport is read or written.
  void a_tight_image_gives_the_same_bits() {
    for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {13, 7}, {16, 2}, {33, 21}}) {
      Rig rig;
      FrameSpec spec{.render = render};
      const auto roomy = run(rig, turned_frame(rig, spec));
      spec.tight = true;
      EXPECT_EQ(roomy, run(rig, turned_frame(rig, spec), true));
    }
  }

  void two_runs_agree_bit_for_bit() {
    Rig rig;
    const TestFrame made = turned_frame(rig, {.render = {183, 92}, .velocity = Pattern::kNonFinite});
    EXPECT_EQ(run(rig, made), run(rig, made));
  }

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
};

inline const std::vector<VelocityVariant> kVelocityVariants = {{Storage::kBuffer, PixelFormat::kRG16F},
                                                               {Storage::kBuffer, PixelFormat::kRG32F},
                                                               {Storage::kImage, PixelFormat::kRG16F}};

inline auto velocity_variants() {
  return ::testing::ValuesIn(kVelocityVariants);
}

inline std::string variant_name(const ::testing::TestParamInfo<VelocityVariant>& instance) {
  return sample_names(kVelocityVariants, [](const VelocityVariant& v) {
    return fmt::format("{}_{}", v.storage == Storage::kImage ? "image" : "buffer", name_of(v.velocity));
  })(instance);
}

}  // namespace quincunx::testing
