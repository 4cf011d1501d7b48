// SPDX-License-Identifier: MIT
#include "c_interface/c_settings.h"

#include <fmt/format.h>

#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "c_interface/sized_struct.h"

namespace quincunx::c {

namespace {

static_assert(static_cast<int>(Method::kTemporal) == QUINCUNX_TEMPORAL);
static_assert(static_cast<int>(TemporalView::kFar) == QUINCUNX_VIEW_FAR);
static_assert(static_cast<int>(PixelFormat::kRGBA32F) == QUINCUNX_RGBA32F);
static_assert(static_cast<int>(ToneMap::kAces) == QUINCUNX_ACES);

void read_format(Reader& read, const char* field, std::int32_t number, PixelFormat& to) {
  read.value(field, number, PixelFormat::kRGBA32F, to, QUINCUNX_R8);
}

}  // namespace

quincunx_settings to_c(const SceneSettings& settings) {
  const ResolveSettings& resolve = settings.resolve;
  quincunx_settings to = {};
  to.moving_objects = settings.needs.moving_objects;
  to.camera_motion = settings.needs.camera_motion;
  to.transparents = settings.needs.transparents;
  to.background = settings.needs.background;
  to.method = static_cast<int>(resolve.method);
  to.output_width = resolve.output_extent.width;
  to.output_height = resolve.output_extent.height;
  to.target_width = resolve.target_extent.width;
  to.target_height = resolve.target_extent.height;
  to.colour_format = static_cast<int>(resolve.colour);
  to.velocity_format = static_cast<int>(resolve.velocity);
  to.linear_format = static_cast<int>(resolve.output.linear);
  to.storage = static_cast<int>(resolve.targets.storage);
  to.targets = static_cast<int>(resolve.targets.placement);
  to.shading = static_cast<int>(resolve.targets.shading);
  to.present = resolve.output.present;
  to.clear = resolve.targets.clear;
  to.tone_map = static_cast<int>(resolve.output.tone_map);
  to.dither = resolve.output.dither;
  to.clamp_ringing = resolve.filter.clamp_ringing;
  to.noise_moves = resolve.filter.noise_moves;
  to.drawn_velocity = static_cast<int>(resolve.conventions.drawn_velocity);
  const InputConventions& given = resolve.conventions;
  to.depth_convention = static_cast<int>(given.depth);
  to.clip_space = static_cast<int>(given.clip_space);
  to.velocity_unit = static_cast<int>(given.velocity_unit);
  to.velocity_backward = given.velocity_backward;
  to.velocity_up = given.velocity_up;
  to.velocity_jittered = given.velocity_jittered;
  to.origin = static_cast<int>(given.origin);
  to.sky_motion = static_cast<int>(resolve.conventions.sky_motion);
  to.two_frame_form = static_cast<int>(resolve.quincunx.form);
  to.sampling = static_cast<int>(resolve.quincunx.sampling);
  to.temporal_preset = static_cast<int>(resolve.temporal.preset);
  to.temporal_view = static_cast<int>(resolve.temporal.view);
  to.history_format = static_cast<int>(resolve.temporal.history);
  to.blur_samples = resolve.blur.samples;
  to.shutter = resolve.blur.shutter;
  to.sharpness = resolve.sharpness;
  to.grain = resolve.filter.grain;
  to.velocity_weight = resolve.quincunx.velocity_weight;
  to.residual_weight = resolve.quincunx.residual_weight;
  to.min_output_width = resolve.output.min_extent.width;
  to.min_output_height = resolve.output.min_extent.height;
  to.particle_target_width = resolve.targets.particle_extent.width;
  to.particle_target_height = resolve.targets.particle_extent.height;
  to.focus_width = resolve.focus.extent.width;
  to.focus_height = resolve.focus.extent.height;
  to.focus_target_width = resolve.focus.target_extent.width;
  to.focus_target_height = resolve.focus.target_extent.height;
  to.focus_mask = resolve.focus.mask;
  to.measures_content = resolve.control.measures_content;
  to.fades = resolve.control.fades;
  to.temporal_noise = resolve.temporal.noise;
  to.checks_motion = resolve.checks_motion;
  return to;
}

Result<SceneSettings> from_c(const quincunx_settings* settings) {
  SceneSettings to;
  quincunx_settings from = to_c(to);
  if (Status status = read_sized(settings, "settings", from); !status.ok()) return status;
  to.needs = {.moving_objects = from.moving_objects != 0,
              .camera_motion = from.camera_motion != 0,
              .transparents = from.transparents != 0,
              .background = from.background != 0};
  ResolveSettings& resolve = to.resolve;
  Reader read("settings");
  read.value("method", from.method, Method::kTemporal, resolve.method);
  resolve.output_extent = {from.output_width, from.output_height};
  resolve.target_extent = {from.target_width, from.target_height};
  read_format(read, "colour_format", from.colour_format, resolve.colour);
  read_format(read, "velocity_format", from.velocity_format, resolve.velocity);
  read_format(read, "linear_format", from.linear_format, resolve.output.linear);
  read.value("storage", from.storage, Storage::kImage, resolve.targets.storage);
  read.value("targets", from.targets, Targets::kPlaced, resolve.targets.placement);
  read.value("shading", from.shading, Shading::kCheckerboard, resolve.targets.shading);
  resolve.output.present = from.present != 0;
  resolve.targets.clear = from.clear != 0;
  read.value("tone_map", from.tone_map, ToneMap::kAces, resolve.output.tone_map);
  resolve.output.dither = from.dither != 0;
  resolve.filter.clamp_ringing = from.clamp_ringing != 0;
  resolve.filter.noise_moves = from.noise_moves != 0;
  read.value("drawn_velocity", from.drawn_velocity, DrawnVelocity::kDilated,
             resolve.conventions.drawn_velocity);
  InputConventions& given = resolve.conventions;
  read.value("depth_convention", from.depth_convention, DepthConvention::kLinear, given.depth);
  read.value("clip_space", from.clip_space, ClipSpace::kVulkan, given.clip_space);
  read.value("velocity_unit", from.velocity_unit, VelocityUnit::kNdc, given.velocity_unit);
  given.velocity_backward = from.velocity_backward != 0;
  given.velocity_up = from.velocity_up != 0;
  given.velocity_jittered = from.velocity_jittered != 0;
  read.value("origin", from.origin, Origin::kBottom, given.origin);
  read.value("sky_motion", from.sky_motion, SkyMotion::kEvidence, resolve.conventions.sky_motion);
  read.value("two_frame_form", from.two_frame_form, TwoFrameForm::kReprojected, resolve.quincunx.form);
  read.value("sampling", from.sampling, Sampling::kBilinear, resolve.quincunx.sampling);
  read.value("temporal_preset", from.temporal_preset, TemporalPreset::kQuality, resolve.temporal.preset);
  read.value("temporal_view", from.temporal_view, TemporalView::kFar, resolve.temporal.view);
  read_format(read, "history_format", from.history_format, resolve.temporal.history);
  resolve.blur = {.shutter = from.shutter, .samples = from.blur_samples};
  resolve.sharpness = from.sharpness;
  resolve.filter.grain = from.grain;
  resolve.quincunx.velocity_weight = from.velocity_weight;
  resolve.quincunx.residual_weight = from.residual_weight;
  resolve.output.min_extent = {from.min_output_width, from.min_output_height};
  resolve.targets.particle_extent = {from.particle_target_width, from.particle_target_height};
  resolve.focus = {.extent = {from.focus_width, from.focus_height},
                   .target_extent = {from.focus_target_width, from.focus_target_height},
                   .mask = from.focus_mask != 0};
  resolve.control.measures_content = from.measures_content != 0;
  resolve.control.fades = from.fades != 0;
  resolve.checks_motion = from.checks_motion != 0;
  resolve.temporal.noise = from.temporal_noise;
  if (!read.status().ok()) return read.status();
  return to;
}

quincunx_needs needs_of(const ResolvePlan& plan) {
  quincunx_needs needs = {};
  needs.reads_depth = plan.reads_depth;
  needs.reads_velocity = plan.velocity == VelocitySource::kTarget;
  needs.reads_reactive = plan.reads_reactive;
  needs.reads_camera = plan.reads_camera();
  needs.keeps_previous_frame = plan.keeps_previous_frame();
  needs.presented_storage = static_cast<int>(plan.presented_storage());
  needs.accumulates = plan.accumulates();
  needs.frame_bytes = plan.frame_bytes();
  return needs;
}

namespace {

// Fields whose names differ, as sentences have them: in C++ and in C.
constexpr std::pair<std::string_view, std::string_view> kNames[] = {
    {"settings.output_extent", "settings.output_width x output_height"},
    {"settings.target_extent", "settings.target_width x target_height"},
    {"settings.colour", "settings.colour_format"},
    {"settings.velocity", "settings.velocity_format"},
    {"settings.targets.particle_extent", "settings.particle_target_width x particle_target_height"},
    {"settings.targets.clear", "settings.clear"},
    {"settings.output.min_extent", "settings.min_output_width x min_output_height"},
    {"settings.output.linear", "settings.linear_format"},
    {"settings.output.present", "settings.present"},
    {"settings.filter.grain", "settings.grain"},
    {"settings.quincunx.velocity_weight", "settings.velocity_weight"},
    {"settings.quincunx.residual_weight", "settings.residual_weight"},
    {"settings.temporal.view", "settings.temporal_view"},
    {"settings.temporal.history", "settings.history_format"},
    {"settings.temporal.noise", "settings.temporal_noise"},
    {"settings.blur.shutter", "settings.shutter"},
    {"settings.blur.samples", "settings.blur_samples"},
    {"settings.focus.extent", "settings.focus_width x focus_height"},
    {"settings.focus.target_extent", "settings.focus_target_width x focus_target_height"},
    {"settings.control.fades", "settings.fades"},
    {"render_extent", "render_width x render_height"},
    {"output_extent", "output_width x output_height"},
    {"particle_render_extent", "particles.render_width x render_height"},
    {"particle_colour", "particles.colour"},
    {"particle_depth", "particles.depth"},
    {"particle_reactive", "particles.reactive"},
    {"jitter.x", "jitter_x"},
    {"jitter.y", "jitter_y"},
    {"velocity_scale.x", "velocity_scale_x"},
    {"velocity_scale.y", "velocity_scale_y"},
    {"camera.clip_to_previous_clip", "clip_to_previous_clip"},
    {"fading_from", "fade.from"},
    {"fade_weight", "fade.weight"},
};

std::string_view c_name(std::string_view name) {
  for (const auto& [own, in_c] : kNames)
    if (name == own) return in_c;
  return name;
}

// Of an image's part, "particle_colour.extent", both are translated.
std::string c_words(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == name.npos || c_name(name) != name) return std::string(c_name(name));
  const std::string_view image = name.substr(0, dot), part = name.substr(dot + 1);
  const bool is_image = image != "settings";
  return std::string(c_name(image)) + "." +
         std::string(is_image && part == "extent"    ? "width x height"
                     : is_image && part == "storage" ? "place"
                                                     : part);
}

}  // namespace

Status in_c_words(const Status& status) {
  const std::string& message = status.message();
  const auto in_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  std::string words;
  for (std::size_t at = 0; at < message.size();) {
    std::size_t end = at;
    while (end < message.size() && in_name(message[end]))
      ++end;
    words += c_words(std::string_view(message).substr(at, end - at));
    if (end < message.size()) words += message[end++];
    at = end;
  }
  return {status.code(), std::move(words)};
}

}  // namespace quincunx::c
