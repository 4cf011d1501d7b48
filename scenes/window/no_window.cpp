// SPDX-License-Identifier: MIT
#include "window/window_run.h"

namespace quincunx::scenes {

Status run_window(const RenderOptions&) {
  return Status::unsupported(
      "this build has no window; install the Debian packages libglfw3-dev and libimgui-dev and build "
      "again");
}

}  // namespace quincunx::scenes
