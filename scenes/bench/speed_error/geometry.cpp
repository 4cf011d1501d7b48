// SPDX-License-Identifier: MIT
#include "bench/speed_error/geometry.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "quincunx_gl/target_readback.h"

namespace quincunx::bench {
namespace {

// Of pixel i at infinity: where the camera's turning takes it.
Vec2 background_velocity(const CameraMotion& camera, Extent extent, std::size_t i) {
  const auto width = static_cast<std::size_t>(extent.width);
  const glm::vec2 uv((static_cast<float>(i % width) + 0.5f) / static_cast<float>(extent.width),
                     (static_cast<float>(i / width) + 0.5f) / static_cast<float>(extent.height));
  const glm::vec4 now(2 * uv.x - 1, 1 - 2 * uv.y, 0, 1);
  const glm::vec4 before = glm::make_mat4(camera.clip_to_previous_clip.data()) * now;
  constexpr float kSmallestW = 1e-4f;  // behind the previous camera
  const glm::vec2 way = glm::vec2(now) - glm::vec2(before) / std::max(before.w, kSmallestW);
  return {0.5f * way.x, -0.5f * way.y};
}

}  // namespace

bool is_nearer(float depth, float other) {
  return depth > std::max(other * kNearer, kHorizon);
}

Result<Geometry> geometry_at(scenes::Renderer& renderer, const gl::RenderTargets& targets, double seconds,
                             double previous_seconds) {
  scenes::FrameView view;
  view.render = targets.extent();
  view.seconds = seconds;
  view.previous_seconds = previous_seconds;
  if (Status status = renderer.draw(targets, view); !status.ok()) return status;
  gl::TargetPixels pixels = gl::read_targets(targets, view.render);
  const CameraMotion camera = renderer.camera_motion(view);
  Geometry geometry{.extent = view.render, .depth = std::move(pixels.depth), .velocity = {}};
  geometry.velocity.reserve(geometry.depth.size());
  for (std::size_t i = 0; i < geometry.depth.size(); ++i) {
    if (geometry.depth[i] > 0) {
      geometry.velocity.push_back(
          {glm::unpackHalf1x16(pixels.velocity[2 * i]), glm::unpackHalf1x16(pixels.velocity[2 * i + 1])});
    } else {
      geometry.velocity.push_back(background_velocity(camera, view.render, i));
    }
  }
  return geometry;
}

Result<std::vector<float>> nearest_depth_at(scenes::Renderer& renderer, const gl::RenderTargets& targets,
                                            double seconds) {
  constexpr float kStep = 1.0f / 3;
  std::vector<float> nearest(static_cast<std::size_t>(targets.extent().area()), 0);
  for (int sample = 0; sample < 9; ++sample) {
    scenes::FrameView view;
    view.render = targets.extent();
    view.jitter = {kStep * static_cast<float>(sample % 3 - 1), kStep * static_cast<float>(sample / 3 - 1)};
    view.seconds = view.previous_seconds = seconds;
    if (Status status = renderer.draw(targets, view); !status.ok()) return status;
    const gl::TargetPixels pixels = gl::read_targets(targets, view.render);
    for (std::size_t i = 0; i < nearest.size(); ++i)
      nearest[i] = std::max(nearest[i], pixels.depth[i]);
  }
  return nearest;
}

}  // namespace quincunx::bench
