// SPDX-License-Identifier: MIT
// Disocclusion: which pixels show what was hidden a moment ago, where a method that trusts the past shows ghosts.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/extent.h"
#include "render/renderer.h"

namespace quincunx::bench {

// Depth (reversed, infinite: 1 near, 0 far) and velocity (uv, this position - previous position) of one
// frame, without jitter.
struct Geometry {
  Extent extent;
  std::vector<float> depth;
  std::vector<Vec2> velocity;
};

// 1 for each pixel of `now` whose place in `before` lies on screen and is hidden there: all four pixels
// around it are nearer by more than a twentieth of its distance. 0 where it comes from outside the picture.
std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before);

// `newer`, and what comes from where `older`, the mask of the frame before, is 1.
std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older);

// For each measured frame the mask of the last two frames, output extent. A cut disoccludes nothing: all is new.
Result<std::vector<std::vector<std::uint8_t>>> disoccluded_pixels(scenes::Renderer& renderer,
                                                                  const scenes::Scene& scene,
                                                                  const Conditions& conditions);

}  // namespace quincunx::bench
