// SPDX-License-Identifier: MIT
// The camera's motion p from the drawn velocities v of what stands still: least squares over samples at (x, y) of
// reversed depth z, in heights of the picture from its middle, of
//   v = (p0 + p1 x^2 + p3 x y - p4 y + p5 x + z (p6 + p8 x), p2 + p1 x y + p3 y^2 + p4 x + p5 y + z (p7 + p8 y))
// Source: Longuet-Higgins and Prazdny, "The Interpretation of a Moving Retinal Image", 1980.
#include "far_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

constexpr double kFarthestDepth = 1e-9;
constexpr double kNearestToFar = 1e-6;  // reversed depth: what is farther counts no more
constexpr double kLargeResidual = .25;  // output pixels
constexpr double kFastest = 16;         // heights of the picture
constexpr double kLeastPivot = 1e-7;
constexpr double kLargest = 65504;
// Added to each parameter's sum of squares, of that sum.
constexpr std::array<double, kFarTerms> kHold = {1e-6, 1e-3, 1e-6, 1e-3, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4};

double aspect_of(const FarInputs& in) {
  return static_cast<double>(in.output_width) / in.output_height;
}

template <typename Real>
struct Terms {
  FarModel<Real> x, y;
};

template <typename Real>
Terms<Real> terms_at(const FarInputs& in, int column, int row, double depth) {
  const Frame& frame = in.frame;
  const double aspect = aspect_of(in);
  const Real x =
      column * Real(aspect / frame.width) + Real(((.5 + frame.jitter_x) / frame.width - .5) * aspect);
  const Real y = row * Real(1. / frame.height) + Real((.5 + frame.jitter_y) / frame.height - .5);
  const Real z = depth;
  return {{1, x * x, 0, x * y, -y, x, z, 0, z * x}, {0, x * y, 1, y * y, x, y, 0, z, z * y}};
}

template <typename Real>
std::array<Real, 2> velocity_of(const FarModel<double>& model, const Terms<Real>& terms) {
  std::array<Real, 2> velocity = {0, 0};
  for (std::size_t i = 0; i < kFarTerms; ++i) {
    velocity[0] += model[i] * terms.x[i];
    velocity[1] += model[i] * terms.y[i];
  }
  return velocity;
}

template <typename Real>
Real luma_of(const Pixel& colour) {
  const Real red = sanitised(colour[0]);
  return max(.25 * (red + 2 * Real(sanitised(colour[1])) + Real(sanitised(colour[2]))), 0);
}

// Returns the previous frame's luma at a place among its samples.
template <typename Real>
Real luma_between(const Frame& frame, const std::array<Real, 2>& at) {
  const int x = floor_within(at[0], 0, frame.width - 1);
  const int y = floor_within(at[1], 0, frame.height - 1);
  const Real fx = at[0] - x;
  const Real fy = at[1] - y;
  const auto on_row = [&](int row) {
    const auto left = luma_of<Real>(texel_clamped(frame, x, row));
    return left + (luma_of<Real>(texel_clamped(frame, x + 1, row)) - left) * fx;
  };
  const Real upper = on_row(y);
  return upper + (on_row(y + 1) - upper) * fy;
}

// Whether something as far away was seen there.
template <typename Real>
bool is_evidence(const Frame& frame, const std::array<Real, 2>& at) {
  if (!(at[0] >= 0 && at[1] >= 0 && at[0] <= frame.width - 1 && at[1] <= frame.height - 1)) return false;
  const int x = floor_within(at[0] + .5, 0, frame.width - 1);
  const int y = floor_within(at[1] + .5, 0, frame.height - 1);
  return std::abs(frame.depth[index_of(frame.width, x, y)]) <= kFarthestDepth;
}

// Every second sample of every second row.
template <typename Function>
void for_each_asked(const Frame& frame, int cell_x, int cell_y, const Function& function) {
  for (int y = cell_y * kFarCell; y < std::min((cell_y + 1) * kFarCell, frame.height); y += 2) {
    for (int x = cell_x * kFarCell; x < std::min((cell_x + 1) * kFarCell, frame.width); x += 2)
      function(x, y);
  }
}

}  // namespace

bool is_far_and_still(const Frame& frame, int x, int y) {
  const std::size_t i = index_of(frame.width, x, y);
  return std::abs(frame.depth[i]) <= kFarthestDepth && frame.velocity[i][0] == 0 && frame.velocity[i][1] == 0;
}

template <typename Real>
FarSums<Real> far_surroundings(const FarInputs& in, int cell_x, int cell_y) {
  const Frame& frame = in.frame;
  FarSums<Real> sums;
  for_each_asked(frame, cell_x, cell_y, [&](int x, int y) {
    const std::size_t i = index_of(frame.width, x, y);
    const double z = frame.depth[i];
    const std::array<Real, 2> velocity = {
        frame.velocity[i][0] * Real(frame.velocity_scale[0] * aspect_of(in)),
        frame.velocity[i][1] * Real(frame.velocity_scale[1])};
    const bool tells = std::abs(z) <= 1 && abs(velocity[0]) <= kFastest && abs(velocity[1]) <= kFastest;
    if (!tells || is_far_and_still(frame, x, y)) return;
    const Terms<Real> terms = terms_at<Real>(in, x, y, z);
    Real weight = Real(1) / max(Real(std::abs(z)), kNearestToFar);
    if (in.is_known) {
      const std::array<Real, 2> known = velocity_of(in.model, terms);
      const Real dx = (velocity[0] - known[0]) * Real(in.output_height / kLargeResidual);
      const Real dy = (velocity[1] - known[1]) * Real(in.output_height / kLargeResidual);
      weight /= 1 + dx * dx + dy * dy;
    }
    for (std::size_t row = 0; row < kFarTerms; ++row) {
      const Real weighted_x = weight * terms.x[row];
      const Real weighted_y = weight * terms.y[row];
      for (std::size_t column = 0; column <= row; ++column)
        sums.products[row][column] += weighted_x * terms.x[column] + weighted_y * terms.y[column];
      sums.velocities[row] += weighted_x * velocity[0] + weighted_y * velocity[1];
    }
  });
  return sums;
}

// Cholesky, of equations whose diagonal was scaled to 1.
template <typename Real>
FarModel<Real> far_fit(const FarSums<double>& total) {
  FarModel<Real> scale, found;
  std::array<std::array<Real, kFarTerms>, kFarTerms> lower = {};
  for (std::size_t i = 0; i < kFarTerms; ++i) {
    scale[i] = total.products[i][i] > 0 ? Real(1) / sqrt(Real(total.products[i][i])) : Real(0);
    for (std::size_t j = 0; j <= i; ++j) {
      Real rest = i == j ? 1 + Real(kHold[i]) : Real(total.products[i][j]) * (scale[i] * scale[j]);
      for (std::size_t k = 0; k < j; ++k)
        rest = rest - lower[i][k] * lower[j][k];
      lower[i][j] = i == j ? sqrt(max(rest, kLeastPivot)) : rest / lower[j][j];
    }
  }
  for (std::size_t i = 0; i < kFarTerms; ++i) {
    found[i] = Real(total.velocities[i]) * scale[i];
    for (std::size_t k = 0; k < i; ++k)
      found[i] = found[i] - lower[i][k] * found[k];
    found[i] /= lower[i][i];
  }
  for (std::size_t i = kFarTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kFarTerms; ++k)
      found[i] = found[i] - lower[k][i] * found[k];
    found[i] /= lower[i][i];
  }
  for (std::size_t i = 0; i < kFarTerms; ++i)
    found[i] *= scale[i];
  return found;
}

template <typename Real>
std::array<Real, 2> far_match(const FarInputs& in, int cell_x, int cell_y) {
  const Frame& frame = in.frame;
  const Frame& previous = in.previous;
  std::array<Real, 2> errors = {0, 0};
  for_each_asked(frame, cell_x, cell_y, [&](int x, int y) {
    if (!is_far_and_still(frame, x, y)) return;
    const std::array<Real, 2> moves = velocity_of(in.model, terms_at<Real>(in, x, y, 0));
    const double step_x = static_cast<double>(previous.width) / frame.width;
    const double step_y = static_cast<double>(previous.height) / frame.height;
    const std::array<Real, 2> stays_at = {
        x * Real(step_x) + Real((.5 + frame.jitter_x) * step_x - .5 - previous.jitter_x),
        y * Real(step_y) + Real((.5 + frame.jitter_y) * step_y - .5 - previous.jitter_y)};
    const std::array<Real, 2> moves_from = {stays_at[0] - moves[0] * Real(previous.width / aspect_of(in)),
                                            stays_at[1] - moves[1] * Real(previous.height)};
    if (!is_evidence(previous, stays_at) || !is_evidence(previous, moves_from)) return;
    const auto now = luma_of<Real>(texel_at(frame, x, y));
    const auto add = [&](Real& error, const std::array<Real, 2>& at) {
      const Real before = luma_between(previous, at);
      error += abs(now - before) / (1 + now + before);
    };
    add(errors[0], stays_at);
    add(errors[1], moves_from);
  });
  return errors;
}

template <typename Real>
std::array<Real, 2> modelled_far_velocity(const FarInputs& in, int x, int y) {
  std::array<Real, 2> velocity = velocity_of(in.model, terms_at<Real>(in, x, y, 0));
  const std::array<double, 2> scale = {in.frame.velocity_scale[0] * aspect_of(in),
                                       in.frame.velocity_scale[1]};
  for (std::size_t axis = 0; axis < 2; ++axis)
    velocity[axis] = clamp(velocity[axis] * Real(1 / scale[axis]), -kLargest, kLargest);
  return velocity;
}

template FarSums<double> far_surroundings(const FarInputs&, int, int);
template FarSums<Bounded> far_surroundings(const FarInputs&, int, int);
template FarModel<double> far_fit(const FarSums<double>&);
template FarModel<Bounded> far_fit(const FarSums<double>&);
template std::array<double, 2> far_match(const FarInputs&, int, int);
template std::array<Bounded, 2> far_match(const FarInputs&, int, int);
template std::array<double, 2> modelled_far_velocity(const FarInputs&, int, int);
template std::array<Bounded, 2> modelled_far_velocity(const FarInputs&, int, int);

}  // namespace quincunx::reference
