// SPDX-License-Identifier: MIT
// convert_inputs: see passes.h.
#include <algorithm>
#include <cmath>

#include "passes.h"

namespace quincunx::reference {

double depth_between_planes(double depth, bool forward, double near_plane, double far_plane) {
  const double reversed = forward ? 1 - depth : depth;
  if (reversed == 0) return 0;
  // 1 / distance falls linearly from the near plane to the far one.
  const double inverse_distance = reversed / near_plane + (1 - reversed) / far_plane;
  return near_plane * inverse_distance;
}

double depth_of_distance(double distance, double near_plane) {
  return distance > 0 ? std::min(near_plane / distance, 1.0) : 0;
}

std::array<double, 2> unjittered(const std::array<double, 2>& velocity, const std::array<double, 2>& jitter) {
  if (velocity[0] == 0 && velocity[1] == 0) return velocity;
  return {velocity[0] - jitter[0], velocity[1] - jitter[1]};
}

}  // namespace quincunx::reference
