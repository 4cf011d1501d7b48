// SPDX-License-Identifier: MIT
#include "previous_places.h"

#include "pass.h"

namespace quincunx {
namespace {

// On one axis, from sample i of one frame to its place among the samples of another: i * step + start.
struct Axis {
  float step;
  float start;
};

Axis axis_between(int from, double from_jitter, int to, double to_jitter) {
  const double step = static_cast<double>(to) / from;
  return {static_cast<float>(step), static_cast<float>((.5 + from_jitter) * step - .5 - to_jitter)};
}

}  // namespace

PreviousPlaces previous_places(const FrameInputs& current, const FrameInputs& previous) {
  const Axis x =
      axis_between(current.render.width, current.jitter.x, previous.render.width, previous.jitter.x);
  const Axis y =
      axis_between(current.render.height, current.jitter.y, previous.render.height, previous.jitter.y);
  const VelocityScale to_previous = velocity_scale_to(current, previous.render);
  return {.step_x = x.step,
          .step_y = y.step,
          .start_x = x.start,
          .start_y = y.start,
          .motion_x = static_cast<float>(-to_previous.x),
          .motion_y = static_cast<float>(-to_previous.y),
          .edge_x = -.5f - previous.jitter.x,
          .edge_y = -.5f - previous.jitter.y};
}

}  // namespace quincunx
