// SPDX-License-Identifier: MIT
#include "two_frame_cases.h"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>

namespace quincunx::testing {

TestFrame TwoFrameCases::frame(Rig& rig, const FrameSpec& spec) const {
  return with_motion(make_frame(rig, formats_, spec));
}

TestFrame TwoFrameCases::frame(Rig& rig, const FrameSpec& spec, const std::vector<Pixel>& colour) const {
  return with_motion(make_frame(rig, formats_, spec, colour));
}

void TwoFrameCases::compare_at_every_size_scale_and_input(Extent largest) {
  const double scales[][4] = {{.05, .1, .1, .05}, {.5, .71, .5, .71},   {.71, .5, .9, .6},
                              {1, 1, 1, 1},       {1.37, .83, .5, 1.9}, {2, 1.9, 2, 1.9}};
  unsigned seed = 0;
  for (const Extent output : sizes_for(largest)) {
    for (std::size_t i = 0; i < std::size(scales); ++i) {
      const auto& scale = scales[i];
      for (const Pattern pattern : patterns_for(output, i)) {
        ++seed;
        const Pattern velocity = pattern == Pattern::kNonFinite ? Pattern::kNonFinite : Pattern::kNoise;
        compare({.render = scaled(output, scale[0], scale[1]),
                 .jitter = {.25f, .25f},
                 .colour = pattern,
                 .velocity = velocity,
                 .seed = seed},
                {.render = scaled(output, scale[2], scale[3]),
                 .jitter = {-.25f, -.5f},
                 .colour = pattern,
                 .velocity = velocity,
                 .seed = seed + 50},
                output);
        if (::testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

void TwoFrameCases::compare_at_any_speed_and_with_the_widest_rows() {
  if (settings_.targets.storage == Storage::kImage)
    return;  // images end at 8192 on some devices, the margin included
  for (const double pixels : {0.0, 1e-6, .5, 400.0, 1e6}) {
    compare({.render = {45, 23}, .jitter = {.25f, .25f}, .seed = 3, .speed = pixels / 45},
            {.render = {60, 31}, .jitter = {-.25f, -.25f}, .seed = 4, .speed = pixels / 60}, {64, 33});
    if (::testing::Test::HasFatalFailure()) return;
  }
  compare({.render = {5816, 2}, .jitter = {.25f, .25f}, .seed = 5, .speed = 2e-4},
          {.render = {5600, 3}, .jitter = {-.25f, -.25f}, .seed = 6, .speed = 2e-4}, {8192, 3});
}

void TwoFrameCases::poison_outside_the_viewport_changes_no_bit() {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{45, 23}}) {
    Rig rig;
    FrameSpec now{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    FrameSpec before{.render = {render.width, render.height + 2}, .jitter = {.5f, .5f}, .seed = 4};
    const Resolved clean = resolve(rig, frame(rig, now), frame(rig, before), {64, 33});
    for (const double poison : kPoisons) {
      now.outside = before.outside = poison;
      const Resolved poisoned = resolve(rig, frame(rig, now), frame(rig, before), {64, 33});
      EXPECT_EQ(clean.bytes, poisoned.bytes) << render.width << "x" << render.height << ", poison " << poison;
      EXPECT_EQ(poisoned.non_finite, 0);
    }
  }
}

void TwoFrameCases::a_tight_image_gives_the_same_bits() {
  for (const Extent render : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{2, 2}, Extent{13, 7}}) {
    Rig rig;
    FrameSpec now{.render = render, .jitter = {-.5f, -.5f}, .seed = 3};
    FrameSpec before{.render = {render.height, render.width}, .jitter = {.5f, .5f}, .seed = 4};
    const Resolved roomy = resolve(rig, frame(rig, now), frame(rig, before), {16, 9});
    now.tight = before.tight = true;
    EXPECT_EQ(roomy.bytes, resolve(rig, frame(rig, now), frame(rig, before), {16, 9}).bytes);
  }
}

void TwoFrameCases::two_runs_agree_bit_for_bit() {
  Rig rig;
  const TestFrame current =
      frame(rig, {.render = {183, 92}, .jitter = {.25f, .25f}, .colour = Pattern::kNonFinite});
  const TestFrame previous = frame(rig, {.render = {150, 99}, .jitter = {-.25f, -.25f}, .seed = 2});
  EXPECT_EQ(resolve(rig, current, previous, {257, 129}).bytes,
            resolve(rig, current, previous, {257, 129}).bytes);
}

std::string name_of(const FrameSpec& now, const FrameSpec& before, Extent output) {
  return fmt::format("{}x{} and {}x{} -> {}x{}, {}", now.render.width, now.render.height, before.render.width,
                     before.render.height, output.width, output.height, name_of(now.colour));
}

}  // namespace quincunx::testing
