// SPDX-License-Identifier: MIT
#include "plan/inputs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx {
namespace {

// Turns the rows that are in use of a buffer. An image has none that could be turned here.
void turn(ImageView& view, int rows) {
  if (!view || view.storage == Storage::kImage) return;
  const std::size_t pitch = view.row_pitch();
  view.offset += static_cast<std::size_t>(rows - 1) * pitch;
  view.pitch = ~pitch + 1;
}

// From uv velocity, +y down, to the caller's, its inverse.
Vec2 scale_to_uv(const InputConventions& given, const FrameInputs& inputs) {
  const bool is_set = inputs.velocity_scale != Vec2{};
  double x = is_set ? static_cast<double>(inputs.velocity_scale.x) : 1;
  double y = is_set ? static_cast<double>(inputs.velocity_scale.y) : 1;
  if (given.velocity_unit == VelocityUnit::kNdc) x /= 2, y /= 2;
  if (given.velocity_unit == VelocityUnit::kPixels)
    x /= inputs.render_extent.width, y /= inputs.render_extent.height;
  if (given.velocity_backward) x = -x, y = -y;
  if (given.velocity_up) y = -y;
  return {static_cast<float>(x), static_cast<float>(y)};
}

// The caller's depth in clip space as scale * near / distance + start.
struct ClipDepth {
  double scale = 1;
  double start = 0;
};

ClipDepth clip_depth(const InputConventions& given, const FrameInputs& inputs) {
  if (given.depth == DepthConvention::kLinear) return {};
  const double reach =
      needs_far_plane(given.depth) ? 1 - static_cast<double>(inputs.near_plane) / inputs.far_plane : 1;
  const bool reversed =
      given.depth == DepthConvention::kReversedInfinite || given.depth == DepthConvention::kReversed;
  ClipDepth depth = reversed ? ClipDepth{1 / reach, 1 - 1 / reach} : ClipDepth{-1 / reach, 1 / reach};
  if (given.clip_space == ClipSpace::kOpenGl) depth = {2 * depth.scale, 2 * depth.start - 1};
  return depth;
}

// The identity, which says that the camera is not known, stays. The third row is not read by any kernel.
CameraMotion native_camera(const InputConventions& given, const FrameInputs& inputs) {
  CameraMotion camera = inputs.camera;
  auto& matrix = camera.clip_to_previous_clip;
  if (matrix == CameraMotion{}.clip_to_previous_clip) return camera;
  const ClipDepth depth = clip_depth(given, inputs);
  for (std::size_t row = 0; row < 4; ++row) {
    const double of_depth = static_cast<double>(matrix[8 + row]);
    matrix[8 + row] = static_cast<float>(of_depth * depth.scale);
    matrix[12 + row] = static_cast<float>(static_cast<double>(matrix[12 + row]) + of_depth * depth.start);
  }
  if (given.clip_space == ClipSpace::kVulkan) {
    for (std::size_t i = 0; i < 4; ++i)
      matrix[4 + i] = -matrix[4 + i];
    for (std::size_t i = 0; i < 4; ++i)
      matrix[4 * i + 1] = -matrix[4 * i + 1];
  }
  return camera;
}

void turn(FrameInputs& inputs, const ResolveSettings& settings) {
  for (const InputImage& input : kInputs)
    if (input.viewport != nullptr) turn(inputs.*input.image, (inputs.*input.viewport).height);
  turn(inputs.fading_from, settings.output_extent.height);
  inputs.jitter.y = -inputs.jitter.y;
  inputs.parity = (inputs.parity + inputs.render_extent.height - 1) % 2;
}

}  // namespace

FrameInputs native_inputs(const ResolveSettings& settings, FrameInputs inputs) {
  const InputConventions& given = settings.conventions;
  if (given == InputConventions{}) return inputs;
  inputs.velocity_scale = scale_to_uv(given, inputs);
  inputs.camera = native_camera(given, inputs);
  if (given.origin == Origin::kBottom) turn(inputs, settings);
  return inputs;
}

FocusInputs native_focus(const ResolveSettings& settings, FocusInputs focus) {
  if (settings.conventions.origin == Origin::kTop) return focus;
  const int height = settings.output_extent.height;
  const Extent region = settings.focus.extent;
  focus.y = height - focus.y - region.height;
  for (Rectangle& rectangle : focus.rectangles)
    rectangle.y = height - rectangle.y - rectangle.height;
  turn(focus.mask, region.height);
  return focus;
}

FrameOutputs native_outputs(const ResolveSettings& settings, FrameOutputs outputs) {
  if (settings.conventions.origin == Origin::kTop) return outputs;
  turn(outputs.linear, settings.output_extent.height);
  turn(outputs.presented, settings.output_extent.height);
  return outputs;
}

Vec2 jitter_motion(const FrameInputs& inputs, const FrameInputs& previous) {
  const auto between = [](float jitter, int size, float before, int size_before) {
    return static_cast<float>(static_cast<double>(before) / size_before - static_cast<double>(jitter) / size);
  };
  return {
      between(inputs.jitter.x, inputs.render_extent.width, previous.jitter.x, previous.render_extent.width),
      between(inputs.jitter.y, inputs.render_extent.height, previous.jitter.y,
              previous.render_extent.height)};
}

Conversion conversion_of(const InputImage& input, const ResolveSettings& settings) {
  const InputConventions& given = settings.conventions;
  const bool is_depth = input.image == &FrameInputs::depth || input.image == &FrameInputs::particle_depth;
  if (is_depth && given.depth != DepthConvention::kReversedInfinite) return Conversion::kDepth;
  if (input.image == &FrameInputs::velocity && given.velocity_jittered) return Conversion::kVelocity;
  const bool turns = given.origin == Origin::kBottom && settings.targets.storage == Storage::kImage;
  return turns ? Conversion::kRows : Conversion::kNone;
}

// Where samples lie.
namespace {

constexpr std::int64_t kMaxPhases = 512;

bool is_empty(Extent extent) {
  return extent.width < 1 || extent.height < 1;
}

// Halton's radical inverse of `index` in `base`, in (0, 1) for index >= 1.
double radical_inverse(std::uint64_t index, unsigned base) {
  double result = 0;
  double digit_weight = 1.0 / base;
  for (; index > 0; index /= base, digit_weight /= base)
    result += static_cast<double>(index % base) * digit_weight;
  return result;
}

}  // namespace

int jitter_phases(Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return 1;
  const auto area = [](Extent of) {  // of no more than a frame can have, which 64 bits hold eight times
    return Extent{std::min(of.width, kLargestSide), std::min(of.height, kLargestSide)}.area();
  };
  return static_cast<int>(std::min((8 * area(output) + area(render) - 1) / area(render), kMaxPhases));
}

Vec2 jitter(std::uint64_t frame_index, Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return {};
  const auto phases = static_cast<std::uint64_t>(jitter_phases(render, output));
  const auto place = [&](unsigned base) {
    double mean = 0;
    for (std::uint64_t i = 1; i <= phases; ++i)
      mean += radical_inverse(i, base) / static_cast<double>(phases);
    return static_cast<float>(radical_inverse(frame_index % phases + 1, base) - mean);
  };
  return {place(2), place(3)};
}

float texture_lod_bias(Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return 0;
  const double scale = static_cast<double>(render.area()) / static_cast<double>(output.area());
  return static_cast<float>(.5 * std::log2(scale) - 1);
}

}  // namespace quincunx
