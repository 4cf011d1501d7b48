// SPDX-License-Identifier: MIT
#include "picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {

double sanitised(double value) {
  if (std::isnan(value)) return 0;
  if (std::isinf(value)) return value > 0 ? 65504 : -65504;
  return value;
}

double texel_coordinate(int x, int output, int render, double jitter) {
  return (x + 0.5) * render / output - 0.5 - jitter;
}

Between between_samples(double u, int size) {
  if (size == 1) return {};
  const double inside = std::clamp(u, 0.0, size - 1.0);
  const int left = std::min(static_cast<int>(std::floor(inside)), size - 2);
  return {left, left + 1, inside - left};
}

int nearest_texel(int x, int output, int render, double jitter) {
  const double position = (x + 0.5) * render / output;
  // Texels within two of the position are all that can be nearest.
  const int around = static_cast<int>(std::floor(position - jitter));
  const int first = std::clamp(around - 2, 0, render - 1);
  const int last = std::clamp(around + 2, 0, render - 1);
  int best = first;
  for (int i = first; i <= last; ++i) {
    const double distance = std::abs(i + 0.5 + jitter - position);
    const double best_distance = std::abs(best + 0.5 + jitter - position);
    if (distance < best_distance) best = i;
  }
  return best;
}

std::array<Tap, 2> bilinear_taps(int x, int output, int render, double jitter) {
  const double u = texel_coordinate(x, output, render, jitter);
  const int left = static_cast<int>(std::floor(u));
  double right_weight = u - left;
  if (right_weight < 0x1p-25) right_weight = 0;
  if (right_weight > 1 - 0x1p-25) right_weight = 1;
  return {Tap{std::clamp(left, 0, render - 1), 1 - right_weight},
          Tap{std::clamp(left + 1, 0, render - 1), right_weight}};
}

const Pixel& texel_at(const Frame& frame, int x, int y) {
  return frame.colour[index_of(frame.width, x, y)];
}

const Pixel& texel_clamped(const Frame& frame, int x, int y) {
  return texel_at(frame, std::clamp(x, 0, frame.width - 1), std::clamp(y, 0, frame.height - 1));
}

void add(Sample& sample, const Pixel& texel, double weight) {
  if (weight == 0) return;
  for (std::size_t c = 0; c < 4; ++c) {
    if (!std::isfinite(texel[c])) sample.non_finite = true;
    const double value = sanitised(texel[c]);
    sample.value[c] += weight * value;
    sample.largest = std::max(sample.largest, std::abs(value));
  }
}

Sample sample_nearest(const Frame& frame, int x, int y, int output_width, int output_height) {
  const int column = nearest_texel(x, output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, output_height, frame.height, frame.jitter_y);
  Sample sample;
  add(sample, texel_at(frame, column, row), 1);
  return sample;
}

double reactive_at(const Frame& frame, int x, int y, int output_width, int output_height) {
  const int column = nearest_texel(x, output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, output_height, frame.height, frame.jitter_y);
  return frame.reactive[index_of(frame.width, column, row)];
}

Sample sample_bilinear(const Frame& frame, int x, int y, int output_width, int output_height) {
  Sample sample;
  for (const Tap& row : bilinear_taps(y, output_height, frame.height, frame.jitter_y)) {
    for (const Tap& column : bilinear_taps(x, output_width, frame.width, frame.jitter_x)) {
      add(sample, texel_at(frame, column.texel, row.texel), row.weight * column.weight);
    }
  }
  return sample;
}

}  // namespace quincunx::reference
