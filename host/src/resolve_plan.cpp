// SPDX-License-Identifier: MIT
#include "quincunx/resolve_plan.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <string_view>

#include "frame_traffic.h"
#include "kernel_options.h"
#include "pass_motion_blur.h"
#include "pass_reproject.h"
#include "pass_resolve.h"
#include "pass_scale.h"
#include "pass_sharpen.h"
#include "pass_temporal.h"

namespace quincunx {
namespace {

constexpr int kLargestSide = 32768;

bool usable(Extent extent) {
  return extent.width >= 1 && extent.height >= 1 && extent.width <= kLargestSide &&
         extent.height <= kLargestSide;
}

// Collects complaints so that one message names every bad field.
class Complaints {
 public:
  void add(std::string text) { text_ += (text_.empty() ? "" : "; ") + std::move(text); }
  Status status() const { return text_.empty() ? Status() : Status::invalid(text_); }

 private:
  std::string text_;
};

void check_extent(Complaints& complaints, const char* field, Extent extent) {
  if (usable(extent)) return;
  complaints.add(fmt::format("settings.{} is {}x{}; both sides must lie in [1, {}]", field, extent.width,
                             extent.height, kLargestSide));
}

void check_format(Complaints& complaints, const char* field, PixelFormat format, PixelFormat half,
                  PixelFormat full) {
  if (format == half || format == full) return;
  complaints.add(fmt::format("settings.{} is {}; it must be {} or {}", field, name_of(format), name_of(half),
                             name_of(full)));
}

Status check(const ResolveSettings& settings) {
  Complaints complaints;
  check_extent(complaints, "output", settings.output);
  check_extent(complaints, "target", settings.target);
  check_format(complaints, "colour", settings.colour, PixelFormat::kRGBA16F, PixelFormat::kRGBA32F);
  check_format(complaints, "velocity", settings.velocity, PixelFormat::kRG16F, PixelFormat::kRG32F);
  check_format(complaints, "resolved", settings.resolved, PixelFormat::kRGBA16F, PixelFormat::kRGBA32F);
  check_format(complaints, "temporal.history", settings.temporal.history, PixelFormat::kRGBA16F,
               PixelFormat::kRGBA32F);
  const auto check_weight = [&](const char* field, float weight) {
    if (weight >= 0 && std::isfinite(weight)) return;
    complaints.add(
        fmt::format("settings.quincunx.{} is {}; it must be finite and at least 0", field, weight));
  };
  check_weight("velocity_weight", settings.quincunx.velocity_weight);
  check_weight("residual_weight", settings.quincunx.residual_weight);
  if (!(settings.grain >= 0 && settings.grain <= 1)) {
    complaints.add(fmt::format("settings.grain is {}; it must lie in [0, 1]", settings.grain));
  }
  if (!(settings.blur.shutter >= 0 && settings.blur.shutter <= 2)) {
    complaints.add(fmt::format("settings.blur.shutter is {}; it must lie in [0, 2]", settings.blur.shutter));
  }
  if (!(settings.sharpness >= 0 && settings.sharpness <= 1)) {
    complaints.add(fmt::format("settings.sharpness is {}; it must lie in [0, 1]", settings.sharpness));
  }
  const int samples = settings.blur.samples;
  if (samples < 4 || samples > 64 || !std::has_single_bit(static_cast<unsigned>(samples))) {
    complaints.add(fmt::format("settings.blur.samples is {}; it must be 4, 8, 16, 32 or 64", samples));
  }
  return complaints.status();
}

bool has_form(const ResolveSettings& settings, TwoFrameForm form) {
  return settings.method == Method::kQuincunx && settings.quincunx.form == form;
}

bool method_reads_velocity(const ResolveSettings& settings) {
  if (settings.method == Method::kTemporal) return true;
  return settings.method == Method::kQuincunx && settings.quincunx.form != TwoFrameForm::kMean;
}

VelocitySource velocity_source(const SceneNeeds& needs, const ResolveSettings& settings) {
  if (!method_reads_velocity(settings) && settings.blur.shutter == 0) return VelocitySource::kNone;
  if (needs.moving_objects) return VelocitySource::kTarget;
  return needs.camera_motion ? VelocitySource::kCamera : VelocitySource::kNone;
}

const char* reason_of(Method method) {
  switch (method) {
    case Method::kPoint:
      return "the method: the nearest sample";
    case Method::kBilinear:
      return "the method: four samples";
    case Method::kBSpline:
    case Method::kCatmullRom:
    case Method::kLanczos2:
      return "the method: 16 samples";
    case Method::kNoise:
      return "the method: the nearest sample, with grain";
    case Method::kNoiseOffset:
      return "the method: one of four samples, at random";
    case Method::kQuincunx:
      return "in place of both frames on the first one and after a reset";
    case Method::kTemporal:
      return "in place of the history where samples are denser than pixels";
  }
  return "";
}

// What makes the picture of one frame alone.
void plan_scale(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  const Filter filter = filter_of(settings.method);
  const std::uint64_t bytes = scale_bytes(settings, settings.target);
  const char* small = scale_kernel(settings.method, settings.output, settings.output);
  const char* large = scale_kernel(settings.method, settings.target, settings.output);
  const std::string options =
      filter == Filter::kTent ? scale_options(settings) : filter_options(filter, settings, 4);
  plan.passes.push_back({small, options, reason_of(settings.method), bytes});
  if (widens(settings.target, settings.output) && large == std::string_view(FilterPass::kernel_name())) {
    plan.passes.push_back({large, filter_options(filter, settings, 0),
                           "in its place where a viewport is larger than the output: the filter widens",
                           bytes});
  }
}

void plan_reprojected(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  const auto& kernels = ReprojectPass::kKernels;
  if (plan.velocity != VelocitySource::kNone) {
    plan.passes.push_back({kernels[0], reproject_options(plan),
                           "the method: where each sample was, and whether it could be seen",
                           reproject_bytes(plan, settings.target, settings.target)});
  }
  plan.passes.push_back({kernels[1], reprojected_options(plan),
                         "the method: this frame and the previous one where it moved to",
                         reprojected_bytes(plan, settings.target, settings.target)});
}

void plan_temporal(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  const auto& kernels = TemporalPass::kKernels;
  const Extent largest = settings.target;
  if (plan.follows()) {
    plan.passes.push_back({kernels[0], reproject_options(plan),
                           "the method: where each sample was, and whether it could be seen",
                           reproject_bytes(plan, largest, largest)});
  }
  plan.passes.push_back({kernels[1], temporal_tiles_options(plan), "the method: which tiles move as a whole",
                         temporal_tiles_bytes(plan, largest)});
  plan.passes.push_back(
      {kernels[2], "", "the method: where the light has changed", temporal_light_bytes(plan)});
  plan.passes.push_back({kernels[3], temporal_options(plan), "the method: this frame added to the history",
                         temporal_bytes(plan, largest, largest)});
  if (settings.temporal.view == TemporalView::kPicture) {
    plan.passes.push_back({kernels[4], temporal_display_options(plan), "the method: the history's picture",
                           temporal_display_bytes(plan, largest)});
  }
}

void plan_blur(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  const auto& kernels = MotionBlurPass::kKernels;
  plan.passes.push_back({kernels[0], velocity_options(settings),
                         "motion blur: how far the surfaces of a tile move",
                         motion_tiles_bytes(settings, settings.target)});
  plan.passes.push_back(
      {kernels[1], "", "motion blur: what reaches a tile", motion_neighbours_bytes(settings)});
  plan.passes.push_back({kernels[2], blur_options(settings), "motion blur: the mean over the shutter's time",
                         motion_blur_bytes(settings, settings.target)});
}

void plan_passes(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  if (plan.velocity == VelocitySource::kCamera) {
    plan.passes.push_back({"velocity_from_depth", velocity_options(settings), "nothing but the camera moves",
                           velocity_bytes(settings, settings.target)});
  }
  if (plan.accumulates()) {
    plan_temporal(plan);
  } else if (plan.reprojects()) {
    plan_reprojected(plan);
  } else if (settings.method == Method::kQuincunx) {
    plan.passes.push_back({ResolvePass::kernel_name(), quincunx_options(plan),
                           "the method: this frame and the previous one",
                           quincunx_bytes(plan, settings.target, settings.target)});
  }
  if (!plan.accumulates() || plan.is_dense(settings.target)) plan_scale(plan);
  if (plan.sharpens()) {
    plan.passes.push_back({SharpenPass::kernel_name(), sharpen_options(settings),
                           "sharpness is wanted: contrast between neighbours, within their range",
                           sharpen_bytes(settings)});
  }
  if (plan.blurs()) plan_blur(plan);
  if (settings.present) {
    plan.passes.push_back(
        {"present", present_options(settings), "an 8-bit sRGB picture is wanted", present_bytes(settings)});
  }
  for (const PixelFormat format : plan.clears()) {
    plan.passes.push_back({"clear_region", clear_options(settings.storage, format),
                           "nothing covers every pixel: clear() is called before drawing",
                           static_cast<std::uint64_t>(settings.target.area()) * bytes_per_pixel(format)});
  }
}

void add_buffer(ResolvePlan& plan, std::string name, PixelFormat format, Scaling scaling,
                bool owned = false) {
  const Extent extent = scaling == Scaling::kFixed ? plan.settings.output : plan.settings.target;
  const std::uint64_t bytes = static_cast<std::uint64_t>(extent.area()) * bytes_per_pixel(format);
  plan.buffers.push_back({std::move(name), extent, format, scaling, bytes, owned});
}

void plan_buffers(ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  for (const Scaling scaling : {Scaling::kScales, Scaling::kHistory}) {
    const bool history = scaling == Scaling::kHistory;
    if (history && !plan.keeps_previous_frame()) break;
    const char* which = history ? " of the previous frame" : "";
    if (!history || !plan.accumulates())
      add_buffer(plan, fmt::format("colour{}", which), settings.colour, scaling);
    const bool both = plan.weighs_velocity() || plan.weighs_residual();
    if (plan.velocity != VelocitySource::kNone && (!history || both)) {
      const bool owned = plan.velocity == VelocitySource::kCamera;
      add_buffer(plan, fmt::format("velocity{}", which), settings.velocity, scaling, owned);
    }
    if (plan.reads_depth && (!history || plan.follows()))
      add_buffer(plan, fmt::format("depth{}", which), PixelFormat::kR32F, scaling);
    if (plan.reads_reactive) add_buffer(plan, fmt::format("reactive{}", which), PixelFormat::kR8, scaling);
  }
  if (plan.follows()) add_buffer(plan, "reprojection", PixelFormat::kRGBA32F, Scaling::kScales, true);
  for (const char* name : {"history", "updated history"}) {
    if (plan.accumulates()) add_buffer(plan, name, settings.temporal.history, Scaling::kFixed, true);
  }
  if (plan.accumulates()) {
    const TileBytes tile = temporal_tile_bytes(settings.output);
    const auto add_tiles = [&](const char* name, std::uint64_t bytes) {
      plan.buffers.push_back(
          {name, temporal_tiles(settings.output), PixelFormat::kNone, Scaling::kFixed, bytes, true});
    };
    for (const char* name : {"tiles", "updated tiles"})
      add_tiles(name, tile.reprojection + tile.light);
    add_tiles("evidence of tiles", tile.evidence);
  }
  add_buffer(plan, "resolved", settings.resolved, Scaling::kFixed, true);
  if (plan.sharpens()) add_buffer(plan, "unsharpened", settings.resolved, Scaling::kFixed, true);
  if (plan.blurs()) add_buffer(plan, "blurred", settings.resolved, Scaling::kFixed, true);
  if (settings.present) add_buffer(plan, "presented", PixelFormat::kRGBA8, Scaling::kFixed);
}

void note_left_out(ResolvePlan& plan) {
  const auto note = [&](const char* what, const char* why) { plan.left_out.push_back({what, why}); };
  const SceneNeeds& needs = plan.needs;
  const bool several = plan.keeps_previous_frame();
  if (!several) {
    note("the previous frame", "the method uses one frame only");
    if (plan.velocity == VelocitySource::kNone) note("velocity", "the method uses one frame only");
    note("reactive values", "the method uses one frame only");
  }
  if (several && plan.velocity == VelocitySource::kCamera) {
    note("velocity target", "nothing but the camera moves: velocity comes from depth and the camera");
  }
  if (several && plan.velocity == VelocitySource::kNone) {
    note("velocity", has_form(plan.settings, TwoFrameForm::kMean) ? "the form is the plain mean"
                                                                  : "nothing moves: all frames count alike");
  }
  if (!plan.reads_depth) note("depth", "no pass reads it");
  if (several && !needs.transparents) note("reactive values", "the scene has no transparents");
  if (!plan.sharpens()) {
    note("sharpen", plan.settings.sharpness > 0 ? "the view is no picture" : "sharpness is 0");
  }
  if (!plan.blurs()) {
    note("motion blur", plan.settings.blur.shutter > 0 ? "nothing moves" : "the shutter opens for no time");
  }
  if (!plan.settings.present) note("present", "no 8-bit picture is wanted");
  if (needs.background) {
    note("clear_region", "the background covers every pixel of the viewport");
  } else if (!plan.settings.clear) {
    note("clear_region", "the renderer clears its own targets");
  }
}

}  // namespace

Result<ResolvePlan> plan_for(const SceneNeeds& needs, const ResolveSettings& settings) {
  if (Status status = check(settings); !status.ok()) return status;
  ResolvePlan plan;
  plan.needs = needs;
  plan.settings = settings;
  plan.velocity = velocity_source(needs, settings);
  plan.reads_depth = plan.velocity == VelocitySource::kCamera || plan.blurs() || plan.follows();
  plan.reads_reactive = plan.keeps_previous_frame() && needs.transparents;
  plan_passes(plan);
  plan_buffers(plan);
  note_left_out(plan);
  return plan;
}

bool ResolvePlan::weighs_velocity() const {
  return velocity != VelocitySource::kNone && has_form(settings, TwoFrameForm::kVelocity);
}

bool ResolvePlan::reprojects() const {
  return has_form(settings, TwoFrameForm::kReprojected);
}

bool ResolvePlan::follows() const {
  return velocity != VelocitySource::kNone && (reprojects() || accumulates());
}

bool ResolvePlan::is_dense(Extent render) const {
  constexpr double kDense = .64;  // output pixels a sample
  return accumulates() &&
         static_cast<double>(settings.output.area()) < kDense * static_cast<double>(render.area());
}

bool ResolvePlan::weighs_residual() const {
  return velocity != VelocitySource::kNone && reprojects() && settings.quincunx.residual_weight > 0;
}

bool ResolvePlan::sharpens() const {
  return settings.sharpness > 0 && (!accumulates() || settings.temporal.view == TemporalView::kPicture);
}

bool ResolvePlan::blurs() const {
  return settings.blur.shutter > 0 && velocity != VelocitySource::kNone;
}

std::vector<PixelFormat> ResolvePlan::clears() const {
  std::vector<PixelFormat> formats;
  if (!settings.clear || needs.background) return formats;
  const auto add = [&](PixelFormat wanted) {
    for (const PixelFormat format : formats) {
      // One variant fills images of any format, and buffers of one texel size.
      if (settings.storage == Storage::kImage || bytes_per_pixel(format) == bytes_per_pixel(wanted)) return;
    }
    formats.push_back(wanted);
  };
  add(settings.colour);
  if (velocity == VelocitySource::kTarget) add(settings.velocity);
  if (reads_reactive) add(PixelFormat::kR8);
  return formats;
}

}  // namespace quincunx
