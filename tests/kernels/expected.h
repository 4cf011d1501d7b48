// SPDX-License-Identifier: MIT
// Whole frames as the references expect them, each value with its error bound.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../reference/reproject.h"
#include "error_table.h"
#include "kernel_fixture.h"

namespace quincunx::testing {

// A fatal failure unless `actual`, which a kernel stored, is as far from the value as its bound allows at most.
inline void expect_near(double expected, const reference::Bounded& bound, double actual,
                        const std::string& what, PixelFormat stored = PixelFormat::kRGBA32F,
                        Storage storage = Storage::kBuffer) {
  // The bound is that of the same value: what it is taken through differs by roundings of doubles.
  ASSERT_NEAR(expected, bound.value, 1e-12 * std::max(1.0, std::abs(expected))) << what;
  const double allowed = bound.error + output_rounding(stored, std::abs(expected) + bound.error, storage);
  ASSERT_TRUE(std::isfinite(actual)) << what;
  ASSERT_NEAR(expected, actual, allowed) << what;
  record_error({.error = std::abs(expected - actual),
                .bound = allowed,
                .largest = std::abs(expected),
                .stored = stored});
}

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
