// SPDX-License-Identifier: MIT
// The live graph: resolution above, times below, dropped frames as marks. By Dear ImGui, within its window.
#pragma once

#include "window/frame_trace.h"

namespace quincunx::scenes {

// `target_ms` 0: no line for it. As wide as there is room.
void draw_frame_graph(const FrameTrace& trace, double target_ms);

}  // namespace quincunx::scenes
