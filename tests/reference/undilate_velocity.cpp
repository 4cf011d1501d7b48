// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "passes.h"

namespace quincunx::reference {
namespace {

constexpr int kSampleReachMax = 8;
constexpr double kSameSurface = 1. / 32;  // part of a depth
constexpr double kLargest = 65504;        // the largest half

std::size_t texel(const Frame& frame, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
}

double dilated_depth(const Frame& frame, int x, int y) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, frame.height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, frame.width - 1); ++i)
      most = std::fmax(most, frame.depth[texel(frame, i, j)]);
  }
  return most;
}

struct Place {
  int x, y;
};

// Returns, of the samples `ring` columns or rows from (x, y), the one whose dilated depth is closest to that sample's
// depth.
std::optional<Place> closest_in_ring(const Frame& frame, int x, int y, int ring, double tolerance) {
  const double depth = frame.depth[texel(frame, x, y)];
  std::optional<Place> place;
  double closest = std::numeric_limits<double>::infinity();
  for (int j = std::max(y - ring, 0); j <= std::min(y + ring, frame.height - 1); ++j) {
    for (int i = std::max(x - ring, 0); i <= std::min(x + ring, frame.width - 1); ++i) {
      if (std::max(std::abs(i - x), std::abs(j - y)) != ring) continue;
      const double apart = std::abs(dilated_depth(frame, i, j) - depth);
      if (!(apart <= tolerance) || !(apart < closest)) continue;
      place = {i, j};
      closest = apart;
    }
  }
  return place;
}

CompletedVelocity from_camera(const Frame& frame, const CameraVelocity& camera) {
  CompletedVelocity moved = {camera, true};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double scale = frame.velocity_scale[axis];
    moved.velocity[axis] = std::clamp(scale != 0 ? moved.velocity[axis] / scale : 0, -kLargest, kLargest);
  }
  return moved;
}

}  // namespace

std::vector<CompletedVelocity> undilate_velocity(const Frame& frame) {
  const bool has_camera = frame.clip_to_previous_clip != Frame{}.clip_to_previous_clip;
  const std::vector<CameraVelocity> camera = velocity_from_depth(frame);
  std::vector<CompletedVelocity> velocities;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t at = texel(frame, x, y);
      const double own = frame.depth[at], nearest = dilated_depth(frame, x, y);
      const CompletedVelocity drawn = {{frame.velocity[at], 0, 1}, false};
      velocities.push_back(drawn);
      if (!(nearest > own && own >= 0)) continue;
      const bool is_covered = nearest - own > own * kSameSurface;
      std::optional<Place> place;
      for (int ring = 1; ring <= (is_covered ? kSampleReachMax : 1) && !place; ++ring)
        place = closest_in_ring(frame, x, y, ring, is_covered ? own * kSameSurface : 0);
      if (place)
        velocities.back().velocity = frame.velocity[texel(frame, place->x, place->y)];
      else if (is_covered && has_camera)
        velocities.back() = from_camera(frame, camera[at]);
    }
  }
  return velocities;
}

}  // namespace quincunx::reference
