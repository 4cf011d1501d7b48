// SPDX-License-Identifier: MIT
// A file of its own: X11's header has macros of common names.
#include "window/window.h"

#ifdef QUINCUNX_WINDOW_X11
#include <X11/Xlib.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#endif

namespace quincunx::scenes {

void end_when_display_is_lost() {
#ifdef QUINCUNX_WINDOW_X11
  // Nothing that was opened through the display can be used, or even closed, any more, and X11's library ends
  // the program in its own way when the handler returns.
  XSetIOErrorHandler([](Display*) -> int {
    spdlog::error("the display was lost");
    std::_Exit(EXIT_FAILURE);
  });
#endif
}

}  // namespace quincunx::scenes
