// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

class FrameCheck {
 public:
  explicit FrameCheck(const ResolvePlan& plan) : plan_(plan) {}

  void input(const char* field, const ImageView& image, PixelFormat format, Extent viewport) {
    image_in(field, image, format, plan_.settings.storage);
    if (image && plan_.settings.targets == Targets::kPlaced && image.extent != viewport) {
      complain(fmt::format("{}.extent is {}x{}; placed targets have exactly the viewport's {}x{}", field,
                           image.extent.width, image.extent.height, viewport.width, viewport.height));
    } else if (image && (image.extent.width < viewport.width || image.extent.height < viewport.height)) {
      complain(fmt::format("{}.extent is {}x{}; it must hold the viewport of {}x{}", field,
                           image.extent.width, image.extent.height, viewport.width, viewport.height));
    }
  }

  void viewport(const char* field, Extent viewport, Extent target) {
    if (viewport.width >= 1 && viewport.height >= 1 && viewport.width <= target.width &&
        viewport.height <= target.height) {
      return;
    }
    complain(fmt::format("{} is {}x{}; it must lie within 1x1 and the target's {}x{}", field, viewport.width,
                         viewport.height, target.width, target.height));
  }

  void output(const char* field, const ImageView& image, PixelFormat format, Storage storage) {
    image_in(field, image, format, storage);
    if (image && image.extent != plan_.settings.output) {
      complain(fmt::format("{}.extent is {}x{}; it must be the output's {}x{}", field, image.extent.width,
                           image.extent.height, plan_.settings.output.width, plan_.settings.output.height));
    }
  }

  void finite(const char* field, float value, float low, float high) {
    if (value >= low && value <= high) return;
    complain(fmt::format("{} is {}; it must lie in [{}, {}]", field, value, low, high));
  }

  void complain(const std::string& text) { complaints_ += (complaints_.empty() ? "" : "; ") + text; }
  Status status() const { return complaints_.empty() ? Status() : Status::invalid(complaints_); }

 private:
  void image_in(const char* field, const ImageView& image, PixelFormat format, Storage storage) {
    if (!image) {
      complain(fmt::format("{} is missing; the plan needs it as {}", field, name_of(format)));
      return;
    }
    if (image.format != format) {
      complain(
          fmt::format("{}.format is {}; the plan has {}", field, name_of(image.format), name_of(format)));
    }
    if (image.storage != storage) {
      complain(fmt::format("{}.storage is {}; the plan has {}", field, name(image.storage), name(storage)));
    }
    if (image.storage == Storage::kBuffer) layout(field, image);
  }

  void layout(const char* field, const ImageView& image) {
    const std::size_t texel = bytes_per_pixel(image.format);
    const std::size_t row = static_cast<std::size_t>(image.extent.width) * texel;
    if (texel != 0 && image.pitch != 0 && (image.pitch < row || image.pitch % texel != 0)) {
      complain(fmt::format("{}.pitch is {}; it must be a multiple of {} and at least {}", field, image.pitch,
                           texel, row));
    }
    if (image.offset % 16 != 0) {
      complain(fmt::format("{}.offset is {}; it must be a multiple of 16", field, image.offset));
    }
    if (image.pitch > kLargestPitch) {
      complain(fmt::format("{}.pitch is {}; it must be at most {}", field, image.pitch, kLargestPitch));
    }
  }

  static constexpr std::size_t kLargestPitch = std::size_t{1} << 30;
  static const char* name(Storage storage) { return storage == Storage::kImage ? "image" : "buffer"; }

  const ResolvePlan& plan_;
  std::string complaints_;
};

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
                 buffer->owned ? Storage::kBuffer : plan.presented_storage());
  }
  if (outputs.blurred && find(plan, "blurred") != nullptr &&
      outputs.blurred.memory == outputs.resolved.memory &&
      outputs.blurred.offset == outputs.resolved.offset) {
    check.complain("blurred is the memory of resolved; give it other memory");
  }
}

}  // namespace

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs& outputs) {
  FrameCheck check(plan);
  check_inputs(check, plan, inputs);
  check_outputs(check, plan, outputs);
  return check.status();
}

}  // namespace quincunx
