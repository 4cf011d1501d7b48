// SPDX-License-Identifier: MIT
// measure_content: what a frame shows, counted over 8 x 8 samples of each tile of 32 x 32 output pixels: the
// specification.
#pragma once

#include <cstdint>
#include <vector>

#include "picture.h"

namespace quincunx::reference {

struct ContentCounts {
  std::int64_t moving = 0;
  std::int64_t apart = 0;
  std::int64_t thin = 0;
  std::int64_t light = 0;
  std::int64_t zoom = 0;
  std::int64_t judged = 0;
  double speed = 0;  // sum over the moving samples, output pixels
  std::int64_t tiles = 0;
  // How clear the least clear decision is: the distance from its threshold, by the most that floats may be wrong there.
  // Beyond 1 every count is certain.
  double margin = 1e30;
};

// Velocity is in the frame's units, that of a non-finite one 0; `reactive` false: none is read. `confirmations`:
// TileLight's, one for each tile of 8 x 8 output pixels; empty: nobody has looked.
ContentCounts measure_content(const Frame& frame, int output_width, int output_height, bool reactive,
                              const std::vector<double>& confirmations = {});

}  // namespace quincunx::reference
