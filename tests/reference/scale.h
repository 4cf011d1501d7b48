// SPDX-License-Identifier: MIT
// What the single-frame filters should give, in double precision.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "picture.h"

namespace quincunx::reference {

// Output pixel (x, y) of a frame that outlives it.
using Sampler = std::function<Sample(int x, int y)>;

// Every pixel of a picture.
Picture scale(int output_width, int output_height, const Sampler& sampler);

Sampler point_sampler(const Frame& frame, int output_width, int output_height);
Sampler bilinear_sampler(const Frame& frame, int output_width, int output_height);

enum class Filter { kTent, kBSpline, kCatmullRom, kLanczos2 };

// What one output column or row reads of its axis: the texels with a weight, each once, and those next to the
// centre, whose range bounds the result where ringing is clamped.
struct AxisFilter {
  std::vector<Tap> taps;
  int inner_first = 0;
  int inner_last = 0;
};

// The filter over its sum, widened by render / output where that exceeds 1. Beyond the edges it sees the edge
// texel. A weight below 2^-25 is 0, as in the library.
AxisFilter filter_axis(Filter filter, int x, int output, int render, double jitter);

Sampler filter_sampler(const Frame& frame, Filter filter, bool clamp, int output_width, int output_height);

// The nearest sample, its colours times 1 + amplitude n, n in [-1, 1) at random.
Sampler grain_sampler(const Frame& frame, double amplitude, std::uint32_t seed, int output_width,
                      int output_height);

// One sample at random: that which a place drawn evenly from a square of max(1, render / output) texels
// around the pixel's centre falls into, the ratio being a multiple of 1/256.
Sampler offset_sampler(const Frame& frame, std::uint32_t seed, int output_width, int output_height);

// The weights that offset_sampler gives the texels of an axis in the mean.
std::vector<Tap> offset_weights(int x, int output, int render, double jitter);

}  // namespace quincunx::reference
