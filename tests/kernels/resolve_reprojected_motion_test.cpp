// SPDX-License-Identifier: MIT
// The reprojected form of the two-frame resolve on pictures that move: nothing shifts, nothing stays behind.
#include "kernel_fixture.h"
#include "passes/pass_chain.h"

namespace quincunx {
namespace {

using testing::FrameFormats;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

constexpr double kRounding = 0x1p-24;

PlanFacts reprojected_facts(Extent output, Extent target) {
  ResolveSettings settings{.method = Method::kQuincunx,
                           .output_extent = output,
                           .target_extent = target,
                           .output = {.present = false}};
  settings.quincunx.form = TwoFrameForm::kReprojected;
  return {{.transparents = false}, settings};
}

void resolve(PassChain& chain, const TestFrame& current, const TestFrame& previous, const ImageView& view,
             Counter counter) {
  FrameReport report;
  chain.run(chain.frame(current.inputs, &previous.inputs, {.linear = view}, counter), {.linear = view},
            report, nullptr);
}

// A picture that moves by whole and broken pixels, seen through two viewports with opposite jitter, comes
// back in place: a wrong sign of velocity or of a jitter would show.
TEST(ReprojectedMotion, AMovingRampComesBackInPlace) {
  const PlanFacts facts = reprojected_facts({128, 64}, {128, 64});
  const FrameFormats formats{.with_velocity = true, .with_depth = true};
  const Pixel motion = {.03125, -.046875, 0, 0};  // uv a frame
  Rig rig;
  const auto ramp = [&](float jitter, Extent extent, double moved) {
    std::vector<Pixel> colour;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        colour.push_back({(x + .5 + static_cast<double>(jitter)) / extent.width + motion[0] * moved,
                          (y + .5 + static_cast<double>(jitter)) / extent.height + motion[1] * moved, 0, 1});
      }
    }
    TestFrame made = make_frame(rig, formats, {.render = extent, .jitter = {jitter, jitter}}, colour);
    const auto count = static_cast<std::size_t>(extent.area());
    made.inputs.velocity =
        rig.image(PixelFormat::kRG16F, Storage::kBuffer, extent, std::vector<Pixel>(count, motion), 0);
    made.inputs.depth = rig.image(PixelFormat::kR32F, Storage::kBuffer, extent,
                                  std::vector<Pixel>(count, Pixel{.25, 0, 0, 0}), 0);
    return made;
  };
  PassChain chain(testing::device(), facts);
  for (const float jitter : {.25f, -.25f, 0.f}) {
    // The surface at u now was at u - motion: there the previous frame showed the same colour.
    const TestFrame current = ramp(jitter, {91, 46}, 0);
    const TestFrame previous = ramp(-jitter, {100, 50}, 1);
    const ImageView view = rig.output(PixelFormat::kRGBA32F, facts.settings.output_extent);
    resolve(chain, current, previous, view, rig.counter());
    const std::vector<Pixel> pixels = rig.pixels(view, facts.settings.output_extent);
    for (int y = 8; y < 56; ++y) {
      for (int x = 8; x < 120; ++x) {
        // Weights by distance shift a ramp by .19 samples at most (a quarter of the way between two of them);
        // a wrong sign shifts it by three samples or, of the jitter, by half a one.
        ASSERT_NEAR(pixels[static_cast<std::size_t>(y * 128 + x)][0], (x + .5) / 128, .2 / 91);
        ASSERT_NEAR(pixels[static_cast<std::size_t>(y * 128 + x)][1], (y + .5) / 64, .2 / 46);
      }
    }
  }
}

// A bright surface in front of a still background has moved on: what it disoccluded shows none of it.
TEST(ReprojectedMotion, WhatWasHiddenLeavesNoGhost) {
  const PlanFacts facts = reprojected_facts({96, 48}, {64, 32});
  const FrameFormats formats{.with_velocity = true, .with_depth = true};
  const Extent render{64, 32};
  Rig rig;
  const auto scene = [&](int left, float jitter) {
    std::vector<Pixel> colour, velocity, depth;
    for (int i = 0; i < static_cast<int>(render.area()); ++i) {
      const bool front = i % render.width >= left && i % render.width < left + 20;
      colour.push_back(front ? Pixel{1, 1, 1, 1} : Pixel{0, 0, 0, 1});
      velocity.push_back(front ? Pixel{8. / render.width, 0, 0, 0} : Pixel{});
      depth.push_back({front ? .5 : .125, 0, 0, 0});
    }
    TestFrame made = make_frame(rig, formats, {.render = render, .jitter = {jitter, jitter}}, colour);
    made.inputs.velocity = rig.image(PixelFormat::kRG16F, Storage::kBuffer, render, velocity, 0);
    made.inputs.depth = rig.image(PixelFormat::kR32F, Storage::kBuffer, render, depth, 0);
    return made;
  };
  PassChain chain(testing::device(), facts);
  const TestFrame previous = scene(20, -.25f);
  const TestFrame current = scene(28, .25f);
  const ImageView view = rig.output(PixelFormat::kRGBA32F, facts.settings.output_extent);
  resolve(chain, current, previous, view, rig.counter());
  const std::vector<Pixel> pixels = rig.pixels(view, facts.settings.output_extent);
  const auto red = [&](int x) { return pixels[static_cast<std::size_t>(24 * 96 + x)][0]; };
  for (int x = 0; x < 96; ++x) {
    const double at = (x + .5) * render.width / 96;  // render pixels
    // At the old edge, at 20, one of the 2x2 samples around a pixel may be the surface's.
    if (at < 19 || (at > 21 && at < 27) || at > 49) {
      EXPECT_EQ(red(x), 0) << x;
    } else if (at > 29.5 && at < 46.5) {
      EXPECT_NEAR(red(x), 1, 16 * kRounding) << x;
    }
  }
}

}  // namespace
}  // namespace quincunx
