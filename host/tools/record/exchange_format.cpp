// SPDX-License-Identifier: MIT
#include "tools/record/exchange_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace quincunx::tools {

float linear_z(float depth, float near_plane) {
  // With a reversed infinite projection clip z is the near distance and clip w the distance along the axis.
  // The comparison is written so that NaN fails it.
  if (!(depth > near_plane / kNoSurfaceZ)) return kNoSurfaceZ;
  return near_plane / depth;
}

float reversed_depth(float z, float near_plane) {
  if (!(z < kNoSurfaceZ)) return 0;
  return near_plane / std::max(z, near_plane);
}

Vec2 backward_from_velocity(Vec2 velocity, Extent extent) {
  return {-velocity.x * static_cast<float>(extent.width), velocity.y * static_cast<float>(extent.height)};
}

Vec2 velocity_from_backward(Vec2 backward, Extent extent) {
  return {-backward.x / static_cast<float>(extent.width), backward.y / static_cast<float>(extent.height)};
}

const char* name_of(VelocityConvention convention) {
  switch (convention) {
    case VelocityConvention::kNuke:
      return "nuke";
    case VelocityConvention::kBlender:
      return "blender";
    case VelocityConvention::kFsr2:
      return "fsr2";
    case VelocityConvention::kNdc:
      return "ndc";
    case VelocityConvention::kScale:
      return "scale";
  }
  return "unknown";
}

const char* name_of(DepthKind kind) {
  switch (kind) {
    case DepthKind::kLinear:
      return "linear";
    case DepthKind::kDevice:
      return "device";
    case DepthKind::kDeviceReversed:
      return "device-reversed";
  }
  return "unknown";
}

std::optional<DepthKind> depth_kind_named(std::string_view name) {
  for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed}) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

void to_velocity(const VelocityUnits& units, Extent extent, std::span<Vec2> motion) {
  const auto width = static_cast<float>(extent.width);
  const auto height = static_cast<float>(extent.height);
  if (units.to_next) {
    for (Vec2& m : motion)
      m = {-m.x, -m.y};
  }
  switch (units.convention) {
    case VelocityConvention::kNuke:
    case VelocityConvention::kBlender:
      for (Vec2& m : motion)
        m = velocity_from_backward(m, extent);
      return;
    case VelocityConvention::kFsr2:
      for (Vec2& m : motion)
        m = {-m.x / width, -m.y / height};
      return;
    case VelocityConvention::kNdc:
      for (Vec2& m : motion)
        m = {m.x * 0.5f, m.y * -0.5f};
      return;
    case VelocityConvention::kScale:
      for (Vec2& m : motion)
        m = {m.x * units.scale.x, m.y * units.scale.y};
      return;
  }
}

void to_reversed_depth(DepthKind kind, float near_plane, std::span<float> depth) {
  switch (kind) {
    case DepthKind::kLinear:
      for (float& d : depth)
        d = d > 0 ? reversed_depth(d, near_plane) : 0;
      return;
    case DepthKind::kDevice:
      for (float& d : depth)
        d = 1 - d;
      return;
    case DepthKind::kDeviceReversed:
      return;
  }
}

float nothing_seen(DepthKind kind) {
  return kind == DepthKind::kDevice ? 1.0f : 0.0f;
}

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
