// SPDX-License-Identifier: MIT
// What kernels that derive velocity from the camera know of a frame's camera.
#pragma once

#include "params.h"
#include "quincunx/frame.h"

namespace quincunx {

// Where samples lie in the picture whose output has this extent.
FarPlaces far_places(const FrameInputs& frame, Extent output);

CameraVelocity camera_params(const FrameInputs& frame);

}  // namespace quincunx
