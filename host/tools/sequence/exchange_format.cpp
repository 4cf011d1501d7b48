// SPDX-License-Identifier: MIT
#include "tools/sequence/exchange_format.h"

#include <algorithm>

namespace quincunx::tools {

float linear_z(float depth, float near_plane) {
  // With a reversed infinite projection clip z is the near distance and clip w the distance along the axis.
  // The comparison is written so that NaN fails it.
  if (!(depth > near_plane / kNoSurfaceZ)) return kNoSurfaceZ;
  return near_plane / depth;
}

float reversed_depth(float z, float near_plane) {
  if (!(z < kNoSurfaceZ)) return 0;
  return near_plane / std::max(z, near_plane);
}

Vec2 backward_from_velocity(Vec2 velocity, Extent extent) {
  return {-velocity.x * static_cast<float>(extent.width), velocity.y * static_cast<float>(extent.height)};
}

Vec2 velocity_from_backward(Vec2 backward, Extent extent) {
  return {-backward.x / static_cast<float>(extent.width), backward.y / static_cast<float>(extent.height)};
}

}  // namespace quincunx::tools
