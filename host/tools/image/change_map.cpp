// SPDX-License-Identifier: MIT
#include "tools/image/change_map.h"

#include <algorithm>
#include <cmath>

namespace quincunx::tools {
namespace {

float sample(const MeasuredPicture& picture, float u, float v) {
  const Extent extent = picture.extent();
  const float x =
      std::clamp(u * static_cast<float>(extent.width) - .5f, 0.f, static_cast<float>(extent.width - 1));
  const float y =
      std::clamp(v * static_cast<float>(extent.height) - .5f, 0.f, static_cast<float>(extent.height - 1));
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, extent.width - 1), bottom = std::min(top + 1, extent.height - 1);
  const auto at = [&](int column, int row) {
    return picture.luma()[static_cast<std::size_t>(row) * static_cast<std::size_t>(extent.width) +
                          static_cast<std::size_t>(column)];
  };
  const float across = x - static_cast<float>(left), down = y - static_cast<float>(top);
  return std::lerp(std::lerp(at(left, top), at(right, top), across),
                   std::lerp(at(left, bottom), at(right, bottom), across), down);
}

Vec2 motion_at(const MotionField& motion, float u, float v) {
  const auto x =
      std::min(static_cast<int>(u * static_cast<float>(motion.extent.width)), motion.extent.width - 1);
  const auto y =
      std::min(static_cast<int>(v * static_cast<float>(motion.extent.height)), motion.extent.height - 1);
  return motion.velocity[static_cast<std::size_t>(y) * static_cast<std::size_t>(motion.extent.width) +
                         static_cast<std::size_t>(x)];
}

}  // namespace

std::vector<float> flicker_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                               const MeasuredPicture& truth, const MeasuredPicture& previous_truth) {
  std::vector<float> map(picture.luma().size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const float change = picture.luma()[i] - previous.luma()[i];
    map[i] = std::abs(change - (truth.luma()[i] - previous_truth.luma()[i]));
  }
  return map;
}

std::vector<float> ghost_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                             const MotionField& motion) {
  const Extent extent = picture.extent();
  std::vector<float> map(picture.luma().size(), 0.f);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto width = static_cast<std::size_t>(extent.width);
    const float u = (static_cast<float>(i % width) + .5f) / static_cast<float>(extent.width);
    const float v = (static_cast<float>(i / width) + .5f) / static_cast<float>(extent.height);
    const Vec2 moved = motion_at(motion, u, v);
    const float from_u = u - moved.x, from_v = v - moved.y;
    const bool on_screen = from_u >= 0 && from_u <= 1 && from_v >= 0 && from_v <= 1;  // NaN is not
    if (on_screen) map[i] = std::abs(picture.luma()[i] - sample(previous, from_u, from_v));
  }
  return map;
}

}  // namespace quincunx::tools
