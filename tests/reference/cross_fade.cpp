// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "passes.h"

namespace quincunx::reference {

Picture cross_fade(const Picture& picture, const Picture& other, double weight) {
  Picture result{picture.width, picture.height, {}, {}, 0};
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    Pixel out = {};
    double largest = 0;
    for (std::size_t c = 0; c < out.size(); ++c) {
      const double to = sanitised(picture.pixels[i][c]), from = sanitised(other.pixels[i][c]);
      out[c] = from + weight * (to - from);
      largest = std::max({largest, std::abs(to), std::abs(from)});
    }
    result.pixels.push_back(out);
    result.largest.push_back(largest);
  }
  return result;
}

}  // namespace quincunx::reference
