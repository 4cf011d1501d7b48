// SPDX-License-Identifier: MIT
// quincunx-render --why: one picture of what each kind of method makes of the same frame, and what that takes here.
#pragma once

#include <span>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"
#include "session/render_options.h"

namespace quincunx::scenes {

// The upper left pixel of a part of a picture.
struct Place {
  int x = 0;
  int y = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

// Returns the parts of a picture, `part` pixels large, with the largest sums of `values`, the largest first: `count` of
// them, or as many as fit without overlap and a quarter of the picture apart on an axis. `values`: one a pixel, none
// negative, rows top-down. `part`: within the picture. Pure.
std::vector<Place> largest_parts(Extent picture, std::span<const float> values, Extent part, int count);

// Draws the scene at options.scale by bilinear, quincunx and temporal, whose history is full by then, and writes to
// options.why, whole or not at all, three places where these differ most: a row a place, and truth beside them. Errors:
// of any part, as it words them.
Status draw_why(const RenderOptions& options);

}  // namespace quincunx::scenes
