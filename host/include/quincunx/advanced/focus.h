// SPDX-License-Identifier: MIT
// FocusInputs: a part of the picture that is drawn a second time, at a larger scale, and laid over it.
//
// See docs/options.md#focus. Plain structs; a zero means the default written beside the field.
#pragma once

#include <array>

#include "quincunx/advanced/extent.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"

namespace quincunx {

// The *region* is a rectangle of ResolveSettings::focus.extent output pixels, which may lie elsewhere in every frame.
// `frame` is the view of a camera that looks at just that rectangle, by the conventions of any other frame: its
// viewport covers the region, its jitter is in its own pixels, and its velocity and camera motion are relative to the
// region, which may have moved since the frame before. In a region that follows a thing, that thing stands still. The
// images of `frame` have the lifetime of those of the picture's frame.
struct FocusInputs {
  static constexpr int kMaxRectangles = 4;
  static constexpr float kDefaultFeather = 16;

  FrameInputs frame =
      {};     // exposure, parity and frame_index are the picture's; reset is set with the picture's as well
  int x = 0;  // the output pixel at the region's upper left corner; the region lies within the picture
  int y = 0;
  // The parts that show the focus, in output pixels, each within the region; the first `rectangle_count` count. None:
  // the whole region.
  std::array<Rectangle, kMaxRectangles> rectangles = {};
  int rectangle_count = 0;
  // Output pixels inside of a rectangle over which the focus sets in; 0: kDefaultFeather. At most a quarter of the
  // rectangle's shorter side is used. A side that is the picture's own has none.
  float feather = 0;
  // A factor of the focus's weight, R8, the region's extent, a buffer; 255: 1. Read with ResolveSettings::focus.mask.
  ImageView mask = {};
};

}  // namespace quincunx
