// SPDX-License-Identifier: MIT
// What the three kernels of the motion blur share.
#pragma once

#include "motion/blur_params.h"
#include "pass.h"

namespace quincunx {

MotionParams motion_params(const PassFrame& frame, const WorkShape& shape,
                           const MotionBlurSettings& settings);

}  // namespace quincunx
