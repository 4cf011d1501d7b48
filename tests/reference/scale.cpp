// SPDX-License-Identifier: MIT
// scale_point: the sample nearest to the output pixel's centre. scale_bilinear: the four samples around it.
#include "scale.h"

namespace quincunx::reference {

Picture scale(int output_width, int output_height, const Sampler& sampler) {
  Picture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const Sample sample = sampler(x, y);
      picture.pixels.push_back(sample.value);
      picture.largest.push_back(sample.largest);
      picture.non_finite += sample.non_finite ? 1 : 0;
    }
  }
  return picture;
}

Sampler scale_point(const Frame& frame, int output_width, int output_height) {
  return [&frame, output_width, output_height](int x, int y) {
    return sample_nearest(frame, x, y, output_width, output_height);
  };
}

Sampler scale_bilinear(const Frame& frame, int output_width, int output_height) {
  return [&frame, output_width, output_height](int x, int y) {
    return sample_bilinear(frame, x, y, output_width, output_height);
  };
}

}  // namespace quincunx::reference
