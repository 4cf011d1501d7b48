// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "passes.h"

namespace quincunx::reference {
namespace {

// Clamped to the edge.
Pixel pixel_at(const Picture& picture, int x, int y) {
  const int column = std::clamp(x, 0, picture.width - 1);
  const int row = std::clamp(y, 0, picture.height - 1);
  Pixel pixel = picture.pixels[index_of(picture.width, column, row)];
  for (double& value : pixel)
    value = sanitised(value);
  return pixel;
}

}  // namespace

Picture sharpen(const Picture& picture, double sharpness) {
  Picture result{picture.width, picture.height, {}, {}, 0};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Pixel centre = pixel_at(picture, x, y);
      const std::array<Pixel, 4> around = {pixel_at(picture, x - 1, y), pixel_at(picture, x + 1, y),
                                           pixel_at(picture, x, y - 1), pixel_at(picture, x, y + 1)};
      Pixel out = centre;
      double largest = std::abs(centre[3]);
      for (std::size_t c = 0; c < 3; ++c) {
        double low = centre[c];
        double high = centre[c];
        double brightest = std::abs(centre[c]);
        double mean = 0;
        for (const Pixel& neighbour : around) {
          low = std::min(low, neighbour[c]);
          high = std::max(high, neighbour[c]);
          brightest = std::max(brightest, std::abs(neighbour[c]));
          mean += neighbour[c] / 4;
        }
        const double gain = sharpness * (1 + std::abs(centre[c])) / (1 + brightest);
        out[c] = std::clamp(centre[c] + gain * (centre[c] - mean), low, high);
        largest = std::max(largest, brightest);
      }
      result.pixels.push_back(out);
      result.largest.push_back(largest);
    }
  }
  return result;
}

}  // namespace quincunx::reference
