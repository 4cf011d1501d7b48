// SPDX-License-Identifier: MIT
// Pictures that the examples write, and how far apart two are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "quincunx/image.h"

namespace quincunx::testing {

// The texels of a PPM file, which has this size.
inline std::string ppm_texels(const std::string& file, Extent extent) {
  const std::string head =
      "P6 " + std::to_string(extent.width) + " " + std::to_string(extent.height) + " 255\n";
  EXPECT_EQ(file.substr(0, head.size()), head);
  EXPECT_EQ(file.size(), head.size() + static_cast<std::size_t>(extent.area()) * 3);
  return file.substr(std::min(head.size(), file.size()));
}

inline double mean_square_error(const std::string& a, const std::string& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double difference = static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i]);
    sum += difference * difference;
  }
  return sum / static_cast<double>(a.size());
}

}  // namespace quincunx::testing
