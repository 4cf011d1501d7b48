// SPDX-License-Identifier: MIT
#include "reproject.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace quincunx::reference {
namespace {

constexpr double kLargestMove = 65504;
// Well above what single precision makes of a comparison, and far below what a scene shows.
constexpr double kDoubt = 1e-5;

double depth_at(const Frame& frame, int x, int y) {
  return frame.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                     static_cast<std::size_t>(x)];
}

// -1 becomes 1, n becomes n - 2; in a viewport of one texel all become 0.
int reflected(int i, int size) {
  if (size == 1) return 0;
  if (i < 0) return -i;
  return i >= size ? 2 * (size - 1) - i : i;
}

double slope_at(const Frame& frame, int x, int y) {
  const double centre = depth_at(frame, x, y);
  const auto step = [&](int dx, int dy) {
    return std::abs(depth_at(frame, reflected(x + dx, frame.width), reflected(y + dy, frame.height)) -
                    centre);
  };
  return std::fmin(step(-1, 0), step(1, 0)) + std::fmin(step(0, -1), step(0, 1));
}

double smallest_depth(const Frame& frame, double at_x, double at_y) {
  const int x = std::clamp(static_cast<int>(std::floor(at_x)), 0, std::max(frame.width - 2, 0));
  const int y = std::clamp(static_cast<int>(std::floor(at_y)), 0, std::max(frame.height - 2, 0));
  const int right = std::min(x + 1, frame.width - 1);
  const int below = std::min(y + 1, frame.height - 1);
  return std::fmin(std::fmin(depth_at(frame, x, y), depth_at(frame, right, y)),
                   std::fmin(depth_at(frame, x, below), depth_at(frame, right, below)));
}

// 1 inside the viewport, 0 a pixel away from it; `at` in texel coordinates.
double inside(double at, double jitter, int size) {
  const double from_edge = at + .5 + jitter;
  return std::clamp(1 - std::max(-from_edge, from_edge - size), 0.0, 1.0);
}

bool close_to_integer(double value, double doubt) {
  return std::abs(value - std::nearbyint(value)) <= doubt;
}

// Index of the texel nearest to a place in texel coordinates.
std::size_t nearest_at(const Frame& frame, double at_x, double at_y) {
  const int x = std::clamp(static_cast<int>(std::floor(at_x + .5)), 0, frame.width - 1);
  const int y = std::clamp(static_cast<int>(std::floor(at_y + .5)), 0, frame.height - 1);
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
}

void apply_residual(Move& move, const Frame& current, const Frame& previous, std::size_t texel,
                    std::size_t texel_before, double weight) {
  const auto& v0 = current.velocity[texel];
  const auto& v1 = previous.velocity[texel_before];
  double squared = 0;
  const int sizes[][2] = {{current.width, previous.width}, {current.height, previous.height}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double now = std::sqrt(weight) * v0[axis] * current.velocity_scale[axis] * sizes[axis][0];
    const double before = std::sqrt(weight) * v1[axis] * previous.velocity_scale[axis] * sizes[axis][1];
    squared += (now - before) * (now - before);
    move.speed += std::abs(now) + std::abs(before);
  }
  move.trust /= 1 + squared;
  if (!std::isfinite(v1[0]) || !std::isfinite(v1[1])) move.trust = std::numeric_limits<double>::quiet_NaN();
}

Move move_of(const Frame& current, const Frame& previous, const ReprojectOptions& options, int x, int y) {
  const auto texel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(current.width) + static_cast<std::size_t>(x);
  const double depth = current.depth[texel];
  std::array<double, 2> velocity = current.velocity[texel];
  const bool lost = !std::isfinite(velocity[0]) || !std::isfinite(velocity[1]) || !std::isfinite(depth);
  if (lost) velocity = {0, 0};

  Move move;
  move.x = std::clamp(-velocity[0] * current.velocity_scale[0] * previous.width, -kLargestMove, kLargestMove);
  move.y =
      std::clamp(-velocity[1] * current.velocity_scale[1] * previous.height, -kLargestMove, kLargestMove);
  const double still_x =
      (x + .5 + current.jitter_x) / current.width * previous.width - .5 - previous.jitter_x;
  const double still_y =
      (y + .5 + current.jitter_y) / current.height * previous.height - .5 - previous.jitter_y;
  const double at_x = still_x + move.x;
  const double at_y = still_y + move.y;
  move.reach = 2 + std::max(std::abs(still_x) + std::abs(move.x), std::abs(still_y) + std::abs(move.y));
  move.trust =
      inside(at_x, previous.jitter_x, previous.width) * inside(at_y, previous.jitter_y, previous.height);
  const std::size_t texel_before = nearest_at(previous, at_x, at_y);
  if (options.reactive) move.trust *= (1 - current.reactive[texel]) * (1 - previous.reactive[texel_before]);
  if (options.residual_weight > 0)
    apply_residual(move, current, previous, texel, texel_before, options.residual_weight);

  const double limit = 1.02 * depth + 2 * slope_at(current, x, y);
  const double before = smallest_depth(previous, at_x, at_y);
  if (!(before <= limit) && !std::isnan(move.trust)) move.trust = 0;
  if (lost) move.trust = std::numeric_limits<double>::quiet_NaN();

  const double doubt = kDoubt * move.reach;
  // The nearest texel changes half-way between two.
  const double steps = options.residual_weight > 0 || options.reactive ? 2 : 1;
  move.undecided = close_to_integer(at_x * steps, doubt) || close_to_integer(at_y * steps, doubt) ||
                   std::abs(before - limit) <= kDoubt * (std::abs(before) + std::abs(limit));
  return move;
}

}  // namespace

std::vector<Move> reproject(const Frame& current, const Frame& previous, const ReprojectOptions& options) {
  std::vector<Move> moves;
  for (int y = 0; y < current.height; ++y) {
    for (int x = 0; x < current.width; ++x)
      moves.push_back(move_of(current, previous, options, x, y));
  }
  return moves;
}

}  // namespace quincunx::reference
