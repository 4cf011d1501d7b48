// SPDX-License-Identifier: MIT
// FrameLayout: where the planes of a frame lie in the memory of a slot. Arithmetic only.
//
// The planes lie one behind the other, in regions that are sized for the largest viewport and never move. With
// Targets::kViewport a region is one image of that size. With Targets::kPlaced it holds an image of just the frame's
// viewport, whose rows follow each other without a gap, as far as `row_texels` allows.
#pragma once

#include <cstddef>
#include <vector>

#include "plane.h"

namespace quincunx::gl {

struct FrameLayout {
  SharedFrame views;  // of the largest viewport, in buffers, without memory
  std::size_t bytes = 0;
};

// `row_texels`: rows of placed images start at multiples of so many texels, at least 1.
FrameLayout lay_out(const std::vector<Plane>& planes, Extent target, Targets targets, int row_texels);

// Makes a placed image one of the viewport `render`, which is at most the largest: the same memory, another pitch.
void place(ImageView& view, Extent render, int row_texels);

}  // namespace quincunx::gl
