// SPDX-License-Identifier: MIT
// lay_focus in double precision: a region's picture over the picture.
#pragma once

#include <vector>

#include "picture.h"

namespace quincunx::reference {

// In pixels of the picture.
struct FocusPlace {
  struct Rectangle {
    int x, y, width, height;
  };

  int x = 0;  // upper left corner of the region
  int y = 0;
  std::vector<Rectangle> rectangles = {};  // empty: the whole region
  double feather = 16;
  std::vector<double> mask = {};  // weights of the region, in [0, 1]; empty: 1
};

// Returns the weight of the focus in a pixel of the picture. Within a rectangle, d pixels from the nearest edge that is
// not the picture's own, it is t t (3 - 2 t) with t = d / f, at most 1; f is the feather, at most a quarter of the
// rectangle's shorter side. Of several rectangles the largest counts, and the mask multiplies that.
double focus_weight(const Picture& picture, const Picture& focus, const FocusPlace& place, int x, int y);

// lay_focus: picture (1 - w) + focus w; where w is 0 the picture as it is and where w is 1 the focus as it is, between
// with NaN as 0 and infinities as +-65504. `largest` is of both.
Picture lay_focus(const Picture& picture, const Picture& focus, const FocusPlace& place);

}  // namespace quincunx::reference
