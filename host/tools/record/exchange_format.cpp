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
  if (units.offset != Vec2{}) {
    for (Vec2& m : motion)
      m = {m.x - units.offset.x, m.y - units.offset.y};
  }
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

void scale_depth(Vec2 range, DepthKind kind, std::span<float> depth) {
  if (range == kWholeRange) return;
  for (float& d : depth)
    d = std::isnan(d) ? nothing_seen(kind) : range.x + (range.y - range.x) * d;
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

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns the motion of an orthographic camera: alike at every distance, unless the axis turns.
std::optional<CameraMotion> orthographic_motion(const Matrix& now, const Matrix& before) {
  constexpr double kStraight = 1e-5;
  const auto row = [](const Matrix& m, std::size_t r) {
    const double w = m[15];
    return Vector{m[r] / w, m[4 + r] / w, m[8 + r] / w};
  };
  const Vector x = row(now, 0), y = row(now, 1);
  const Vector axis = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  const double xx = dot(x, x), xy = dot(x, y), yy = dot(y, y), area = xx * yy - xy * xy;
  CameraMotion motion;
  for (std::size_t r = 0; r < 2; ++r) {
    const Vector last = row(before, r);
    if (!(std::abs(dot(last, axis)) <= kStraight * std::sqrt(dot(last, last) * dot(axis, axis)) && area > 0))
      return std::nullopt;
    const double a = (dot(last, x) * yy - dot(last, y) * xy) / area;
    const double b = (dot(last, y) * xx - dot(last, x) * xy) / area;
    const double rest = before[12 + r] / before[15] - (a * now[12] + b * now[13]) / now[15];
    if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(rest)) return std::nullopt;
    motion.clip_to_previous_clip[r] = static_cast<float>(a);
    motion.clip_to_previous_clip[4 + r] = static_cast<float>(b);
    motion.clip_to_previous_clip[12 + r] = static_cast<float>(rest);
  }
  return motion;
}

}  // namespace

bool is_orthographic(const Matrix& m) {
  return m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] != 0;
}

Matrix transposed(Matrix matrix) {
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < row; ++column)
      std::swap(matrix[4 * row + column], matrix[4 * column + row]);
  return matrix;
}

CameraForm camera_form(const Matrix& m, Extent extent) {
  Vector x = {m[0], m[4], m[8]}, y = {m[1], m[5], m[9]};
  const Vector w = {m[3], m[7], m[11]};
  const double ahead = std::sqrt(dot(w, w));
  if (!(ahead > 0)) return {};
  const double right = dot(x, w) / dot(w, w), up = dot(y, w) / dot(w, w);  // the lens may be shifted
  for (std::size_t k = 0; k < 3; ++k)
    x[k] -= right * w[k], y[k] -= up * w[k];
  const double across = std::sqrt(dot(x, x)), down = std::sqrt(dot(y, y));
  const double skew = std::abs(dot(x, y)) / (across * down);
  const double aspect = across * extent.width / (down * extent.height);  // of a pixel
  const auto within = [&](double unit, double right_angle, double square) {
    return std::abs(std::log(ahead)) < unit && skew < right_angle && std::abs(std::log(aspect)) < square;
  };
  constexpr double kShift = 1;  // half pictures
  return {.is = within(.01, .001, .7) && std::abs(right) < kShift && std::abs(up) < kShift,
          .may_be = within(.1, .05, 1.6),
          .centre = {static_cast<float>(right), static_cast<float>(up)}};
}

CameraSense sense_of(const Matrix& matrix, Extent extent) {
  constexpr float kMiddle = .5f, kRoom = .25f;
  const CameraForm as_is = camera_form(matrix, extent), other = camera_form(transposed(matrix), extent);
  CameraSense sense = {.transposed = other.is && !as_is.may_be};
  const CameraForm& form = sense.transposed ? other : as_is;
  sense.unit =
      form.is && std::abs(form.centre.x - kMiddle) < kRoom && std::abs(form.centre.y - kMiddle) < kRoom;
  return sense;
}

Matrix to_screen(const Matrix& matrix, const CameraSense& sense) {
  Matrix m = sense.transposed ? transposed(matrix) : matrix;
  for (std::size_t row = 0; row < 16; row += 4) {
    const float w = m[row + 3];
    if (sense.unit) m[row] = 2 * m[row] - w, m[row + 1] = w - 2 * m[row + 1];
    if (sense.flipped) m[row + 1] = -m[row + 1];
  }
  return m;
}

std::string text_of(const CameraSense& sense) {
  return std::string(sense.unit ? "openexr" : "screen") + (sense.flipped ? ",flipped" : "") +
         (sense.transposed ? ",transposed" : "");
}

std::optional<CameraSense> camera_sense_named(std::string_view text) {
  for (int bits = 0; bits < 8; ++bits) {
    const CameraSense sense = {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
    if (text_of(sense) == text) return sense;
  }
  return std::nullopt;
}

std::optional<CameraMotion> camera_motion(const Matrix& now, const Matrix& before, float near_plane) {
  CameraMotion motion;  // the identity
  const bool is_same = now == before;
  if (is_orthographic(now) && is_orthographic(before))
    return is_same ? motion : orthographic_motion(now, before);
  const auto world_from_clip = inverse(clip_from_world(now, near_plane));
  if (!world_from_clip) return std::nullopt;
  if (is_same) return motion;
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
