// SPDX-License-Identifier: MIT
// truth_run: quincunx-render --truth: supersampled frames instead of resolved ones.
#pragma once

#include "programs/render_options.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

// Renders and writes every frame: .exr linear, .png through the present pass. Errors: of any part, as it
// words them.
Status run_truth(const RenderOptions& options);

}  // namespace quincunx::scenes
