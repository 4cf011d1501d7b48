// SPDX-License-Identifier: MIT
#include "bench/speed_error/disocclusion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "bench/speed_error/bench_plan.h"
#include "quincunx_gl/target_readback.h"

namespace quincunx::bench {
namespace {

// A twentieth: more than a surface at walking pace comes nearer in a frame, less than an object stands before
// its background.
constexpr float kNearer = 1.05f;
constexpr float kHorizon = 1e-6f;  // depth above this is a surface

struct Place {
  double x = 0;  // pixels; the centre of pixel (0, 0) is 0
  double y = 0;
};

// Where pixel i of this frame was in the frame before.
Place previous_place(const Geometry& now, std::size_t i) {
  const auto width = static_cast<std::size_t>(now.extent.width);
  return {static_cast<double>(i % width) - double{now.velocity[i].x} * now.extent.width,
          static_cast<double>(i / width) - double{now.velocity[i].y} * now.extent.height};
}

// Index of the pixel at or up and left of a place; -1 where it and its neighbours right and below are not all
// in the picture.
std::int64_t corner_of(Place place, Extent extent) {
  const double x = std::floor(place.x);
  const double y = std::floor(place.y);
  const bool inside = x >= 0 && y >= 0 && x < extent.width - 1 && y < extent.height - 1;
  return inside ? static_cast<std::int64_t>(y) * extent.width + static_cast<std::int64_t>(x) : -1;
}

Result<Geometry> geometry_at(scenes::Renderer& renderer, const gl::RenderTargets& targets, double seconds,
                             double previous_seconds) {
  scenes::FrameView view;
  view.render = targets.extent();
  view.seconds = seconds;
  view.previous_seconds = previous_seconds;
  if (Status status = renderer.draw(targets, view); !status.ok()) return status;
  gl::TargetPixels pixels = gl::read_targets(targets, view.render);
  Geometry geometry{.extent = view.render, .depth = std::move(pixels.depth), .velocity = {}};
  geometry.velocity.reserve(geometry.depth.size());
  for (std::size_t i = 0; i + 1 < pixels.velocity.size(); i += 2) {
    geometry.velocity.push_back(
        {glm::unpackHalf1x16(pixels.velocity[i]), glm::unpackHalf1x16(pixels.velocity[i + 1])});
  }
  return geometry;
}

}  // namespace

std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before) {
  std::vector<std::uint8_t> mask(now.depth.size(), 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::int64_t corner = corner_of(previous_place(now, i), before.extent);
    if (corner < 0) continue;
    const float* upper = before.depth.data() + corner;
    const float* lower = upper + before.extent.width;
    const float farthest = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
    mask[i] = farthest > std::max(now.depth[i] * kNearer, kHorizon) ? 1 : 0;
  }
  return mask;
}

std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older) {
  for (std::size_t i = 0; i < newer.size(); ++i) {
    const Place place = previous_place(now, i);
    const std::int64_t nearest = corner_of({std::round(place.x), std::round(place.y)}, now.extent);
    if (nearest >= 0) newer[i] |= older[static_cast<std::size_t>(nearest)];
  }
  return newer;
}

Result<std::vector<std::vector<std::uint8_t>>> disoccluded_pixels(scenes::Renderer& renderer,
                                                                  const scenes::Scene& scene,
                                                                  const Conditions& conditions) {
  constexpr int kBack = 2;
  const gl::RenderTargets targets({.target = conditions.output, .velocity = true, .reactive = false});
  std::vector<std::vector<std::uint8_t>> masks;
  Geometry before;
  std::vector<std::uint8_t> older;
  for (int frame = -kBack; frame < conditions.frames; ++frame) {
    const int index = conditions.warm_up + frame;
    const double seconds = seconds_of(conditions, index);
    const double previous = seconds_of(conditions, index - 1);
    auto now = geometry_at(renderer, targets, seconds, previous);
    if (!now.ok()) return now.status();
    if (frame > -kBack) {
      const std::vector<std::uint8_t> none(now->depth.size(), 0);
      const bool cut = scenes::is_cut(scene, previous, seconds);
      if (cut) older = none;
      std::vector<std::uint8_t> newer = cut ? none : disoccluded_since(now.value(), before);
      if (frame >= 0) masks.push_back(disoccluded_within_two(now.value(), newer, older));
      older = std::move(newer);
    }
    before = std::move(now).value();
  }
  return masks;
}

}  // namespace quincunx::bench
