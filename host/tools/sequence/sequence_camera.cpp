// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_camera.h"

#include <array>
#include <cmath>
#include <utility>

namespace quincunx::tools {
namespace {

using Row = std::array<double, 4>;
using Rows = std::array<Row, 4>;

// Clip x, y and w of a world position as the matrix has them, and z such that z / w is reversed infinite
// depth.
Rows clip_from_world(const Matrix& column_major, float near_plane) {
  Rows rows;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column)
      rows[row][column] = column_major[4 * column + row];
  }
  rows[2] = {0, 0, 0, near_plane};
  return rows;
}

// Gauss-Jordan with row pivots.
std::optional<Rows> inverse(Rows m) {
  Rows result = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (std::size_t column = 0; column < 4; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < 4; ++row) {
      if (std::abs(m[row][column]) > std::abs(m[pivot][column])) pivot = row;
    }
    if (!(std::abs(m[pivot][column]) > 0)) return std::nullopt;
    std::swap(m[pivot], m[column]);
    std::swap(result[pivot], result[column]);
    const double scale = 1 / m[column][column];
    for (std::size_t i = 0; i < 4; ++i) {
      m[column][i] *= scale;
      result[column][i] *= scale;
    }
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const double factor = m[row][column];
      for (std::size_t i = 0; i < 4; ++i) {
        m[row][i] -= factor * m[column][i];
        result[row][i] -= factor * result[column][i];
      }
    }
  }
  return result;
}

}  // namespace

std::optional<CameraMotion> camera_motion(const Matrix& now, const Matrix& before, float near_plane) {
  CameraMotion motion;  // the identity
  if (now == before) return motion;
  const auto world_from_clip = inverse(clip_from_world(now, near_plane));
  if (!world_from_clip) return std::nullopt;
  const Rows previous = clip_from_world(before, near_plane);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i)
        sum += previous[row][i] * (*world_from_clip)[i][column];
      if (!std::isfinite(sum)) return std::nullopt;
      motion.clip_to_previous_clip[4 * column + row] = static_cast<float>(sum);
    }
  }
  return motion;
}

}  // namespace quincunx::tools
