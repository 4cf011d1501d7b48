// SPDX-License-Identifier: MIT
// camera_streak_px: how long the streaks of motion blur are that the camera's own motion draws.
#pragma once

#include "quincunx/frame.h"

namespace quincunx::scenes {

// Mean over points spread over the picture, each 2, 8 and 32 metres away and standing still, in pixels of
// `output`. `shutter`: part of the frame's time that it is open. Pure. What moves by itself is not seen.
double camera_streak_px(const CameraMotion& motion, float near_plane, Extent output, float shutter);

}  // namespace quincunx::scenes
