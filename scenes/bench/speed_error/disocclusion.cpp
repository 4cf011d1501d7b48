// SPDX-License-Identifier: MIT
#include "bench/speed_error/disocclusion.h"

#include <algorithm>
#include <cmath>

namespace quincunx::bench {
namespace {

struct Place {
  double x = 0;  // pixels; the centre of pixel (0, 0) is 0
  double y = 0;
};

// Where pixel i of this frame was in the frame before.
Place previous_place(const Geometry& now, std::size_t i) {
  const auto width = static_cast<std::size_t>(now.extent.width);
  return {static_cast<double>(i % width) - double{now.velocity[i].x} * now.extent.width,
          static_cast<double>(i / width) - double{now.velocity[i].y} * now.extent.height};
}

// Index of the pixel at or up and left of a place; -1 where it and its neighbours right and below are not all
// in the picture.
std::int64_t corner_of(Place place, Extent extent) {
  const double x = std::floor(place.x);
  const double y = std::floor(place.y);
  const bool inside = x >= 0 && y >= 0 && x < extent.width - 1 && y < extent.height - 1;
  return inside ? static_cast<std::int64_t>(y) * extent.width + static_cast<std::int64_t>(x) : -1;
}

}  // namespace

std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before) {
  std::vector<std::uint8_t> mask(now.depth.size(), 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::int64_t corner = corner_of(previous_place(now, i), before.extent);
    if (corner < 0) continue;
    const float* upper = before.depth.data() + corner;
    const float* lower = upper + before.extent.width;
    const float farthest = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
    mask[i] = is_nearer(farthest, now.depth[i]) ? 1 : 0;
  }
  return mask;
}

std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older) {
  for (std::size_t i = 0; i < newer.size(); ++i) {
    const Place place = previous_place(now, i);
    const std::int64_t nearest = corner_of({std::round(place.x), std::round(place.y)}, now.extent);
    if (nearest >= 0) newer[i] |= older[static_cast<std::size_t>(nearest)];
  }
  return newer;
}

}  // namespace quincunx::bench
