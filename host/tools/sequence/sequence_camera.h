// SPDX-License-Identifier: MIT
// Sequence camera: the camera's motion between two frames from their attribute worldToNDC. Pure.
#pragma once

#include <optional>

#include "quincunx/frame.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {

// For depth that is `near_plane` / distance, whatever the z of the matrices means: that of a point follows
// from its distance alone. Exactly the identity for equal matrices. Nothing where `now` cannot be inverted.
std::optional<CameraMotion> camera_motion(const Matrix& now, const Matrix& before, float near_plane);

}  // namespace quincunx::tools
