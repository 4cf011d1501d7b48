// SPDX-License-Identifier: MIT
// Disocclusion: which pixels show what was hidden a moment ago, where a method that trusts the past shows ghosts. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/speed_error/geometry.h"

namespace quincunx::bench {

// 1 for each pixel of `now` whose place in `before` lies on screen and is hidden there: all four pixels
// around it are nearer. 0 where it comes from outside the picture.
std::vector<std::uint8_t> disoccluded_since(const Geometry& now, const Geometry& before);

// `newer`, and what comes from where `older`, the mask of the frame before, is 1.
std::vector<std::uint8_t> disoccluded_within_two(const Geometry& now, std::vector<std::uint8_t> newer,
                                                 const std::vector<std::uint8_t>& older);

}  // namespace quincunx::bench
