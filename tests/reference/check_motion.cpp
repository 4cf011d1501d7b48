// SPDX-License-Identifier: MIT
#include "check_motion.h"

namespace quincunx::reference {
namespace {

constexpr int kStep = 8;
constexpr int kSamples = 4;
constexpr double kLeastSpeed = 1;  // samples of the previous frame
constexpr double kMostContrast = .25;
constexpr double kLeastLight = 1e-30;

template <typename Real>
Real luma_of(const Pixel& colour) {
  const Real red = sanitised(colour[0]);
  return max(.25 * (red + 2 * Real(sanitised(colour[1])) + Real(sanitised(colour[2]))), 0);
}

// A tent of two samples to each side; beyond its edge a frame goes on as it ends.
template <typename Real>
Real soft_luma(const Frame& frame, const Real& x, const Real& y) {
  const auto weight = [](const Real& at, int i) { return max(2 - abs(at - Real(i)), 0); };
  Real sum = 0;
  for (int j = -2; j < frame.height + 2; ++j) {
    const Real down = weight(y, j);
    if (!seamless(down > 0)) continue;
    Real row = 0;
    for (int i = -2; i < frame.width + 2; ++i) {
      const Real across = weight(x, i);
      if (seamless(across > 0)) row += across * luma_of<Real>(texel_clamped(frame, i, j));
    }
    sum += down * row;
  }
  return sum * Real(1. / 16);
}

template <typename Real>
struct Axis {
  Real still;  // where a sample was that does not move
  Real moved;  // by how much, since then, backwards in time

  bool stays_within(int size) const { return still - abs(moved) >= 0 && still + abs(moved) <= size - 1; }
};

template <typename Real>
Axis<Real> axis_of(int i, int size, double jitter, int previous, double previous_jitter, double velocity,
                   double scale) {
  const double step = static_cast<double>(previous) / size;
  const Real moved = sanitised(velocity) * Real(scale * previous);
  return {i * Real(step) + Real((.5 + jitter) * step - .5 - previous_jitter), -clamp(moved, -65504, 65504)};
}

}  // namespace

template <typename Real>
std::array<MotionErrors<Real>, 2> check_motion(const Frame& frame, const Frame& previous, int cell_x,
                                               int cell_y) {
  std::array<MotionErrors<Real>, 2> found;
  for (int j = cell_y * kSamples; j < (cell_y + 1) * kSamples; ++j) {
    for (int i = cell_x * kSamples; i < (cell_x + 1) * kSamples; ++i) {
      const int column = i * kStep + kStep / 2, row = j * kStep + kStep / 2;
      if (column >= frame.width || row >= frame.height) continue;
      const auto& velocity = frame.velocity[index_of(frame.width, column, row)];
      const Axis<Real> x = axis_of<Real>(column, frame.width, frame.jitter_x, previous.width,
                                         previous.jitter_x, velocity[0], frame.velocity_scale[0]);
      const Axis<Real> y = axis_of<Real>(row, frame.height, frame.jitter_y, previous.height,
                                         previous.jitter_y, velocity[1], frame.velocity_scale[1]);
      const std::array<bool, 2> moves = {abs(x.moved) >= kLeastSpeed, abs(y.moved) >= kLeastSpeed};
      if (!moves[0] && !moves[1]) continue;
      if (!x.stays_within(previous.width) || !y.stays_within(previous.height)) continue;
      const Real now = soft_luma<Real>(frame, column, row);
      for (std::size_t reading = 0; reading < 4; ++reading) {
        const Real from_x = x.still + (reading % 2 != 0 ? -x.moved : x.moved);
        const Real from_y = y.still + (reading / 2 != 0 ? -y.moved : y.moved);
        const Real then = soft_luma(previous, from_x, from_y);
        const Real contrast = min(abs(now - then) / (now + then + kLeastLight), kMostContrast);
        const Real error = contrast * contrast * Real(1 / (kMostContrast * kMostContrast));
        for (std::size_t axis = 0; axis < 2; ++axis)
          if (moves[axis]) found[axis].errors[reading] += error;
      }
      for (std::size_t axis = 0; axis < 2; ++axis)
        found[axis].samples += moves[axis] ? 1 : 0;
    }
  }
  return found;
}

template std::array<MotionErrors<double>, 2> check_motion(const Frame&, const Frame&, int, int);
template std::array<MotionErrors<Bounded>, 2> check_motion(const Frame&, const Frame&, int, int);

}  // namespace quincunx::reference
