// SPDX-License-Identifier: MIT
#include "passes.h"

namespace quincunx::reference {

Picture scale_point(const Frame& frame, int output_width, int output_height) {
  Picture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const Sample sample = sample_nearest(frame, x, y, output_width, output_height);
      picture.pixels.push_back(sample.value);
      picture.largest.push_back(sample.largest);
      picture.non_finite += sample.non_finite ? 1 : 0;
    }
  }
  return picture;
}

}  // namespace quincunx::reference
