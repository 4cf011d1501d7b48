// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scale.h"

namespace quincunx::reference {
namespace {

// One step of a permuted congruential generator, "RXS M XS" with 32 bits: O'Neill, 2014.
std::uint32_t pcg(std::uint32_t value) {
  const std::uint32_t state = value * 747796405u + 2891336453u;
  const std::uint32_t shift = state / 0x10000000u + 4;
  const std::uint32_t word = (state / (std::uint32_t{1} << shift) ^ state) * 277803737u;
  return word / 0x400000u ^ word;
}

std::uint32_t random_of(int x, int y, std::uint32_t seed) {
  const std::uint32_t row = pcg(static_cast<std::uint32_t>(y) + pcg(seed));
  return pcg(row + static_cast<std::uint32_t>(x));
}

double reach_of(int output, int render) {
  return std::clamp(std::nearbyint(256.0 * render / output) / 256, 1.0, 250.0);
}

// The texel coordinate of a pixel's centre, kept within the viewport, as finely as the library has it.
double centre_of(int x, int output, int render, double jitter) {
  const double u = (x + 0.5) * render / output - 0.5 - jitter;
  return std::nearbyint(std::clamp(u, 0.0, render - 1.0) * 0x1p24) / 0x1p24;
}

// `random` in [0, 1).
int offset_texel(double random, int x, int output, int render, double jitter) {
  const double place = centre_of(x, output, render, jitter) + 0.5 + (random - 0.5) * reach_of(output, render);
  return std::clamp(static_cast<int>(std::floor(place)), 0, render - 1);
}

}  // namespace

Sampler grain_sampler(const Frame& frame, double amplitude, std::uint32_t seed, int output_width,
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

Sampler offset_sampler(const Frame& frame, std::uint32_t seed, int output_width, int output_height) {
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
  const double reach = reach_of(output, render);
  const double first = centre_of(x, output, render, jitter) + 0.5 - reach / 2;
  std::vector<Tap> taps;
  for (int texel = 0; texel < render; ++texel) {
    // The part of [first, first + reach) that falls into the texel; the outermost take what lies beyond.
    const double left = texel == 0 ? -1e9 : texel;
    const double right = texel == render - 1 ? 1e9 : texel + 1;
    const double part = std::min(right, first + reach) - std::max(left, first);
    if (part > 0) taps.push_back({texel, part / reach});
  }
  return taps;
}

}  // namespace quincunx::reference
