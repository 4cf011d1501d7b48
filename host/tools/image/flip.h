// SPDX-License-Identifier: MIT
// FLIP: the difference that an observer sees when two pictures are shown in turn, per pixel and in the mean.
//
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", 2020 (LDR-FLIP).
#pragma once

#include <span>
#include <vector>

#include "quincunx/advanced/extent.h"

namespace quincunx::tools {

// A screen of 3840 pixels on 0.7 m, seen from 0.7 m: the paper's choice.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658225;

// `picture` and `truth`: extent.area() * 3 values in [0, 1], sRGB encoded R G B, rows top-down; both finite.
// Returns extent.area() values in [0, 1], 0 for equal pixels in equal neighbourhoods. Symmetric. Pure and
// thread-safe.
std::vector<float> flip_map(Extent extent, std::span<const float> picture, std::span<const float> truth,
                            double pixels_per_degree = kFlipPixelsPerDegree);

double flip_mean(std::span<const float> map);

}  // namespace quincunx::tools
