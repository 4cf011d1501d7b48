// SPDX-License-Identifier: MIT
// velocity_from_depth: of a scene in which only the camera moves. With a sample's clip coordinates
// c = (2u - 1, 1 - 2v, depth, 1), jitter included, and p = clip_to_previous_clip c:
//   velocity = (u, v) - ((p.x / p.w + 1) / 2, (1 - p.y / p.w) / 2), within +-65504 (a half's range)
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "passes.h"

namespace quincunx::reference {
namespace {

constexpr double kLargest = 65504;  // the largest half
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns the velocity of the surface that is seen at (u, v).
CameraVelocity velocity_at(const Frame& frame, double u, double v, double depth) {
  const std::array<double, 4> clip = {2 * u - 1, 1 - 2 * v, depth, 1};
  std::array<double, 4> previous = {};
  std::array<double, 4> magnitude = {};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double product = frame.clip_to_previous_clip[column * 4 + row] * clip[column];
      previous[row] += product;
      magnitude[row] += std::abs(product);
    }
  }
  const double w = previous[3];
  if (!(w > 0)) return {{kLargest, kLargest}, magnitude[3], 0};
  const double previous_u = (previous[0] / w + 1) / 2;
  const double previous_v = (1 - previous[1] / w) / 2;
  const double largest_ndc = std::max(std::abs(previous[0]), std::abs(previous[1])) / w;
  const double largest_sum = std::max(magnitude[0], magnitude[1]) / w;
  return {{std::clamp(u - previous_u, -kLargest, kLargest), std::clamp(v - previous_v, -kLargest, kLargest)},
          std::max(largest_sum, largest_ndc * magnitude[3] / w),
          w / magnitude[3]};
}

}  // namespace

std::vector<CameraVelocity> velocity_from_depth(const Frame& frame) {
  std::vector<CameraVelocity> velocities;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const double depth = frame.depth[index_of(frame.width, x, y)];
      const double u = (x + 0.5 + frame.jitter_x) / frame.width;
      const double v = (y + 0.5 + frame.jitter_y) / frame.height;
      velocities.push_back(std::isfinite(depth) ? velocity_at(frame, u, v, depth)
                                                : CameraVelocity{{kNan, kNan}, 0, 1});
    }
  }
  return velocities;
}

}  // namespace quincunx::reference
