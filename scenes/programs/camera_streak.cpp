// SPDX-License-Identifier: MIT
#include "programs/camera_streak.h"

#include <array>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr std::array<float, 3> kMetres = {2, 8, 32};
constexpr std::array<float, 5> kPlaces = {-0.8f, -0.4f, 0, 0.4f, 0.8f};  // in normalised device coordinates

// -1 where the point was behind the camera.
double way_px(const std::array<float, 16>& m, float x, float y, float depth, Extent output) {
  const auto row = [&](std::size_t i) { return m[i] * x + m[4 + i] * y + m[8 + i] * depth + m[12 + i]; };
  const float w = row(3);
  if (!(w > 0)) return -1;
  return std::hypot(0.5 * output.width * (x - row(0) / w), 0.5 * output.height * (y - row(1) / w));
}

}  // namespace

double camera_streak_px(const CameraMotion& motion, float near_plane, Extent output, float shutter) {
  double sum = 0;
  int count = 0;
  for (const float metres : kMetres) {
    for (const float y : kPlaces) {
      for (const float x : kPlaces) {
        const double way = way_px(motion.clip_to_previous_clip, x, y, near_plane / metres, output);
        if (way < 0 || !std::isfinite(way)) continue;
        sum += way;
        ++count;
      }
    }
  }
  return count > 0 ? shutter * sum / count : 0;
}

}  // namespace quincunx::scenes
