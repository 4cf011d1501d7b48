// SPDX-License-Identifier: MIT
// What references expect of whole frames, each value with its error bound.
#pragma once

#include <vector>

#include "../reference/reproject.h"

namespace quincunx::testing {

// reference(Real{}, x, y) at each place of an extent, row by row.
template <typename Reference>
auto expected_pixels(int width, int height, Reference reference) {
  const auto at = [&](int x, int y) {
    return reference::expected_of([&](auto zero) { return reference(zero, x, y); });
  };
  std::vector<decltype(at(0, 0))> all;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      all.push_back(at(x, y));
  }
  return all;
}

inline auto expected_reprojections(const reference::Frame& current, const reference::Frame& previous,
                                   const reference::ReprojectOptions& options) {
  return expected_pixels(current.width, current.height, [&]<typename Real>(Real, int x, int y) {
    return reference::reproject<Real>(current, previous, options, x, y);
  });
}

}  // namespace quincunx::testing
