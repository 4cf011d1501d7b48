// SPDX-License-Identifier: MIT
// Frames and pictures of the references, and what several references need: where a pixel's centre lies among
// the samples, and single samples.
//
// The references are scalar, direct and slow on purpose: they share no code with the kernels or their axis
// tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quincunx::reference {

// Red, green, blue and alpha; linear, premultiplied.
template <typename Real>
using PixelOf = std::array<Real, 4>;
using Pixel = PixelOf<double>;

// Returns the index of element (x, y) among rows of `width` elements.
inline std::size_t index_of(int width, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

// One rendered frame as its viewport holds it: width * height values, row by row. NaN and infinities as they
// are.
struct Frame {
  int width = 0;
  int height = 0;
  double jitter_x = 0;
  double jitter_y = 0;
  std::vector<Pixel> colour;
  std::vector<std::array<double, 2>> velocity;
  std::vector<double> depth;
  std::vector<double> reactive;
  std::array<double, 2> velocity_scale = {1, 1};
  std::array<double, 16> clip_to_previous_clip = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

const Pixel& texel_at(const Frame& frame, int x, int y);
// Clamped to the edge.
const Pixel& texel_clamped(const Frame& frame, int x, int y);

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels;
  std::vector<double> largest;  // per pixel: the largest |tap| it was made from, for error bounds
  std::int64_t non_finite = 0;  // pixels with NaN or infinite input of non-zero weight
};

// NaN counts as 0, infinities as +-65504.
double sanitised(double value);

// Where the centre of output pixel x lies among the samples of an axis: at i it is that of texel i's sample.
double texel_coordinate(int x, int output, int render, double jitter);

// The samples on either side of a texel coordinate that is clamped to the edge, and how far it lies between.
struct Between {
  int left = 0;
  int right = 0;
  double fraction = 0;  // in [0, 1]
};
Between between_samples(double u, int size);

// The texel whose sample lies nearest to output pixel x on an axis; of two equally near the lower one.
int nearest_texel(int x, int output, int render, double jitter);

struct Tap {
  int texel;
  double weight;
};

// The two taps of output pixel x on an axis, clamped to [0, render - 1] one by one. A weight below 2^-25 is
// 0: the library rounds weights to multiples of 2^-24.
std::array<Tap, 2> bilinear_taps(int x, int output, int render, double jitter);

struct Sample {
  Pixel value = {};
  double largest = 0;
  bool non_finite = false;
};

// The texel's sanitised colour times a weight; a weight of 0 leaves the sample as it is.
void add(Sample& sample, const Pixel& texel, double weight);

// The reactive value of the nearest sample.
double reactive_at(const Frame& frame, int x, int y, int output_width, int output_height);

Sample sample_nearest(const Frame& frame, int x, int y, int output_width, int output_height);
Sample sample_bilinear(const Frame& frame, int x, int y, int output_width, int output_height);

}  // namespace quincunx::reference
