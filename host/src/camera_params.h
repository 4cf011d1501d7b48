// SPDX-License-Identifier: MIT
// What kernels that derive velocity from the camera know of a frame's camera.
#pragma once

#include "motion/far_params.h"
#include "motion/velocity_params.h"
#include "quincunx/frame.h"

namespace quincunx {

// Where samples lie in the picture whose output has this extent.
FarPlaces far_places(const FrameInputs& frame, Extent output);

CameraVelocity camera_params(const FrameInputs& frame);

// From uv to the units of a velocity that this scale takes to uv; a scale of 0 takes all motion away.
float inverse_scale(double scale);

}  // namespace quincunx
