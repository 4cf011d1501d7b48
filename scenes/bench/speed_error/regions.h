// SPDX-License-Identifier: MIT
// Regions: the parts of a picture where methods fail apart, told by the scene's true depth and motion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/disocclusion.h"

namespace quincunx::bench {

// What the pixels of one frame show, output extent.
struct FrameMasks {
  std::vector<std::uint8_t> disoccluded;  // 1 where a pixel was hidden within the last two frames
  std::vector<Region> regions;
  std::vector<std::uint8_t> focus;  // 1 where a focus shows; empty where the conditions have none
};

// 1 for each pixel with a surface that fills no block of 4 x 4 pixels around it: some pixel of every such block shows
// what lies behind that surface. `nearest`: the depth of the nearest surface in each pixel. What goes on beyond the
// edge of the picture is taken to be as near.
std::vector<std::uint8_t> thin_pixels(Extent extent, std::span<const float> nearest);

// 1 for each pixel that is not `thin` and has a nearer one that is within 4 pixels each way.
std::vector<std::uint8_t> behind_thin_pixels(Extent extent, std::span<const float> nearest,
                                             std::span<const std::uint8_t> thin);

// 1 for each pixel within 2 pixels each way of two that touch and whose motions differ by more than half a pixel.
std::vector<std::uint8_t> edges_of_motion(const Geometry& geometry);

// Each pixel's first region that holds, in the order of Region.
std::vector<Region> regions_of(const Geometry& geometry, std::span<const float> nearest,
                               std::span<const std::uint8_t> disoccluded);

// Of each measured frame. A cut disoccludes nothing, and nothing moves in it: all is new.
Result<std::vector<FrameMasks>> masks_of_frames(scenes::Renderer& renderer, const scenes::Scene& scene,
                                                const Conditions& conditions);

}  // namespace quincunx::bench
