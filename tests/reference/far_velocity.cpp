// SPDX-License-Identifier: MIT
// far_velocity: a sample with a depth of 1e-9 at most and a velocity of exactly (0, 0) has the velocity that
// velocity_from_depth gives a depth of 0, in the units of the drawn velocity; any other has its own.
#include <algorithm>
#include <cmath>

#include "passes.h"

namespace quincunx::reference {
namespace {

constexpr double kFarthestDepth = 1e-9;
constexpr double kLargest = 65504;  // the largest half

}  // namespace

std::vector<CompletedVelocity> far_velocity(const Frame& frame) {
  Frame far = frame;
  std::fill(far.depth.begin(), far.depth.end(), 0.0);
  const std::vector<CameraVelocity> at_infinity = velocity_from_depth(far);
  std::vector<CompletedVelocity> velocities;
  for (std::size_t i = 0; i < frame.velocity.size(); ++i) {
    const std::array<double, 2>& drawn = frame.velocity[i];
    if (!(std::abs(frame.depth[i]) <= kFarthestDepth && drawn[0] == 0 && drawn[1] == 0)) {
      velocities.push_back({{drawn, 0, 1}, false});
      continue;
    }
    CompletedVelocity moved = {at_infinity[i], true};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double scale = frame.velocity_scale[axis];
      const double units = scale != 0 ? moved.velocity[axis] / scale : 0;
      moved.velocity[axis] = std::clamp(units, -kLargest, kLargest);
    }
    velocities.push_back(moved);
  }
  return velocities;
}

}  // namespace quincunx::reference
