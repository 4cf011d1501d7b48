// SPDX-License-Identifier: MIT
// Regions: parts of the picture that errors are counted in, from depth and motion of the frames at output size.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/advanced/extent.h"
#include "quincunx_gl/render_targets.h"
#include "render/renderer.h"

namespace quincunx::bench {

// Depth and motion at the centre of each pixel. Depth is reversed and infinite: 1 near, 0 far; velocity is uv, this
// position - previous position. The background, at depth 0, has the velocity that the camera gives it, whatever the
// scene says of it.
struct Geometry {
  Extent extent;
  std::vector<float> depth;
  std::vector<Vec2> velocity;
};

// A surface is nearer than another where its depth exceeds the other's this many times. A twentieth: more than a
// surface at walking pace comes nearer in a frame, less than an object stands before its background.
inline constexpr float kNearer = 1.05f;
inline constexpr float kHorizon = 1e-6f;  // depth above this is a surface

// Returns whether `depth` is of a surface that stands before `other`.
bool is_nearer(float depth, float other);

// Draws a moment and reads its geometry. `targets` have the extent wanted, and velocity.
Result<Geometry> geometry_at(scenes::Renderer& renderer, const gl::RenderTargets& targets, double seconds,
                             double previous_seconds);

// Returns for each pixel the depth of the nearest of 3 x 3 samples, so that nothing thinner than a pixel is missed.
Result<std::vector<float>> nearest_depth_at(scenes::Renderer& renderer, const gl::RenderTargets& targets,
                                            double seconds);

// Masks, 1 where something holds.

// Marks each pixel of `now` whose place in `before` lies on screen and is hidden there: all four pixels around it are
// nearer. A method that trusts the past shows ghosts in these. A pixel from outside the picture has 0.
std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before);

// Adds to `newer` the pixels that come from where `older`, the mask of the frame before, is 1.
std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older);

// Classes of the pixels of one frame, output extent.
struct FrameMasks {
  std::vector<std::uint8_t> disoccluded;  // 1 where a pixel was hidden within the last two frames
  std::vector<Region> regions;
  std::vector<std::uint8_t> focus;  // 1 where a focus shows; empty where the conditions have none
};

// Marks each pixel with a surface that fills no block of 4 x 4 pixels around it: some pixel of every such block shows
// what lies behind that surface. `nearest` is the depth of the nearest surface in each pixel. Surfaces are taken to go
// on beyond the edge of the picture.
std::vector<std::uint8_t> thin_pixels(Extent extent, std::span<const float> nearest);

// Marks each pixel that is not `thin` and has a nearer one that is within 4 pixels each way.
std::vector<std::uint8_t> behind_thin_pixels(Extent extent, std::span<const float> nearest,
                                             std::span<const std::uint8_t> thin);

// Marks each pixel within 2 pixels each way of two that touch and whose motions differ by more than half a pixel.
std::vector<std::uint8_t> edges_of_motion(const Geometry& geometry);

// Returns each pixel's first region that holds, in the order of Region.
std::vector<Region> regions_of(const Geometry& geometry, std::span<const float> nearest,
                               std::span<const std::uint8_t> disoccluded);

// Returns the masks of each measured frame. A cut disoccludes nothing, and nothing moves in it: all is new.
Result<std::vector<FrameMasks>> masks_of_frames(scenes::Renderer& renderer, const scenes::Scene& scene,
                                                const Conditions& conditions);

}  // namespace quincunx::bench
