// SPDX-License-Identifier: MIT
// A camera that goes round whatever there is to see.
#pragma once

#include "scene.h"

namespace quincunx::scenes {

constexpr double kOrbitSeconds = 8;

// Circles the bounds on a level path, counter-clockwise seen from above, once in `seconds` (> 0), looking at
// their middle from 18 degrees above; at time 0 it stands 30 degrees to the right of their +z side. The box
// fits into a picture of 4:3 or wider at every moment, and lies behind the near plane. Empty bounds are seen
// as a unit box. A pure function of time.
CameraPath orbit_camera(const Bounds& bounds, double seconds = kOrbitSeconds);

}  // namespace quincunx::scenes
