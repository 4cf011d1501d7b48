// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

namespace quincunx {

// How far a sample reaches in resolve_reprojected, in render pixels, on an axis with `render` samples under
// `output` pixels: the fewer samples, the sharper. Within [0.875, 1]; measured, see docs/pipeline.md.
inline double sample_reach(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

}  // namespace quincunx
