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

struct DepthRange {
  double least, most;
};

DepthRange depths_around(const Frame& frame, double at_x, double at_y) {
  const int x = std::clamp(static_cast<int>(std::floor(at_x)), 0, std::max(frame.width - 2, 0));
  const int y = std::clamp(static_cast<int>(std::floor(at_y)), 0, std::max(frame.height - 2, 0));
  const int right = std::min(x + 1, frame.width - 1);
  const int below = std::min(y + 1, frame.height - 1);
  const double upper_left = depth_at(frame, x, y), upper_right = depth_at(frame, right, y);
  const double lower_left = depth_at(frame, x, below), lower_right = depth_at(frame, right, below);
  return {std::fmin(std::fmin(upper_left, upper_right), std::fmin(lower_left, lower_right)),
          std::fmax(std::fmax(upper_left, upper_right), std::fmax(lower_left, lower_right))};
}

// 1 inside the viewport, 0 a pixel away from it; `at` in texel coordinates.
double inside(double at, double jitter, int size) {
  const double from_edge = at + .5 + jitter;
  return std::clamp(1 - std::max(-from_edge, from_edge - size), 0.0, 1.0);
}

bool close_depths(double a, double b) {
  return std::abs(a - b) <= kDoubt * (std::abs(a) + std::abs(b));
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

// A neighbour whose difference is NaN does not count.
double contrast_at(const Frame& current, const ReprojectOptions& options, int x, int y) {
  const auto velocity_at = [&](int column, int row) {
    return current.velocity[static_cast<std::size_t>(row) * static_cast<std::size_t>(current.width) +
                            static_cast<std::size_t>(column)];
  };
  const auto& own = velocity_at(x, y);
  double largest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, current.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, current.width - 1); ++column) {
      const auto& other = velocity_at(column, row);
      const double dx = (other[0] - own[0]) * current.velocity_scale[0] * options.output_width;
      const double dy = (other[1] - own[1]) * current.velocity_scale[1] * options.output_height;
      largest = std::fmax(largest, dx * dx + dy * dy);
    }
  }
  return std::sqrt(std::min(largest, kLargestMove));
}

// Of the texels around (x, y), to `reach` on each side.
double largest_reactive(const Frame& frame, int x, int y, int reach) {
  double largest = 0;
  for (int row = std::max(y - reach, 0); row <= std::min(y + reach, frame.height - 1); ++row) {
    for (int column = std::max(x - reach, 0); column <= std::min(x + reach, frame.width - 1); ++column)
      largest = std::max(largest, frame.reactive[static_cast<std::size_t>(row * frame.width + column)]);
  }
  return largest;
}

double reactive_trust(const Frame& current, const Frame& previous, bool around, int x, int y,
                      std::size_t texel_before) {
  const int before = static_cast<int>(texel_before);
  if (!around) {
    return (1 - current.reactive[static_cast<std::size_t>(y * current.width + x)]) *
           (1 - previous.reactive[texel_before]);
  }
  return (1 - largest_reactive(current, x, y, 1)) *
         (1 - largest_reactive(previous, before % previous.width, before / previous.width, 2));
}

// What is left of trust where something nearer was at an edge of motion.
double left_by_edge(double contrast) {
  const double t = std::clamp((contrast - .15) / .45, 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
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
  const bool accumulates = options.output_width > 0;
  if (options.reactive) move.trust *= reactive_trust(current, previous, accumulates, x, y, texel_before);
  if (options.residual_weight > 0)
    apply_residual(move, current, previous, texel, texel_before, options.residual_weight);

  const double limit = 1.02 * depth + 2 * slope_at(current, x, y);
  const DepthRange before = depths_around(previous, at_x, at_y);
  if (!(before.least <= limit) && !std::isnan(move.trust)) move.trust = 0;
  const double earlier =
      options.contrast_before.empty() ? 0 : std::fmax(options.contrast_before[texel_before], 0);
  if (before.most > limit) move.trust *= left_by_edge(earlier);
  if (lost) move.trust = std::numeric_limits<double>::quiet_NaN();
  if (accumulates) {
    move.contrast = contrast_at(current, options, x, y);
    if (earlier > 0 && std::abs(earlier - move.contrast) <= kDoubt * earlier) move.undecided = true;
    if (earlier > move.contrast) move.contrast = -earlier;
  }

  const double doubt = kDoubt * move.reach;
  // The nearest texel changes half-way between two.
  const double steps = options.residual_weight > 0 || options.reactive || accumulates ? 2 : 1;
  move.undecided = move.undecided || close_to_integer(at_x * steps, doubt) ||
                   close_to_integer(at_y * steps, doubt) || close_depths(before.least, limit) ||
                   (accumulates && close_depths(before.most, limit));
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
