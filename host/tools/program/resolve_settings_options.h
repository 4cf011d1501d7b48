// SPDX-License-Identifier: MIT
// The options of every command line that say how frames are resolved and presented, and the names of all settings.
#pragma once

#include <functional>
#include <string>

#include "quincunx/resolve_plan.h"

namespace quincunx::tools {

class CommandLine;

struct MethodOptions {
  std::string usual = "temporal";  // default that the help tells
  // Whether the method is known when all options are read; else no option is refused because of it.
  std::function<bool()> settled = [] { return true; };
  bool* named = nullptr;  // set where the user names a method
};

// --method with its forms and settings, --tone-map, --no-dither. `settings` must outlive the parsing and holds the
// defaults.
void add_resolve_options(CommandLine& line, ResolveSettings& settings, const MethodOptions& about = {});

// --device and --list-devices.
void add_device_options(CommandLine& line, std::string& device, bool& lists);

// --quiet and --verbose; after all others, because they belong to the help's last group.
void add_log_options(CommandLine& line, bool& quiet, int& verbosity);

// Returns the resolve options as text, as far as linear pixels depend on them: "quincunx:velocity, velocity weight 1".
std::string resolve_settings_text(const ResolveSettings& settings);

namespace detail {

template <typename Visit, typename Settings>
void each_convention(Settings& of, Visit&& visit) {
  auto& [depth, clip_space, velocity_unit, velocity_backward, velocity_up, velocity_jittered, origin,
         drawn_velocity, sky_motion] = of.conventions;
  visit("conventions.depth", depth);
  visit("conventions.clip_space", clip_space);
  visit("conventions.velocity_unit", velocity_unit);
  visit("conventions.velocity_backward", velocity_backward);
  visit("conventions.velocity_up", velocity_up);
  visit("conventions.velocity_jittered", velocity_jittered);
  visit("conventions.origin", origin);
  visit("conventions.drawn_velocity", drawn_velocity);
  visit("conventions.sky_motion", sky_motion);
}

template <typename Visit, typename Settings>
void each_part(Settings& of, Visit&& visit) {
  auto& [storage, placement, shading, particle_extent, clear] = of.targets;
  visit("targets.storage", storage);
  visit("targets.placement", placement);
  visit("targets.shading", shading);
  visit("targets.particle_extent", particle_extent);
  visit("targets.clear", clear);
  auto& [min_extent, linear, present, tone_map, dither] = of.output;
  visit("output.min_extent", min_extent);
  visit("output.linear", linear);
  visit("output.present", present);
  visit("output.tone_map", tone_map);
  visit("output.dither", dither);
  auto& [clamp_ringing, grain, noise_moves] = of.filter;
  visit("filter.clamp_ringing", clamp_ringing);
  visit("filter.grain", grain);
  visit("filter.noise_moves", noise_moves);
  auto& [form, sampling, velocity_weight, residual_weight] = of.quincunx;
  visit("quincunx.form", form);
  visit("quincunx.sampling", sampling);
  visit("quincunx.velocity_weight", velocity_weight);
  visit("quincunx.residual_weight", residual_weight);
  auto& [preset, view, history, noise] = of.temporal;
  visit("temporal.preset", preset);
  visit("temporal.view", view);
  visit("temporal.history", history);
  visit("temporal.noise", noise);
  auto& [shutter, samples] = of.blur;
  visit("blur.shutter", shutter);
  visit("blur.samples", samples);
  auto& [extent, target_extent, mask] = of.focus;
  visit("focus.extent", extent);
  visit("focus.target_extent", target_extent);
  visit("focus.mask", mask);
  auto& [measures_content, fades] = of.control;
  visit("control.measures_content", measures_content);
  visit("control.fades", fades);
}

}  // namespace detail

// Calls visit(name, field) for every field of ResolveSettings, by its name in C++ and in the file. The structured
// bindings do not compile where a field is missing here.
template <typename Visit, typename Settings>
void each_setting(Settings& of, Visit&& visit) {
  auto& [method, output_extent, target_extent, colour, velocity, conventions, sharpness, targets, output,
         filter, quincunx, temporal, blur, focus, control, checks_motion] = of;
  visit("method", method);
  visit("output_extent", output_extent);
  visit("target_extent", target_extent);
  visit("colour", colour);
  visit("velocity", velocity);
  visit("sharpness", sharpness);
  visit("checks_motion", checks_motion);
  detail::each_convention(of, visit);
  detail::each_part(of, visit);
}

}  // namespace quincunx::tools
