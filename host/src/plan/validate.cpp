// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "plan/inputs.h"
#include "plan/plan_facts.h"
#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

// Kernels count the channels of an image's texels from the start of its buffer, in `int`.
constexpr std::size_t kMostChannels = std::size_t{1} << 31;

const char* name(Storage storage) {
  return storage == Storage::kImage ? "image" : "buffer";
}

// Complaints about the fields of a frame, collected so that one message names every bad one.
class FrameCheck {
 public:
  FrameCheck(const ResolvePlan& plan, Memory memory) : plan_(plan), memory_(memory) {}

  void input(const char* field, const ImageView& image, PixelFormat format, Extent viewport);
  void viewport(const char* field, Extent viewport, Extent target);
  // Checks an image of just this extent.
  void output(const char* field, const ImageView& image, PixelFormat format, Storage storage, Extent extent,
              const char* whose);
  void finite(const char* field, float value, float low, float high);
  // Checks where a buffer's rows lie, that kernels can count to their end, and that the memory is what is said of it.
  void layout(const char* field, const ImageView& image);

  void complain(const std::string& text) { complaints_ += (complaints_.empty() ? "" : "; ") + text; }
  Status status() const { return complaints_.empty() ? Status() : Status::invalid(complaints_); }

 private:
  void image_in(const char* field, const ImageView& image, PixelFormat format, Storage storage);

  // Checks that the buffer goes on to the image's end.
  void room(const char* field, const ImageView& image, std::size_t end);
  // Checks that the memory is an image as large, of such texels.
  void image2d(const char* field, const ImageView& image);

  const ResolvePlan& plan_;
  Memory memory_;
  std::string complaints_;
};

void FrameCheck::input(const char* field, const ImageView& image, PixelFormat format, Extent viewport) {
  image_in(field, image, format, plan_.settings.targets.storage);
  if (image && plan_.settings.targets.placement == Targets::kPlaced && image.extent != viewport) {
    complain(fmt::format("{}.extent is {}x{}; placed targets have exactly the viewport's {}x{}", field,
                         image.extent.width, image.extent.height, viewport.width, viewport.height));
  } else if (image && (image.extent.width < viewport.width || image.extent.height < viewport.height)) {
    complain(fmt::format("{}.extent is {}x{}; it must hold the viewport of {}x{}", field, image.extent.width,
                         image.extent.height, viewport.width, viewport.height));
  }
}

void FrameCheck::viewport(const char* field, Extent viewport, Extent target) {
  if (viewport.width >= 1 && viewport.height >= 1 && viewport.width <= target.width &&
      viewport.height <= target.height) {
    return;
  }
  complain(fmt::format("{} is {}x{}; it must lie within 1x1 and the target's {}x{}", field, viewport.width,
                       viewport.height, target.width, target.height));
}

void FrameCheck::output(const char* field, const ImageView& image, PixelFormat format, Storage storage,
                        Extent extent, const char* whose) {
  image_in(field, image, format, storage);
  if (image && image.extent != extent) {
    complain(fmt::format("{}.extent is {}x{}; it must be the {}'s {}x{}", field, image.extent.width,
                         image.extent.height, whose, extent.width, extent.height));
  }
}

void FrameCheck::finite(const char* field, float value, float low, float high) {
  if (value >= low && value <= high) return;
  complain(fmt::format("{} is {}; it must lie in [{}, {}]", field, value, low, high));
}

void FrameCheck::image_in(const char* field, const ImageView& image, PixelFormat format, Storage storage) {
  if (!image) {
    const std::string_view name = field;
    complain(fmt::format("{} is missing; the plan needs it as {}{}", field, name_of(format),
                         name == "velocity"           ? ", or plan with moving_objects = false"
                         : name.ends_with("reactive") ? ", or plan with transparents = false"
                                                      : ""));
    return;
  }
  if (image.format != format) {
    complain(fmt::format("{}.format is {}; the plan has {}", field, name_of(image.format), name_of(format)));
  }
  if (image.storage != storage) {
    complain(fmt::format("{}.storage is {}; the plan has {}", field, name(image.storage), name(storage)));
  }
  layout(field, image);
}

void FrameCheck::layout(const char* field, const ImageView& image) {
  if (image.storage != Storage::kBuffer) {
    if (memory_ == Memory::kAsked) image2d(field, image);
    return;
  }
  const std::size_t texel = bytes_per_pixel(image.format);
  const std::size_t row = static_cast<std::size_t>(image.extent.width) * texel;
  if (texel != 0 && image.pitch != 0 && (image.pitch < row || image.pitch % texel != 0)) {
    complain(fmt::format("{}.pitch is {}; it must be a multiple of {} and at least {}", field, image.pitch,
                         texel, row));
  }
  if (image.offset % 16 != 0) {
    complain(fmt::format("{}.offset is {}; it must be a multiple of 16", field, image.offset));
  }
  if (texel == 0 || image.extent.width < 1 || image.extent.height < 1) return;
  // In this order no step overflows.
  const std::size_t most = kMostChannels / static_cast<std::size_t>(channels_of(image.format)) * texel;
  const std::size_t rows = static_cast<std::size_t>(image.extent.height) - 1;
  if (image.offset > most || row > most - image.offset ||
      (rows != 0 && image.row_pitch() > (most - image.offset - row) / rows)) {
    complain(
        fmt::format("{0}.offset is {1}, {0}.pitch {2} and {0}.extent {3}x{4}; the image must end within "
                    "the first {5} bytes of its buffer, as kernels count texels in 32 bits",
                    field, image.offset, image.row_pitch(), image.extent.width, image.extent.height, most));
  } else if (memory_ == Memory::kAsked) {
    room(field, image, image.offset + rows * image.row_pitch() + row);
  }
}

void FrameCheck::room(const char* field, const ImageView& image, std::size_t end) {
  cl_mem_object_type kind = 0;
  std::size_t bytes = 0;
  if (clGetMemObjectInfo(image.memory, CL_MEM_TYPE, sizeof(kind), &kind, nullptr) != CL_SUCCESS ||
      clGetMemObjectInfo(image.memory, CL_MEM_SIZE, sizeof(bytes), &bytes, nullptr) != CL_SUCCESS ||
      kind != CL_MEM_OBJECT_BUFFER) {
    complain(fmt::format("{0}.memory is no OpenCL buffer, and {0}.storage says that it is one", field));
  } else if (bytes < end) {
    complain(fmt::format(
        "{0}.memory has {1} bytes; {0}.offset {2}, {0}.pitch {3} and {0}.extent {4}x{5} "
        "need {6}",
        field, bytes, image.offset, image.row_pitch(), image.extent.width, image.extent.height, end));
  }
}

void FrameCheck::image2d(const char* field, const ImageView& image) {
  cl_mem_object_type kind = 0;
  std::size_t width = 0, height = 0, texel = 0;
  const auto ask = [&](cl_image_info what, std::size_t& answer) {
    return clGetImageInfo(image.memory, what, sizeof(answer), &answer, nullptr) == CL_SUCCESS;
  };
  if (clGetMemObjectInfo(image.memory, CL_MEM_TYPE, sizeof(kind), &kind, nullptr) != CL_SUCCESS ||
      kind != CL_MEM_OBJECT_IMAGE2D || !ask(CL_IMAGE_WIDTH, width) || !ask(CL_IMAGE_HEIGHT, height) ||
      !ask(CL_IMAGE_ELEMENT_SIZE, texel)) {
    return complain(
        fmt::format("{0}.memory is no OpenCL image2d, and {0}.storage says that it is one", field));
  }
  const std::size_t bytes = bytes_per_pixel(image.format);
  const bool is_wider = channels_of(image.format) == 2 && texel == 2 * bytes;  // of four channels
  if (image.extent.width <= static_cast<std::int64_t>(width) &&
      image.extent.height <= static_cast<std::int64_t>(height) && (texel == bytes || is_wider))
    return;
  complain(fmt::format(
      "{0}.memory has {1}x{2} texels of {3} bytes; {0}.extent {4}x{5} and {0}.format {6} need {4}x{5} of {7}",
      field, width, height, texel, image.extent.width, image.extent.height, name_of(image.format), bytes));
}

void check_camera(FrameCheck& check, const CameraMotion& camera) {
  for (const float element : camera.clip_to_previous_clip) {
    if (!std::isfinite(element)) {
      check.complain("camera.clip_to_previous_clip holds a value that is not finite; all 16 must be numbers");
      return;
    }
  }
}

// At least one pixel must be shaded.
void check_parity(FrameCheck& check, const FrameInputs& inputs) {
  const bool has_both = inputs.render_extent.width > 1 || inputs.render_extent.height > 1;
  if (inputs.parity == 0 || (inputs.parity == 1 && has_both)) return;
  check.complain(fmt::format("parity is {}; it must be {}", inputs.parity,
                             has_both ? "0 or 1" : "0 where the viewport is a single pixel"));
}

void check_outputs(FrameCheck& check, const ResolvePlan& plan, const FrameOutputs& outputs) {
  const ResolveSettings& settings = plan.settings;
  if (!outputs.linear && !outputs.presented)
    check.complain("outputs are both missing; give linear, presented or both");
  if (outputs.linear)
    check.output("linear", outputs.linear, settings.output.linear, Storage::kBuffer, settings.output_extent,
                 "output");
  if (!outputs.presented) return;
  if (settings.output.present) {
    check.output("presented", outputs.presented, PixelFormat::kRGBA8, plan.presented_storage(),
                 settings.output_extent, "output");
  } else {
    check.complain("presented is given, but the plan has no present pass; set settings.output.present");
  }
}

void check_fade(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  if (!inputs.fading_from) return;
  if (!plan.settings.control.fades) {
    check.complain("fading_from is given, but the plan has no cross-fade; set settings.control.fades");
    return;
  }
  check.output("fading_from", inputs.fading_from, plan.settings.output.linear, Storage::kBuffer,
               plan.settings.output_extent, "output");
  check.finite("fade_weight", inputs.fade_weight, 0, 1);
}

void check_output_extent(FrameCheck& check, const ResolvePlan& plan, Extent output) {
  const Extent most = plan.settings.output_extent;
  const Extent least = plan.is_dual() ? plan.settings.output.min_extent : most;
  if (output == Extent{}) return;
  if (output.width >= least.width && output.height >= least.height && output.width <= most.width &&
      output.height <= most.height)
    return;
  if (plan.is_dual()) {
    check.complain(fmt::format("output_extent is {}x{}; it must lie within the plan's {}x{} and {}x{}",
                               output.width, output.height, least.width, least.height, most.width,
                               most.height));
  } else {
    check.complain(
        fmt::format("output_extent is {}x{}; the plan has always {}x{}; set settings.output.min_extent",
                    output.width, output.height, most.width, most.height));
  }
}

void check_planes(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  const DepthConvention depth = plan.settings.conventions.depth;
  if (!needs_near_plane(depth) || (!plan.reads_depth && plan.settings.targets.particle_extent == Extent()))
    return;
  constexpr float kLargest = std::numeric_limits<float>::max();
  if (!(inputs.near_plane > 0 && inputs.near_plane <= kLargest)) {
    check.complain(fmt::format("near_plane is {}; where depth is {} it must be above 0 and finite",
                               inputs.near_plane, name_of(depth)));
  } else if (needs_far_plane(depth) &&
             !(inputs.far_plane > inputs.near_plane && inputs.far_plane <= kLargest)) {
    check.complain(fmt::format("far_plane is {}; it must be beyond the near plane at {} and finite",
                               inputs.far_plane, inputs.near_plane));
  }
}

void check_inputs(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs) {
  constexpr float kLargest = 1e6f;
  check.viewport("render_extent", inputs.render_extent, plan.settings.target_extent);
  if (plan.settings.targets.particle_extent != Extent())
    check.viewport("particle_render_extent", inputs.particle_render_extent,
                   plan.settings.targets.particle_extent);
  check_output_extent(check, plan, inputs.output_extent);
  for (const PlannedBuffer& buffer : plan.buffers) {
    if (!is_input(buffer)) continue;
    const InputImage& input = input_of(buffer);
    check.input(input.name, inputs.*input.image, buffer.format, inputs.*input.viewport);
  }
  if (plan.velocity == VelocitySource::kTarget) {
    check.finite("velocity_scale.x", inputs.velocity_scale.x, -kLargest, kLargest);
    check.finite("velocity_scale.y", inputs.velocity_scale.y, -kLargest, kLargest);
  }
  if (plan.reads_camera() || PlanFacts(plan.needs, plan.settings).reprojects())
    check_camera(check, inputs.camera);
  check_planes(check, plan, inputs);
  if (plan.settings.targets.shading == Shading::kCheckerboard) check_parity(check, inputs);
  check.finite("jitter.x", inputs.jitter.x, -1, 1);
  check.finite("jitter.y", inputs.jitter.y, -1, 1);
  check.finite("exposure", inputs.exposure, 0, FrameInputs::kLargestExposure);
  if (inputs.exposure_image) {
    check.output("exposure_image", inputs.exposure_image, PixelFormat::kR32F, inputs.exposure_image.storage,
                 {1, 1}, "exposure");
  }
  check_fade(check, plan, inputs);
}

bool lies_within(const Rectangle& inner, const Rectangle& outer) {
  return inner.width >= 1 && inner.height >= 1 && inner.x >= outer.x && inner.y >= outer.y &&
         inner.width <= outer.width && inner.height <= outer.height &&
         inner.x - outer.x <= outer.width - inner.width && inner.y - outer.y <= outer.height - inner.height;
}

void check_rectangles(FrameCheck& check, const FocusInputs& focus, const Rectangle& region) {
  if (focus.rectangle_count < 0 || focus.rectangle_count > FocusInputs::kMaxRectangles) {
    check.complain(fmt::format("focus.rectangle_count is {}; it must lie in [0, {}]", focus.rectangle_count,
                               FocusInputs::kMaxRectangles));
    return;
  }
  for (int i = 0; i < focus.rectangle_count; ++i) {
    const Rectangle& where = focus.rectangles[static_cast<std::size_t>(i)];
    if (lies_within(where, region)) continue;
    check.complain(fmt::format(
        "focus.rectangles[{}] is {}x{} at {}, {}; it must lie within the region of {}x{} at {}, {}", i,
        where.width, where.height, where.x, where.y, region.width, region.height, region.x, region.y));
  }
}

void check_place(FrameCheck& check, const ResolvePlan& plan, const FocusInputs& focus) {
  constexpr float kLongestFeather = 32768;
  const Extent output = plan.settings.output_extent;
  const Rectangle region = {focus.x, focus.y, plan.settings.focus.extent.width,
                            plan.settings.focus.extent.height};
  if (!lies_within(region, {0, 0, output.width, output.height})) {
    check.complain(fmt::format("the focus's region of {}x{} at {}, {} leaves the output's {}x{}",
                               region.width, region.height, region.x, region.y, output.width, output.height));
  }
  check_rectangles(check, focus, region);
  check.finite("focus.feather", focus.feather, 0, kLongestFeather);
}

}  // namespace

Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus,
                      Memory memory) {
  if (region == nullptr)
    return Status::invalid("focus is given, but the plan has none; set settings.focus.extent");
  FrameCheck check(plan, memory);
  check_place(check, plan, focus);
  if (plan.settings.focus.mask)
    check.output("focus.mask", focus.mask, PixelFormat::kR8, Storage::kBuffer, plan.settings.focus.extent,
                 "region");
  FrameCheck frame(*region, memory);
  check_inputs(frame, *region, focus.frame);
  if (const Status status = frame.status(); !status.ok())
    check.complain("of focus.frame: " + std::string(status.message()));
  return check.status();
}

Status validate_layout(const ResolvePlan& plan, const char* field, const ImageView& image) {
  FrameCheck check(plan, Memory::kAsked);
  check.layout(field, image);
  return check.status();
}

Status validate_frame(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs* outputs,
                      Memory memory) {
  FrameCheck check(plan, memory);
  check_inputs(check, plan, inputs);
  if (outputs != nullptr) check_outputs(check, plan, *outputs);
  return check.status();
}

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs& outputs) {
  return validate_frame(plan, inputs, &outputs, Memory::kUnseen);
}

Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FocusInputs& focus,
                const FrameOutputs& outputs) {
  if (Status status = validate(plan, inputs, outputs); !status.ok()) return status;
  const std::optional<ResolvePlan> region = plan.focus_plan();
  return validate_focus(plan, region ? &*region : nullptr, focus, Memory::kUnseen);
}

}  // namespace quincunx
