// SPDX-License-Identifier: MIT
// The single-frame methods: the specification. A Sampler is named like its kernel.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "picture.h"

namespace quincunx::reference {

// Output pixel (x, y) of a frame that outlives it.
using Sampler = std::function<Sample(int x, int y)>;

// Every pixel of a picture.
Picture scale(int output_width, int output_height, const Sampler& sampler);

Sampler scale_point(const Frame& frame, int output_width, int output_height);
Sampler scale_bilinear(const Frame& frame, int output_width, int output_height);

// A separable filter.
struct Filter {
  const char* name;           // the method's
  double support;             // render pixels: the filter is 0 from there on
  double (*value)(double d);  // at the distance d >= 0 from the centre, in render pixels
  bool rings;                 // it has negative lobes
};

// "bilinear" is the tent. Throws std::invalid_argument.
const Filter& filter_named(std::string_view name);
std::span<const Filter> all_filters();

// The taps of one output column or row on its axis: each texel that has a weight, once, and the texels next to the
// centre, to whose range the result is clamped where ringing is.
struct AxisFilter {
  std::vector<Tap> taps;
  int inner_first = 0;
  int inner_last = 0;
};

// The filter over its sum, widened by render / output where that exceeds 1. Texels are clamped to the edge. A
// weight below 2^-25 is 0, as in the library.
AxisFilter filter_axis(const Filter& filter, int x, int output, int render, double jitter);

Sampler scale_filter(const Frame& frame, const Filter& filter, bool clamp, int output_width,
                     int output_height);

// The nearest sample, its colours times 1 + amplitude n, n in [-1, 1) at random.
Sampler scale_noise(const Frame& frame, double amplitude, std::uint32_t seed, int output_width,
                    int output_height);

// One sample at random: that whose texel holds a place drawn evenly from a square of max(1, render / output)
// texels around the pixel's centre, the ratio being a multiple of 1/256.
Sampler scale_noise_offset(const Frame& frame, std::uint32_t seed, int output_width, int output_height);

// The weights that scale_noise_offset gives the texels of an axis in the mean.
std::vector<Tap> offset_weights(int x, int output, int render, double jitter);

}  // namespace quincunx::reference
