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

// Where the surface at depth `depth` and texture coordinate (u, v) was in the previous frame, and so its
// velocity.
std::array<double, 2> camera_velocity(const Frame& frame, double u, double v, double depth) {
  const std::array<double, 4> clip = {2 * u - 1, 1 - 2 * v, depth, 1};
  std::array<double, 4> previous = {};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      previous[row] += frame.clip_to_previous_clip[column * 4 + row] * clip[column];
    }
  }
  const double previous_u = (previous[0] / previous[3] + 1) / 2;
  const double previous_v = (1 - previous[1] / previous[3]) / 2;
  return {u - previous_u, v - previous_v};
}

Speed speed_at(const Frame& frame, Weight weight, double k, int x, int y, int output_width,
               int output_height) {
  if (weight == Weight::kPlain) return {};
  const int column = nearest_texel(x, output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, output_height, frame.height, frame.jitter_y);
  const auto texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                     static_cast<std::size_t>(column);
  std::array<double, 2> velocity = {};
  Speed speed;
  if (weight == Weight::kVelocity) {
    const std::array<double, 2> stored = frame.velocity[texel];
    speed.non_finite = !std::isfinite(stored[0]) || !std::isfinite(stored[1]);
    velocity = {stored[0] * frame.velocity_scale[0], stored[1] * frame.velocity_scale[1]};
  } else {
    const double u = (column + 0.5 + frame.jitter_x) / frame.width;
    const double v = (row + 0.5 + frame.jitter_y) / frame.height;
    speed.non_finite = !std::isfinite(frame.depth[texel]);
    velocity = camera_velocity(frame, u, v, frame.depth[texel]);
  }
  const double pixels_x = velocity[0] * frame.width;
  const double pixels_y = velocity[1] * frame.height;
  speed.squared = k * (pixels_x * pixels_x + pixels_y * pixels_y);
  return speed;
}

double reactive_at(const Frame& frame, int x, int y, int output_width, int output_height) {
  const int column = nearest_texel(x, output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, output_height, frame.height, frame.jitter_y);
  return frame.reactive[static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                        static_cast<std::size_t>(column)];
}

}  // namespace

Picture resolve_quincunx(const Frame& current, const Frame& previous, Weight weight, bool reactive, double k,
                         int output_width, int output_height) {
  Picture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const Sample c0 = sample_bilinear(current, x, y, output_width, output_height);
      const Sample c1 = sample_bilinear(previous, x, y, output_width, output_height);
      const Speed v0 = speed_at(current, weight, k, x, y, output_width, output_height);
      const Speed v1 = speed_at(previous, weight, k, x, y, output_width, output_height);
      double f = 1 / (1 + v0.squared + v1.squared);
      if (reactive) f *= 1 - reactive_at(current, x, y, output_width, output_height);
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
