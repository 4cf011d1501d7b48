// SPDX-License-Identifier: MIT
// A plan in words: names and explain().
#include <fmt/format.h>

#include <iterator>

#include "quincunx/resolve_plan.h"

namespace quincunx {
namespace {

// Who makes the picture's light out of the scene's.
std::string colour_text(const ResolveSettings& settings) {
  const char* curve = name_of(settings.tone_map);
  if (settings.colour == PixelFormat::kRGBA8)
    return fmt::format("RGBA8, sRGB encoded; the renderer exposes and tone maps ({})", curve);
  if (!settings.present) return fmt::format("{}, linear light", name_of(settings.colour));
  return fmt::format("{}, linear light; the present pass exposes and tone maps ({})",
                     name_of(settings.colour), curve);
}

std::string size_text(std::uint64_t bytes) {
  return fmt::format("{:.2f} MiB", static_cast<double>(bytes) / (1 << 20));
}

std::string targets_text(const ResolvePlan& plan) {
  const Extent largest = plan.settings.target;
  if (plan.settings.targets == Targets::kViewport) {
    return fmt::format("viewport: each frame is the top left part of images of {}x{}; {} a frame",
                       largest.width, largest.height, size_text(plan.frame_bytes()));
  }
  return fmt::format(
      "placed: images have exactly the viewport's size, made again in unused memory where it changes; up to "
      "{}x{}, {} a frame",
      largest.width, largest.height, size_text(plan.frame_bytes()));
}

std::string output_text(const ResolvePlan& plan) {
  const Extent least = plan.settings.least_output;
  const Extent most = plan.settings.output;
  if (!plan.is_dual()) return fmt::format("always {}x{}", most.width, most.height);
  const char* history = plan.accumulates() ? "; history is resized where it changes" : "";
  return fmt::format("dynamic: {}x{} to {}x{}, shown in {}x{}{}", least.width, least.height, most.width,
                     most.height, most.width, most.height, history);
}

std::string focus_text(const FocusSettings& focus) {
  return fmt::format("{}x{} pixels of the picture, drawn again and resolved on their own{}",
                     focus.extent.width, focus.extent.height, focus.mask ? "; a mask is given" : "");
}

}  // namespace

const char* name_of(Targets targets) {
  switch (targets) {
    case Targets::kViewport:
      return "viewport";
    case Targets::kPlaced:
      return "placed";
  }
  return "unknown";
}

const char* name_of(VelocitySource source) {
  switch (source) {
    case VelocitySource::kNone:
      return "none";
    case VelocitySource::kTarget:
      return "target";
    case VelocitySource::kCamera:
      return "depth and camera";
  }
  return "unknown";
}

const char* name_of(Scaling scaling) {
  switch (scaling) {
    case Scaling::kScales:
      return "scales";
    case Scaling::kHistory:
      return "last frame's";
    case Scaling::kOwn:
      return "its own";
    case Scaling::kFixed:
      return "fixed";
  }
  return "unknown";
}

std::string ResolvePlan::explain() const {
  std::string text;
  const auto out = std::back_inserter(text);
  const auto yes = [](bool value) { return value ? "yes" : "no"; };
  fmt::format_to(
      out, "Scene needs    moving objects {}, camera motion {}, transparents {}, covering background {}\n",
      yes(needs.moving_objects), yes(needs.camera_motion), yes(needs.transparents), yes(needs.background));
  std::string form;
  if (settings.method == Method::kQuincunx) form = fmt::format(":{}", name_of(settings.quincunx.form));
  if (accumulates()) form = fmt::format(":{}", name_of(settings.temporal.preset));
  fmt::format_to(
      out, "Settings       {}{}, output {}x{}, target {}x{}, {} storage, sharpness {}, dither {}\n",
      name_of(settings.method), form, settings.output.width, settings.output.height, settings.target.width,
      settings.target.height, settings.storage == Storage::kImage ? "image" : "buffer", settings.sharpness,
      yes(settings.dither));
  fmt::format_to(out, "Colour         {}\n", colour_text(settings));
  fmt::format_to(out, "Output         {}\n", output_text(*this));
  fmt::format_to(out, "Targets        {}\n", targets_text(*this));
  const std::optional<ResolvePlan> region = focus_plan();
  if (region) fmt::format_to(out, "Focus          {}\n", focus_text(settings.focus));
  fmt::format_to(out, "Velocity       {}\n\nPasses, with bytes a frame at the largest viewport\n",
                 name_of(velocity));
  for (const PlannedPass& pass : passes) {
    fmt::format_to(out, "  {:<19} {:>11}  {}\n  {:<19} {:>11}  {}\n", pass.kernel, size_text(pass.bytes),
                   pass.reason, "", "", pass.options);
  }
  text += "\nBuffers\n";
  for (const PlannedBuffer& buffer : buffers) {
    fmt::format_to(out, "  {:<40} {:>5}x{:<5} {:<8} {:<12} {:>11}  {}\n", buffer.name, buffer.extent.width,
                   buffer.extent.height, name_of(buffer.format), name_of(buffer.scaling),
                   size_text(buffer.bytes), buffer.owned ? "the service's" : "the caller's");
  }
  text += "\nLeft out\n";
  for (const LeftOut& left : left_out)
    fmt::format_to(out, "  {:<40} {}\n", left.what, left.why);
  if (region) fmt::format_to(out, "\nThe focus's region\n{}", region->explain());
  return text;
}

}  // namespace quincunx
