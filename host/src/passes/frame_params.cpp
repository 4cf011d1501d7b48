// SPDX-License-Identifier: MIT
#include "passes/frame_params.h"

#include <algorithm>

#include "passes/pass.h"
#include "resolve_params.h"

namespace quincunx {

FarPlaces far_places(const FrameInputs& inputs, Extent output) {
  const double aspect = static_cast<double>(output.width) / output.height;
  const double width = inputs.render_extent.width;
  const double height = inputs.render_extent.height;
  return {.step_x = static_cast<float>(aspect / width),
          .step_y = static_cast<float>(1 / height),
          .start_x = static_cast<float>(((.5 + inputs.jitter.x) / width - .5) * aspect),
          .start_y = static_cast<float>((.5 + inputs.jitter.y) / height - .5)};
}

CameraVelocity camera_params(const FrameInputs& inputs) {
  const double width = inputs.render_extent.width;
  const double height = inputs.render_extent.height;
  CameraVelocity camera{};
  camera.step_x = static_cast<float>(2 / width);
  camera.step_y = static_cast<float>(-2 / height);
  camera.start_x = static_cast<float>((1 + 2.0 * inputs.jitter.x) / width - 1);
  camera.start_y = static_cast<float>(1 - (1 + 2.0 * inputs.jitter.y) / height);
  std::copy(inputs.camera.clip_to_previous_clip.begin(), inputs.camera.clip_to_previous_clip.end(),
            camera.to_previous);
  return camera;
}

float inverse_scale(double scale) {
  return scale != 0 ? static_cast<float>(1 / scale) : 0.0f;
}

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

PreviousPlaces previous_places(const FrameInputs& inputs, const FrameInputs& previous) {
  const Axis x = axis_between(inputs.render_extent.width, inputs.jitter.x, previous.render_extent.width,
                              previous.jitter.x);
  const Axis y = axis_between(inputs.render_extent.height, inputs.jitter.y, previous.render_extent.height,
                              previous.jitter.y);
  const VelocityScale to_previous = velocity_scale_to(inputs, previous.render_extent);
  return {.step_x = x.step,
          .step_y = y.step,
          .start_x = x.start,
          .start_y = y.start,
          .motion_x = static_cast<float>(-to_previous.x),
          .motion_y = static_cast<float>(-to_previous.y),
          .edge_x = -.5f - previous.jitter.x,
          .edge_y = -.5f - previous.jitter.y};
}

int shaded_parity(const PlanFacts& facts, const FrameInputs& inputs) {
  return facts.fills() ? inputs.parity : -1;
}

TemporalParams temporal_params(const PassFrame& frame, const WorkShape& shape, const PlanFacts& facts) {
  const Extent output = frame.output;
  const Extent now = frame.inputs.render_extent;
  const Extent before = frame.previous.render_extent;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const Ratio spacing = ratio_of(output, now);
  const Ratio motion = ratio_of(output, before);
  return {.output_width = output.width,
          .output_height = output.height,
          .frame0 = {now.width, now.height, layout_of(frame[Resource::kColour]), {}, {}},
          .frame1 = {before.width, before.height, {}, {}, {}},
          .reprojection = layout_of(frame[Resource::kReprojection]),
          .output = {},
          .columns = position_columns(output),
          .counter = frame.counter.index,
          .columns_per_item = columns_per_item(shape, output.width, 1),
          .motion_x = motion.x,
          .motion_y = motion.y,
          .spacing_x = spacing.x,
          .spacing_y = spacing.y,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .parity = shaded_parity(facts, frame.inputs)};
}

TemporalDisplayParams temporal_display_params(const PassFrame& frame, const WorkShape& shape,
                                              Resource picture) {
  return {.output_width = frame.output.width,
          .output_height = frame.output.height,
          .output = layout_of(frame[picture]),
          .tiles_x = extent_of(Area::kTiles, frame.extents()).width,
          .columns_per_item = columns_per_item(shape, frame.output.width, 1),
          .first = frame.has_history ? 0 : 1};
}

namespace {

// Where a frame's samples lie.
struct SamplePlaces {
  Ratio spacing;
  Ratio start;
};

SamplePlaces places_of(const FrameInputs& inputs, Extent output) {
  const Ratio spacing = ratio_of(output, inputs.render_extent);
  return {spacing, {(.5f + inputs.jitter.x) * spacing.x, (.5f + inputs.jitter.y) * spacing.y}};
}

}  // namespace

LayerParams layer_params(const PassFrame& frame, const WorkShape& shape, Extent extent) {
  const FrameInputs& inputs = frame.inputs;
  const Extent render = inputs.render_extent;
  const Extent before = frame.previous.render_extent;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const SamplePlaces now = places_of(inputs, frame.output);
  const SamplePlaces previous = places_of(frame.previous, frame.output);
  const VelocityScale motion = velocity_scale_to(inputs, frame.output);
  const Ratio to_previous = ratio_of(before, frame.output);
  return {.width = render.width,
          .height = render.height,
          .previous_width = before.width,
          .previous_height = before.height,
          .velocity = layout_of(frame[Resource::kVelocity]),
          .depth = layout_of(frame[Resource::kDepth]),
          .reprojection = layout_of(frame[Resource::kReprojection]),
          .spacing_x = now.spacing.x,
          .spacing_y = now.spacing.y,
          .start_x = now.start.x,
          .start_y = now.start.y,
          .previous_spacing_x = previous.spacing.x,
          .previous_spacing_y = previous.spacing.y,
          .previous_start_x = previous.start.x,
          .previous_start_y = previous.start.y,
          .motion_x = static_cast<float>(-motion.x),
          .motion_y = static_cast<float>(-motion.y),
          .to_previous_x = to_previous.x,
          .to_previous_y = to_previous.y,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .columns_per_item = columns_per_item(shape, extent.width, 1)};
}

HistorySamples history_samples(const FrameInputs& inputs, Extent output, TexelLayout depth) {
  const SamplePlaces places = places_of(inputs, output);
  return {.depth = depth,
          .width = inputs.render_extent.width,
          .height = inputs.render_extent.height,
          .spacing_x = places.spacing.x,
          .spacing_y = places.spacing.y,
          .start_x = places.start.x,
          .start_y = places.start.y};
}

}  // namespace quincunx
