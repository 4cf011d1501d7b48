// SPDX-License-Identifier: MIT
// calibration_run: quincunx-render --calibrate: what a scene's frames cost by resolution, and what each method errs and
// costs there.
#pragma once

#include "programs/render_options.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

// Draws and resolves a still moment of the scene at a few rungs of the ladder, from the lowest up, and writes
// the costs as a CostTable's JSON text to options.pacing.calibrate, whole or not at all. Then measures the scene's
// ErrorFront and writes it to where find_front() looks for it. Errors: of any part, as it words them.
Status run_calibration(const RenderOptions& options);

}  // namespace quincunx::scenes
