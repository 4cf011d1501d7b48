// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "frame_check.h"
#include "plan_facts.h"
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
                {"displayed", &FrameOutputs::displayed, "dynamic output; set settings.least_output"},
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
  if (!outputs.resolved && !outputs.blurred && !outputs.displayed && !outputs.presented) {
    check.complain("outputs are all missing; give resolved, blurred, displayed, presented or several");
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
  const auto check_apart = [&](const char* name, const ImageView& image, const char* other_name,
                               const ImageView& other) {
    if (!image || image.memory != other.memory || image.offset != other.offset) return;
    check.complain(fmt::format("{0} is the memory of {1}; give it other memory", name, other_name));
  };
  check_apart("blurred", outputs.blurred, "resolved", outputs.resolved);
  check_apart("displayed", outputs.displayed, "resolved", outputs.resolved);
  check_apart("displayed", outputs.displayed, "blurred", outputs.blurred);
}

void check_fade(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  if (!inputs.fading_from) return;
  if (!plan.settings.fades) {
    check.complain("fading_from is given, but the plan has no cross-fade; set settings.fades");
    return;
  }
  check.output("fading_from", inputs.fading_from, plan.settings.resolved, Storage::kBuffer,
               plan.settings.output, "output");
  check.finite("fade_weight", inputs.fade_weight, 0, 1);
}

void check_output_extent(FrameCheck& check, const ResolvePlan& plan, Extent output) {
  const Extent most = plan.settings.output;
  const Extent least = plan.is_dual() ? plan.settings.least_output : most;
  if (output == Extent{}) return;
  if (output.width >= least.width && output.height >= least.height && output.width <= most.width &&
      output.height <= most.height)
    return;
  if (plan.is_dual()) {
    check.complain(fmt::format("output is {}x{}; it must lie within the plan's {}x{} and {}x{}", output.width,
                               output.height, least.width, least.height, most.width, most.height));
  } else {
    check.complain(fmt::format("output is {}x{}; the plan has always {}x{}; set settings.least_output",
                               output.width, output.height, most.width, most.height));
  }
}

}  // namespace

void check_inputs(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  constexpr float kLargest = 1e6f;
  check.viewport("render", inputs.render, plan.settings.target);
  if (plan.settings.particle_target != Extent())
    check.viewport("particle_render", inputs.particle_render, plan.settings.particle_target);
  check_output_extent(check, plan, inputs.output);
  for (const auto& input : kInputs) {
    const PlannedBuffer* buffer = find(plan, input.name);
    if (buffer == nullptr || buffer->owned) continue;
    check.input(input.field, inputs.*input.image, buffer->format, inputs.*input.viewport);
  }
  if (plan.velocity == VelocitySource::kTarget) {
    check.finite("velocity_scale.x", inputs.velocity_scale.x, -kLargest, kLargest);
    check.finite("velocity_scale.y", inputs.velocity_scale.y, -kLargest, kLargest);
  }
  if (plan.reads_camera() || PlanFacts(plan.needs, plan.settings).reprojects())
    check_camera(check, inputs.camera);
  if (plan.settings.shading == Shading::kCheckerboard) check_parity(check, inputs);
  check.finite("jitter.x", inputs.jitter.x, -1, 1);
  check.finite("jitter.y", inputs.jitter.y, -1, 1);
  check.finite("exposure", inputs.exposure, 0, kLargest);
  check_fade(check, plan, inputs);
}

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs& outputs) {
  FrameCheck check(plan);
  check_inputs(check, plan, inputs);
  check_outputs(check, plan, outputs);
  return check.status();
}

}  // namespace quincunx
