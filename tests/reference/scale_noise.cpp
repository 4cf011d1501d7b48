// SPDX-License-Identifier: MIT
// scale_noise: the nearest sample times 1 + A n, n at random in [-1, 1): film grain.
// scale_noise_offset: one sample at random, that whose texel holds a place drawn evenly from a square of
// max(1, render / output) texels around the pixel's centre: bilinear's picture in the mean.
// Source: Binks, "Dynamic Resolution Rendering", 2012.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hash.h"
#include "scale.h"

namespace quincunx::reference {
namespace {

// Texels of an axis that a pixel may look at; the library holds it in multiples of 1/256.
double offset_range(int output, int render) {
  return std::clamp(std::nearbyint(256.0 * render / output) / 256, 1.0, 250.0);
}

// The texel coordinate of a pixel's centre, clamped to the edge; the library holds it in multiples of 2^-24.
double centre_of(int x, int output, int render, double jitter) {
  const double u = std::clamp(texel_coordinate(x, output, render, jitter), 0.0, render - 1.0);
  return std::nearbyint(u * 0x1p24) / 0x1p24;
}

// `random` in [0, 1).
int offset_texel(double random, int x, int output, int render, double jitter) {
  const double place =
      centre_of(x, output, render, jitter) + 0.5 + (random - 0.5) * offset_range(output, render);
  return std::clamp(static_cast<int>(std::floor(place)), 0, render - 1);
}

}  // namespace

Sampler scale_noise(const Frame& frame, double amplitude, std::uint32_t seed, int output_width,
                    int output_height) {
  return [&frame, amplitude, seed, output_width, output_height](int x, int y) {
    Sample sample = sample_nearest(frame, x, y, output_width, output_height);
    const std::uint32_t random = random_of(x, y, seed);
    const double grain = (random < 0x80000000u ? random : random - 0x1p32) / 0x1p31;
    for (std::size_t c = 0; c < 3; ++c)
      sample.value[c] *= 1 + amplitude * grain;
    return sample;
  };
}

Sampler scale_noise_offset(const Frame& frame, std::uint32_t seed, int output_width, int output_height) {
  return [&frame, seed, output_width, output_height](int x, int y) {
    const std::uint32_t random = random_of(x, y, seed);
    const double random_x = std::floor(random / 0x1p16) / 0x1p16;
    const double random_y = (random % 0x10000u) / 0x1p16;
    const int column = offset_texel(random_x, x, output_width, frame.width, frame.jitter_x);
    const int row = offset_texel(random_y, y, output_height, frame.height, frame.jitter_y);
    Sample sample;
    add(sample, texel_at(frame, column, row), 1);
    return sample;
  };
}

std::vector<Tap> offset_weights(int x, int output, int render, double jitter) {
  const double range = offset_range(output, render);
  const double first = centre_of(x, output, render, jitter) + 0.5 - range / 2;
  std::vector<Tap> taps;
  for (int texel = 0; texel < render; ++texel) {
    // The part of [first, first + range) that falls into the texel; the outermost take what lies beyond.
    const double left = texel == 0 ? -1e9 : texel;
    const double right = texel == render - 1 ? 1e9 : texel + 1;
    const double part = std::min(right, first + range) - std::max(left, first);
    if (part > 0) taps.push_back({texel, part / range});
  }
  return taps;
}

}  // namespace quincunx::reference
