// SPDX-License-Identifier: MIT
#include "plan/native_frame.h"

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
Vec2 scale_to_uv(const InputConventions& given, const FrameInputs& frame) {
  const bool is_set = frame.velocity_scale != Vec2{};
  double x = is_set ? static_cast<double>(frame.velocity_scale.x) : 1;
  double y = is_set ? static_cast<double>(frame.velocity_scale.y) : 1;
  if (given.velocity_unit == VelocityUnit::kNdc) x /= 2, y /= 2;
  if (given.velocity_unit == VelocityUnit::kPixels)
    x /= frame.render_extent.width, y /= frame.render_extent.height;
  if (given.velocity_backward) x = -x, y = -y;
  if (given.velocity_up) y = -y;
  return {static_cast<float>(x), static_cast<float>(y)};
}

// The caller's depth in clip space as scale * near / distance + start.
struct ClipDepth {
  double scale = 1;
  double start = 0;
};

ClipDepth clip_depth(const InputConventions& given, const FrameInputs& frame) {
  if (given.depth == DepthConvention::kLinear) return {};
  const double reach =
      needs_far_plane(given.depth) ? 1 - static_cast<double>(frame.near_plane) / frame.far_plane : 1;
  const bool reversed =
      given.depth == DepthConvention::kReversedInfinite || given.depth == DepthConvention::kReversed;
  ClipDepth depth = reversed ? ClipDepth{1 / reach, 1 - 1 / reach} : ClipDepth{-1 / reach, 1 / reach};
  if (given.clip_space == ClipSpace::kOpenGl) depth = {2 * depth.scale, 2 * depth.start - 1};
  return depth;
}

// The identity, which says that the camera is not known, stays. The third row is not read by any kernel.
CameraMotion native_camera(const InputConventions& given, const FrameInputs& frame) {
  CameraMotion camera = frame.camera;
  auto& matrix = camera.clip_to_previous_clip;
  if (matrix == CameraMotion{}.clip_to_previous_clip) return camera;
  const ClipDepth depth = clip_depth(given, frame);
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

void turn(FrameInputs& frame, const ResolveSettings& settings) {
  for (const InputImage* input : kInputImages)
    turn(frame.*input->image, (frame.*input->viewport).height);
  turn(frame.fading_from, settings.output_extent.height);
  frame.jitter.y = -frame.jitter.y;
  frame.parity = (frame.parity + frame.render_extent.height - 1) % 2;
}

}  // namespace

FrameInputs native_inputs(const ResolveSettings& settings, FrameInputs frame) {
  const InputConventions& given = settings.conventions;
  if (given == InputConventions{}) return frame;
  frame.velocity_scale = scale_to_uv(given, frame);
  frame.camera = native_camera(given, frame);
  if (given.origin == Origin::kBottom) turn(frame, settings);
  return frame;
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

Vec2 jitter_motion(const FrameInputs& frame, const FrameInputs& previous) {
  const auto between = [](float jitter, int size, float before, int size_before) {
    return static_cast<float>(static_cast<double>(before) / size_before - static_cast<double>(jitter) / size);
  };
  return {
      between(frame.jitter.x, frame.render_extent.width, previous.jitter.x, previous.render_extent.width),
      between(frame.jitter.y, frame.render_extent.height, previous.jitter.y, previous.render_extent.height)};
}

Conversion conversion_of(const InputImage& input, const ResolveSettings& settings) {
  const InputConventions& given = settings.conventions;
  const bool is_depth = &input == &kDepthInput || &input == &kParticleDepthInput;
  if (is_depth && given.depth != DepthConvention::kReversedInfinite) return Conversion::kDepth;
  if (&input == &kVelocityInput && given.velocity_jittered) return Conversion::kVelocity;
  const bool turns = given.origin == Origin::kBottom && settings.targets.storage == Storage::kImage;
  return turns ? Conversion::kRows : Conversion::kNone;
}

}  // namespace quincunx
