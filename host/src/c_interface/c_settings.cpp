// SPDX-License-Identifier: MIT
#include "c_interface/c_frame.h"

#include <fmt/format.h>

#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "c_interface/sized_struct.h"
#include "plan/resources.h"

namespace quincunx::c {

namespace {

static_assert(static_cast<int>(Method::kTemporal) == QUINCUNX_TEMPORAL);
static_assert(static_cast<int>(TemporalView::kFar) == QUINCUNX_VIEW_FAR);
static_assert(static_cast<int>(PixelFormat::kRGBA32F) == QUINCUNX_RGBA32F);
static_assert(static_cast<int>(ToneMap::kAces) == QUINCUNX_ACES);

// Pairs of fields, as ToC and Reader take them.
constexpr auto kPairs = [](auto& c, auto& own, auto& pair) {
  auto& resolve = own.resolve;
  auto& given = resolve.conventions;
  pair("moving_objects", c.moving_objects, own.needs.moving_objects);
  pair("camera_motion", c.camera_motion, own.needs.camera_motion);
  pair("transparents", c.transparents, own.needs.transparents);
  pair("background", c.background, own.needs.background);
  pair("method", c.method, resolve.method, Method::kTemporal);
  pair("output_width", c.output_width, resolve.output_extent.width);
  pair("output_height", c.output_height, resolve.output_extent.height);
  pair("target_width", c.target_width, resolve.target_extent.width);
  pair("target_height", c.target_height, resolve.target_extent.height);
  pair("colour_format", c.colour_format, resolve.colour, PixelFormat::kRGBA32F);
  pair("velocity_format", c.velocity_format, resolve.velocity, PixelFormat::kRGBA32F);
  pair("linear_format", c.linear_format, resolve.output.linear, PixelFormat::kRGBA32F);
  pair("storage", c.storage, resolve.targets.storage, Storage::kImage);
  pair("targets", c.targets, resolve.targets.placement, Targets::kPlaced);
  pair("shading", c.shading, resolve.targets.shading, Shading::kCheckerboard);
  pair("present", c.present, resolve.output.present);
  pair("clear", c.clear, resolve.targets.clear);
  pair("tone_map", c.tone_map, resolve.output.tone_map, ToneMap::kAces);
  pair("dither", c.dither, resolve.output.dither);
  pair("clamp_ringing", c.clamp_ringing, resolve.filter.clamp_ringing);
  pair("noise_moves", c.noise_moves, resolve.filter.noise_moves);
  pair("drawn_velocity", c.drawn_velocity, given.drawn_velocity, DrawnVelocity::kDilated);
  pair("depth_convention", c.depth_convention, given.depth, DepthConvention::kLinear);
  pair("clip_space", c.clip_space, given.clip_space, ClipSpace::kVulkan);
  pair("velocity_unit", c.velocity_unit, given.velocity_unit, VelocityUnit::kNdc);
  pair("velocity_backward", c.velocity_backward, given.velocity_backward);
  pair("velocity_up", c.velocity_up, given.velocity_up);
  pair("velocity_jittered", c.velocity_jittered, given.velocity_jittered);
  pair("origin", c.origin, given.origin, Origin::kBottom);
  pair("sky_motion", c.sky_motion, given.sky_motion, SkyMotion::kEvidence);
  pair("two_frame_form", c.two_frame_form, resolve.quincunx.form, TwoFrameForm::kReprojected);
  pair("sampling", c.sampling, resolve.quincunx.sampling, Sampling::kBilinear);
  pair("temporal_preset", c.temporal_preset, resolve.temporal.preset, TemporalPreset::kQuality);
  pair("temporal_view", c.temporal_view, resolve.temporal.view, TemporalView::kFar);
  pair("history_format", c.history_format, resolve.temporal.history, PixelFormat::kRGBA32F);
  pair("blur_samples", c.blur_samples, resolve.blur.samples);
  pair("shutter", c.shutter, resolve.blur.shutter);
  pair("sharpness", c.sharpness, resolve.sharpness);
  pair("grain", c.grain, resolve.filter.grain);
  pair("velocity_weight", c.velocity_weight, resolve.quincunx.velocity_weight);
  pair("residual_weight", c.residual_weight, resolve.quincunx.residual_weight);
  pair("min_output_width", c.min_output_width, resolve.output.min_extent.width);
  pair("min_output_height", c.min_output_height, resolve.output.min_extent.height);
  pair("particle_target_width", c.particle_target_width, resolve.targets.particle_extent.width);
  pair("particle_target_height", c.particle_target_height, resolve.targets.particle_extent.height);
  pair("focus_width", c.focus_width, resolve.focus.extent.width);
  pair("focus_height", c.focus_height, resolve.focus.extent.height);
  pair("focus_target_width", c.focus_target_width, resolve.focus.target_extent.width);
  pair("focus_target_height", c.focus_target_height, resolve.focus.target_extent.height);
  pair("focus_mask", c.focus_mask, resolve.focus.mask);
  pair("measures_content", c.measures_content, resolve.control.measures_content);
  pair("fades", c.fades, resolve.control.fades);
  pair("temporal_noise", c.temporal_noise, resolve.temporal.noise);
  pair("checks_motion", c.checks_motion, resolve.checks_motion);
};

}  // namespace

quincunx_settings to_c(const SceneSettings& settings) {
  return to_c<quincunx_settings>(settings, kPairs);
}

Result<SceneSettings> from_c(const quincunx_settings* settings) {
  SceneSettings to;
  quincunx_settings from;
  if (Status status = read_settings(settings, from, to, kPairs); !status.ok()) return status;
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
    {"jitter.x", "jitter_x"},
    {"jitter.y", "jitter_y"},
    {"velocity_scale.x", "velocity_scale_x"},
    {"velocity_scale.y", "velocity_scale_y"},
    {"camera.clip_to_previous_clip", "clip_to_previous_clip"},
    {"fade_weight", "fade.weight"},
};

std::string_view c_name(std::string_view name) {
  for (const auto& [own, in_c] : kNames)
    if (name == own) return in_c;
  for (const InputImage& input : kInputs)
    if (name == input.name) return input.name_in_c();
  return name;
}

// Translates both names in "particle_colour.extent": the image's and its part's.
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
