// SPDX-License-Identifier: MIT
// reproject: where what a sample shows was in the previous frame, and how far that is to be trusted. v, z:
// velocity and depth of the sample; p: its place among the previous frame's samples if it stood still.
//   (x, y)       -v in pixels of the previous frame
//   trust        1 inside the previous viewport, 0 a pixel away from it ...
//                ... times (1 - reactive) of both frames
//                ... / (1 + K |v - v'|^2), v' the velocity of the previous frame there, both in render pixels
//                ... 0 if all 2 x 2 previous depths are nearer than the sample: > (1.02 z + 2 |dz|) nearer
//                ... times 1 - strength of the previous frame's motion edge there, if one of them is
//   open trust   trust before depths and the previous motion edge take from it
//   motion edge  the largest |v - v_neighbour| in 3 x 3, or the previous frame's there if that is larger
// nearer: how many times nearer the camera's matrix puts the sample in the previous frame, 1 to 4; with a sample's clip
// coordinates c, as in velocity_from_depth.cpp, and p = clip_to_previous_clip c: 1 / (p.w / matrix(2, 2)).
// A depth is 1 / distance: the larger the nearer. |dz| takes on each axis the gentler side, so that thin
// features hide nothing.
// Source: found by measuring (docs/lab/methods.md, docs/lab/temporal.md).
#include "reproject.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "motion_edge.h"

namespace quincunx::reference {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestMotion = 65504;  // pixels: beyond any viewport
constexpr double kDepthTolerance = 1.02;  // times the sample's depth
constexpr double kSlopeTolerance = 2;     // times the change of depth to the next sample
// Texels around a place in which a reactive value takes trust, where pictures are accumulated: whatever a
// pixel holds has come from that far. In this frame, and in the previous one.
constexpr int kReactiveReach = 1;
constexpr int kReactiveReachBefore = 2;
constexpr double kReactiveUnit = 1. / 255;  // step of the codes that reactive values are stored in

// ---- Depth.

double depth_at(const Frame& frame, int x, int y) {
  return frame.depth[index_of(frame.width, x, y)];
}

// -1 becomes 1, n becomes n - 2; in a viewport of one texel all become 0.
int reflected(int i, int size) {
  if (size == 1) return 0;
  if (i < 0) return -i;
  return i >= size ? 2 * (size - 1) - i : i;
}

// A depth that is not finite does not count.
template <typename Real>
Real depth_slope(const Frame& frame, int x, int y) {
  const auto difference = [&](int dx, int dy) {
    return std::abs(depth_at(frame, reflected(x + dx, frame.width), reflected(y + dy, frame.height)) -
                    depth_at(frame, x, y));
  };
  const Real across = std::fmin(difference(-1, 0), difference(1, 0));
  const Real down = std::fmin(difference(0, -1), difference(0, 1));
  return across + down;
}

// How many times nearer what a sample shows was if it stands still, at least 1.
template <typename Real>
Real nearer_before(const Frame& frame, int x, int y) {
  constexpr double kLeastApproach = .25;  // ratio of the distances before and after the camera's step
  const auto& matrix = frame.clip_to_previous_clip;
  const auto last_row = [&](int column) {
    return matrix[static_cast<std::size_t>(column) * 4 + 3] / matrix[10];
  };
  const double right = 2. / frame.width * last_row(0);
  const double down = -2. / frame.height * last_row(1);
  const double start = last_row(3) + last_row(0) * ((1 + 2 * frame.jitter_x) / frame.width - 1) +
                       last_row(1) * (1 - (1 + 2 * frame.jitter_y) / frame.height);
  const Real distance =
      x * Real(right) + depth_at(frame, x, y) * Real(last_row(2)) + (y * Real(down) + Real(start));
  return 1 / clamp(distance, kLeastApproach, 1);
}

struct DepthRange {
  double least = 0;
  double most = 0;
};

// Returns the range of depths of the 2 x 2 samples around a place in texel coordinates, clamped to the edge.
template <typename Real>
DepthRange depths_around(const Frame& frame, const std::array<Real, 2>& at) {
  const int x = floor_within(at[0], 0, std::max(frame.width - 2, 0));
  const int y = floor_within(at[1], 0, std::max(frame.height - 2, 0));
  const int right = std::min(x + 1, frame.width - 1);
  const int below = std::min(y + 1, frame.height - 1);
  const double upper_left = depth_at(frame, x, y), upper_right = depth_at(frame, right, y);
  const double lower_left = depth_at(frame, x, below), lower_right = depth_at(frame, right, below);
  return {std::fmin(std::fmin(upper_left, upper_right), std::fmin(lower_left, lower_right)),
          std::fmax(std::fmax(upper_left, upper_right), std::fmax(lower_left, lower_right))};
}

// ---- Places.

struct Axis {
  int size = 0, previous_size = 0;
  double jitter = 0, previous_jitter = 0;
};

// The texel coordinate in the previous frame of sample i, if it stands still.
template <typename Real>
Real place_of_still(const Axis& axis, int i) {
  const double step = static_cast<double>(axis.previous_size) / axis.size;
  const double start = (.5 + axis.jitter) * step - .5 - axis.previous_jitter;
  return i * Real(step) + start;
}

// 1 inside the previous viewport, 0 a pixel away from it.
template <typename Real>
Real inside(const Real& at, const Axis& axis) {
  const Real edge = -.5 - axis.previous_jitter;
  return clamp(1 - max(edge - at, at - (edge + axis.previous_size)), 0, 1);
}

// ---- What takes trust.

// Returns the largest reactive value of the texels up to `reach` away from (x, y): a code of 8 bits, 255 for 1.
double largest_reactive(const Frame& frame, int x, int y, int reach) {
  double largest = 0;
  for (int row = std::max(y - reach, 0); row <= std::min(y + reach, frame.height - 1); ++row) {
    for (int column = std::max(x - reach, 0); column <= std::min(x + reach, frame.width - 1); ++column)
      largest = std::max(largest, frame.reactive[index_of(frame.width, column, row)]);
  }
  return std::nearbyint(255 * largest);
}

struct Velocity {
  double x = 0;
  double y = 0;

  bool is_finite() const { return std::isfinite(x) && std::isfinite(y); }
};

Velocity velocity_at(const Frame& frame, int x, int y) {
  const auto& velocity = frame.velocity[index_of(frame.width, x, y)];
  return {velocity[0], velocity[1]};
}

// K |v - v'|^2, each velocity in render pixels of its own frame.
template <typename Real>
Real squared_residual(const Frame& current, const Velocity& now, const Frame& previous,
                      const Velocity& before, double weight) {
  const double root = std::sqrt(weight);
  const Real x = now.x * Real(root * current.velocity_scale[0] * current.width) -
                 before.x * Real(root * previous.velocity_scale[0] * previous.width);
  const Real y = now.y * Real(root * current.velocity_scale[1] * current.height) -
                 before.y * Real(root * previous.velocity_scale[1] * previous.height);
  return x * x + y * y;
}

// Output pixels a frame. A neighbour whose difference is NaN does not count.
template <typename Real>
Real motion_edge_at(const Frame& frame, const ReprojectOptions& options, int x, int y) {
  const Velocity own = velocity_at(frame, x, y);
  Real largest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, frame.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, frame.width - 1); ++column) {
      const Velocity other = velocity_at(frame, column, row);
      if (std::isnan(other.x - own.x) || std::isnan(other.y - own.y)) continue;
      const Real dx = (Real(other.x) - own.x) * (frame.velocity_scale[0] * options.output_width);
      const Real dy = (Real(other.y) - own.y) * (frame.velocity_scale[1] * options.output_height);
      largest = max(largest, dx * dx + dy * dy);
    }
  }
  return sqrt(min(largest, kLargestMotion));
}

}  // namespace

template <typename Real>
ReprojectionOf<Real> reproject(const Frame& current, const Frame& previous, const ReprojectOptions& options,
                               int x, int y) {
  const bool accumulates = options.output_width > 0;
  const double depth = depth_at(current, x, y);
  const Velocity velocity = velocity_at(current, x, y);
  bool is_lost = !velocity.is_finite() || !std::isfinite(depth);
  const Velocity known = is_lost ? Velocity{} : velocity;

  const Axis columns = {current.width, previous.width, current.jitter_x, previous.jitter_x};
  const Axis rows = {current.height, previous.height, current.jitter_y, previous.jitter_y};
  ReprojectionOf<Real> result;
  result.x =
      clamp(-known.x * Real(current.velocity_scale[0] * previous.width), -kLargestMotion, kLargestMotion);
  result.y =
      clamp(-known.y * Real(current.velocity_scale[1] * previous.height), -kLargestMotion, kLargestMotion);
  const std::array<Real, 2> at = {place_of_still<Real>(columns, x) + result.x,
                                  place_of_still<Real>(rows, y) + result.y};
  result.trust = inside(at[0], columns) * inside(at[1], rows);

  // The previous frame's sample that is nearest to the place.
  int before_x = 0;
  int before_y = 0;
  if (options.reactive || options.residual_weight > 0 || accumulates) {
    before_x = floor_within(at[0] + .5, 0, previous.width - 1);
    before_y = floor_within(at[1] + .5, 0, previous.height - 1);
  }
  if (options.reactive) {
    const Real now = largest_reactive(current, x, y, accumulates ? kReactiveReach : 0);
    const Real before =
        largest_reactive(previous, before_x, before_y, accumulates ? kReactiveReachBefore : 0);
    result.trust *= (1 - now * kReactiveUnit) * (1 - before * kReactiveUnit);
  }
  if (options.residual_weight > 0) {
    const Velocity before = velocity_at(previous, before_x, before_y);
    is_lost = is_lost || !before.is_finite();
    if (!is_lost)
      result.trust /=
          1 + squared_residual<Real>(current, velocity, previous, before, options.residual_weight);
  }

  result.open_trust = result.trust;

  // Depths that are larger are nearer than the sample.
  const Real tolerated = kDepthTolerance * Real(depth) + kSlopeTolerance * depth_slope<Real>(current, x, y);
  const Real limit = tolerated * nearer_before<Real>(current, x, y);
  const DepthRange depths = depths_around(previous, at);
  const double edge_before =
      options.motion_edges_before.empty()
          ? 0
          : std::fmax(options.motion_edges_before[index_of(previous.width, before_x, before_y)], 0);
  if (!(depths.least <= limit)) result.trust = 0;
  if (accumulates && depths.most > limit) result.trust *= 1 - motion_edge_strength(Real(edge_before));
  if (is_lost) result.trust = kNan;

  if (accumulates) {
    result.motion_edge = motion_edge_at<Real>(current, options, x, y);
    if (edge_before > 0 && edge_before > result.motion_edge) result.motion_edge = -edge_before;
  }
  return result;
}

template ReprojectionOf<double> reproject(const Frame&, const Frame&, const ReprojectOptions&, int, int);
template ReprojectionOf<Bounded> reproject(const Frame&, const Frame&, const ReprojectOptions&, int, int);

}  // namespace quincunx::reference
