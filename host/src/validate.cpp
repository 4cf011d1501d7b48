// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "frame_check.h"
#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

void check_camera(FrameCheck& check, const CameraMotion& camera) {
  for (const float element : camera.clip_to_previous_clip) {
    if (!std::isfinite(element)) {
      check.complain("camera.clip_to_previous_clip holds a value that is not finite; all 16 must be numbers");
      return;
    }
  }
}

// The caller's images: the plan's buffers of this name, the fields that hold them, and their viewports.
constexpr struct {
  const char* name;
  const char* field;
  ImageView FrameInputs::*image;
  Extent FrameInputs::*viewport = &FrameInputs::render;
} kInputs[] = {
    {"colour", "colour", &FrameInputs::colour},
    {"velocity", "velocity", &FrameInputs::velocity},
    {"drawn velocity", "velocity", &FrameInputs::velocity},
    {"depth", "depth", &FrameInputs::depth},
    {"reactive", "reactive", &FrameInputs::reactive},
    {"shaded colour", "colour", &FrameInputs::colour},
    {"shaded velocity", "velocity", &FrameInputs::velocity},
    {"shaded depth", "depth", &FrameInputs::depth},
    {"shaded reactive", "reactive", &FrameInputs::reactive},
    {"bare colour", "colour", &FrameInputs::colour},
    {"bare reactive", "reactive", &FrameInputs::reactive},
    {"particle colour", "particle_colour", &FrameInputs::particle_colour, &FrameInputs::particle_render},
    {"particle depth", "particle_depth", &FrameInputs::particle_depth, &FrameInputs::particle_render},
    {"particle reactive", "particle_reactive", &FrameInputs::particle_reactive,
     &FrameInputs::particle_render}};

constexpr struct {
  const char* name;
  ImageView FrameOutputs::*image;
  const char* absent;  // what a plan lacks that does not have it
} kOutputs[] = {{"resolved", &FrameOutputs::resolved, ""},
                {"blurred", &FrameOutputs::blurred, "motion blur; set settings.blur.shutter"},
                {"presented", &FrameOutputs::presented, "present pass; set settings.present"}};

const PlannedBuffer* find(const ResolvePlan& plan, std::string_view name) {
  const auto found = std::find_if(plan.buffers.begin(), plan.buffers.end(),
                                  [name](const PlannedBuffer& buffer) { return buffer.name == name; });
  return found != plan.buffers.end() ? &*found : nullptr;
}

// At least one pixel must be shaded.
void check_parity(FrameCheck& check, const FrameInputs& inputs) {
  const bool has_both = inputs.render.width > 1 || inputs.render.height > 1;
  if (inputs.parity == 0 || (inputs.parity == 1 && has_both)) return;
  check.complain(fmt::format("parity is {}; it must be {}", inputs.parity,
                             has_both ? "0 or 1" : "0 where the viewport is a single pixel"));
}

void check_outputs(FrameCheck& check, const ResolvePlan& plan, const FrameOutputs& outputs) {
  if (!outputs.resolved && !outputs.blurred && !outputs.presented) {
    check.complain("outputs are all missing; give resolved, blurred, presented or several");
  }
  for (const auto& output : kOutputs) {
    const ImageView& image = outputs.*output.image;
    if (!image) continue;
    const PlannedBuffer* buffer = find(plan, output.name);
    if (buffer == nullptr) {
      check.complain(fmt::format("{} is given, but the plan has no {}", output.name, output.absent));
      continue;
    }
    check.output(output.name, image, buffer->format,
                 buffer->owned ? Storage::kBuffer : plan.presented_storage(), plan.settings.output, "output");
  }
  if (outputs.blurred && find(plan, "blurred") != nullptr &&
      outputs.blurred.memory == outputs.resolved.memory &&
      outputs.blurred.offset == outputs.resolved.offset) {
    check.complain("blurred is the memory of resolved; give it other memory");
  }
}

}  // namespace

void check_inputs(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  constexpr float kLargest = 1e6f;
  check.viewport("render", inputs.render, plan.settings.target);
  if (plan.settings.particle_target != Extent())
    check.viewport("particle_render", inputs.particle_render, plan.settings.particle_target);
  for (const auto& input : kInputs) {
    const PlannedBuffer* buffer = find(plan, input.name);
    if (buffer == nullptr || buffer->owned) continue;
    check.input(input.field, inputs.*input.image, buffer->format, inputs.*input.viewport);
  }
  if (plan.velocity == VelocitySource::kTarget) {
    check.finite("velocity_scale.x", inputs.velocity_scale.x, -kLargest, kLargest);
    check.finite("velocity_scale.y", inputs.velocity_scale.y, -kLargest, kLargest);
  }
  if (plan.reads_camera()) check_camera(check, inputs.camera);
  if (plan.settings.shading == Shading::kCheckerboard) check_parity(check, inputs);
  check.finite("jitter.x", inputs.jitter.x, -1, 1);
  check.finite("jitter.y", inputs.jitter.y, -1, 1);
  check.finite("exposure", inputs.exposure, 0, kLargest);
}

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs& outputs) {
  FrameCheck check(plan);
  check_inputs(check, plan, inputs);
  check_outputs(check, plan, outputs);
  return check.status();
}

}  // namespace quincunx
