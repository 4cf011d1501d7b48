// SPDX-License-Identifier: MIT
// motion_tiles, motion_neighbours and motion_blur: the specification. Places are whole numbers, as the kernels
// define them, so that every device finds the same samples; colours are in double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "picture.h"

namespace quincunx::reference {

// Velocity times `scale` (a float each, from the target's units to 1/64 output pixels over the shutter), cut
// to whole numbers within +-2^14; 0 where it is not finite.
struct Streak {
  int x = 0;
  int y = 0;
};

struct BlurInput {
  const Frame* frame = nullptr;  // velocity and depth, jitter, viewport
  std::array<float, 2> scale = {};
  int output_width = 0;
  int output_height = 0;
  int most_samples = 8;  // samples of a pixel
};

struct BlurTile {
  int kind = 0;  // 0 nothing moves by half a pixel, 1 all alike to a quarter, 2 mixed
  int samples = 4;
  Streak longest;
};

// Tiles of 32 x 32 output pixels, row by row.
// A tile in which nothing moves by half a pixel on an axis counts as still.
std::vector<BlurTile> blur_tiles(const BlurInput& input);

// `resolved`: output extent, finite.
Picture motion_blur(const BlurInput& input, const std::vector<Pixel>& resolved);

}  // namespace quincunx::reference
