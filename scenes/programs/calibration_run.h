// SPDX-License-Identifier: MIT
// calibration_run: quincunx-render --calibrate: what a scene's frames cost, by resolution.
#pragma once

#include "programs/render_options.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

// Draws and resolves a still moment of the scene at a few rungs of the ladder, from the lowest up, and writes
// the costs as a CostTable's JSON text to options.pacing.calibrate, whole or not at all. Errors: of any part,
// as it words them.
Status run_calibration(const RenderOptions& options);

}  // namespace quincunx::scenes
