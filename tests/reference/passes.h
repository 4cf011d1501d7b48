// SPDX-License-Identifier: MIT
// What each pass should give, in double precision.
#pragma once

#include <array>
#include <cstdint>

#include "scale.h"

namespace quincunx::reference {

struct CameraVelocity {
  std::array<double, 2> velocity;  // uv; NaN where depth is not finite, +-65504 at most
  double condition;  // for error bounds: the sums of magnitudes behind the previous position, over w
  double w_part;     // w of the previous position by its sum of magnitudes: small where terms cancel
};

// At each texel of the viewport. What was not before the previous camera (w <= 0) has 65504 twice.
std::vector<CameraVelocity> velocity_from_depth(const Frame& frame);

enum class Weight { kMean, kVelocity };

// out = (c0 + f c1) / (1 + f), f = (1 - reactive0) (1 - reactive1) / (1 + K (|v0|^2 + |v1|^2)), v in render
// pixels of its own frame; c0, c1 by bilinear samples or, `nearest`, by one.
Picture resolve_quincunx(const Frame& current, const Frame& previous, Weight weight, bool nearest,
                         bool reactive, double k, int output_width, int output_height);

// Each colour channel moves away from the mean of its four neighbours and stays in the range of the
// five. `largest` is of all five.
Picture sharpen(const Picture& picture, double sharpness);

enum class Curve { kClamp, kReinhard, kAces };

// 255 * the sRGB encoding of tone-mapped colour, and 255 * alpha, before rounding.
Pixel present_codes(const Pixel& resolved, Curve curve, double exposure);

// What the dither adds before truncation at a pixel, in [0, 1).
double dither_offset(int x, int y);

}  // namespace quincunx::reference
