// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "passes.h"

namespace quincunx::reference {
namespace {

struct Speed {
  double squared = 0;  // K |v|^2 in render pixels
  bool non_finite = false;
};

Speed speed_at(const Frame& frame, Weight weight, double k, int x, int y, int output_width,
               int output_height) {
  if (weight == Weight::kMean) return {};
  const int column = nearest_texel(x, output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, output_height, frame.height, frame.jitter_y);
  const std::array<double, 2> stored = frame.velocity[index_of(frame.width, column, row)];
  const std::array<double, 2> velocity = {stored[0] * frame.velocity_scale[0],
                                          stored[1] * frame.velocity_scale[1]};
  Speed speed;
  speed.non_finite = !std::isfinite(stored[0]) || !std::isfinite(stored[1]);
  const double pixels_x = velocity[0] * frame.width;
  const double pixels_y = velocity[1] * frame.height;
  speed.squared = k * (pixels_x * pixels_x + pixels_y * pixels_y);
  return speed;
}

}  // namespace

Picture resolve_quincunx(const Frame& current, const Frame& previous, Weight weight, bool nearest,
                         bool reactive, double k, int output_width, int output_height) {
  Picture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const auto sample = nearest ? sample_nearest : sample_bilinear;
      const Sample c0 = sample(current, x, y, output_width, output_height);
      const Sample c1 = sample(previous, x, y, output_width, output_height);
      const Speed v0 = speed_at(current, weight, k, x, y, output_width, output_height);
      const Speed v1 = speed_at(previous, weight, k, x, y, output_width, output_height);
      double f = 1 / (1 + v0.squared + v1.squared);
      if (reactive) {
        f *= 1 - reactive_at(current, x, y, output_width, output_height);
        f *= 1 - reactive_at(previous, x, y, output_width, output_height);
      }
      if (c1.non_finite || v0.non_finite || v1.non_finite) f = 0;
      Pixel out = {};
      for (std::size_t c = 0; c < 4; ++c)
        out[c] = (c0.value[c] + f * c1.value[c]) / (1 + f);
      picture.pixels.push_back(out);
      picture.largest.push_back(std::max(c0.largest, c1.largest));
      picture.non_finite += c0.non_finite || c1.non_finite || v0.non_finite || v1.non_finite ? 1 : 0;
    }
  }
  return picture;
}

}  // namespace quincunx::reference
