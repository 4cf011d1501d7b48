// SPDX-License-Identifier: MIT
// What happens when the X11 display that the window is on goes away.
#pragma once

namespace quincunx::scenes {

// From then on the program ends with exit status 1 and one sentence in the log.
void end_when_display_is_lost();

}  // namespace quincunx::scenes
