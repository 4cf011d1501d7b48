// SPDX-License-Identifier: MIT
#include "lay_focus.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quincunx::reference {
namespace {

// From a pixel's centre inwards from the edges at `first` and `first + size`; an edge of the picture is no edge.
double distance_inside(double centre, int first, int size, int picture) {
  double nearest = std::numeric_limits<double>::infinity();
  if (first > 0) nearest = std::min(nearest, centre - first);
  if (first + size < picture) nearest = std::min(nearest, first + size - centre);
  return nearest;
}

double weight_in(const Picture& picture, const FocusPlace::Rectangle& inside, double feather, int x, int y) {
  if (x < inside.x || x >= inside.x + inside.width || y < inside.y || y >= inside.y + inside.height) return 0;
  const double distance = std::min(distance_inside(x + .5, inside.x, inside.width, picture.width),
                                   distance_inside(y + .5, inside.y, inside.height, picture.height));
  const double over = std::min(feather, std::min(inside.width, inside.height) / 4.0);
  const double t = std::min(distance / over, 1.0);
  return t * t * (3 - 2 * t);
}

bool is_in_region(const Picture& focus, const FocusPlace& place, int x, int y) {
  return x >= place.x && x < place.x + focus.width && y >= place.y && y < place.y + focus.height;
}

}  // namespace

double focus_weight(const Picture& picture, const Picture& focus, const FocusPlace& place, int x, int y) {
  if (!is_in_region(focus, place, x, y)) return 0;
  double weight = 0;
  for (const FocusPlace::Rectangle& inside : place.rectangles)
    weight = std::max(weight, weight_in(picture, inside, place.feather, x, y));
  if (place.rectangles.empty())
    weight = weight_in(picture, {place.x, place.y, focus.width, focus.height}, place.feather, x, y);
  if (!place.mask.empty()) weight *= place.mask[index_of(focus.width, x - place.x, y - place.y)];
  return weight;
}

Picture lay_focus(const Picture& picture, const Picture& focus, const FocusPlace& place) {
  Picture result = picture;
  result.largest.assign(picture.pixels.size(), 0);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t at = index_of(picture.width, x, y);
      const double weight = focus_weight(picture, focus, place, x, y);
      for (std::size_t c = 0; c < 4; ++c) {
        const double under = picture.pixels[at][c];
        result.largest[at] = std::max(result.largest[at], std::abs(sanitised(under)));
        if (weight == 0) continue;
        const double over = focus.pixels[index_of(focus.width, x - place.x, y - place.y)][c];
        result.largest[at] = std::max(result.largest[at], std::abs(sanitised(over)));
        result.pixels[at][c] =
            weight == 1 ? over : sanitised(under) * (1 - weight) + sanitised(over) * weight;
      }
    }
  }
  return result;
}

}  // namespace quincunx::reference
