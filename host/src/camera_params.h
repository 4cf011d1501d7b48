// SPDX-License-Identifier: MIT
// What kernels that derive velocity from the camera know of a frame's camera.
#pragma once

#include "params.h"
#include "quincunx/frame.h"

namespace quincunx {

CameraVelocity camera_params(const FrameInputs& frame);

}  // namespace quincunx
