// SPDX-License-Identifier: MIT
// run_window: quincunx-render --window.
#pragma once

#include "quincunx/status.h"
#include "session/render_options.h"

namespace quincunx::scenes {

// Shows frames until the window is closed or `options.frames` are shown. Errors: kUnsupported where there is
// no display, or where this build has no window; else of any part, as that part words them. The program ends
// when the display is lost: see window.h.
Status run_window(const RenderOptions& options);

}  // namespace quincunx::scenes
