// SPDX-License-Identifier: MIT
#include "tools/program/resolve_settings_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

// Option::in_range() takes NaN for a number of any range.
std::string complain_beyond_one(const std::string& text) {
  const std::optional<double> part = number_in(text);
  if (part && *part >= 0 && *part <= 1) return {};
  return fmt::format("'{}' is no number from 0 to 1", text);
}

// Every name that parse_variant() knows.
const std::map<std::string, MethodVariant>& variants_by_name() {
  static const auto by_name = [] {
    std::map<std::string, MethodVariant> all;
    for (const MethodInfo& info : methods())
      all[info.name] = parse_variant(info.name).value();
    for (const VariantInfo& info : all_variants())
      all[info.name] = info.variant;
    return all;
  }();
  return by_name;
}

// All of them in one line: "point, bilinear, ... or temporal[:fast|:balanced|:quality]".
std::string method_list() {
  std::vector<std::string> words;
  for (const MethodInfo& info : methods()) {
    std::string endings;
    for (const VariantInfo& form : all_variants()) {
      if (form.variant.method == info.method && form.name != info.name)
        endings += (endings.empty() ? "" : "|") + form.name.substr(form.name.find(':'));
    }
    words.push_back(endings.empty() ? info.name : fmt::format("{}[{}]", info.name, endings));
  }
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} or {}", fmt::join(words, ", "), last);
}

}  // namespace

void add_resolve_options(CommandLine& app, ResolveSettings& settings, const std::string& default_method) {
  add_choice(app, "--method", variants_by_name(),
             fmt::format("{} (default: {})", method_list(), default_method),
             [&settings](const MethodVariant& variant) { apply(variant, settings); });
  app.add_option("--velocity-weight", settings.quincunx.velocity_weight,
                 "K of quincunx:velocity and :point: how fast motion takes the previous frame away")
      .non_negative()
      .show_default()
      .type_name("K");
  app.add_option("--residual-weight", settings.quincunx.residual_weight,
                 "K of quincunx:reprojected: how fast a change of motion does; 0 looks at none")
      .non_negative()
      .show_default()
      .type_name("K");
  add_choice(app, "--sky-motion", settings.conventions.sky_motion, choices<SkyMotion>(),
             "What moves an infinitely far sample whose velocity is 0: as-drawn (nothing), camera or "
             "evidence (default: as-drawn)");
  add_choice(app, "--view", settings.temporal.view, choices<TemporalView>(),
             "What temporal shows: picture, confidence, rejection, phase, layers, coverage, near or far "
             "(default: picture)");
  app.add_option("--blur", settings.blur.shutter,
                 "Motion blur: part of a frame's time that the shutter is open, to 2")
      .in_range(0.0, 2.0)
      .type_name("SHUTTER");
  app.add_option("--blur-samples", settings.blur.samples, "Samples a pixel at most: 4, 8, 16, 32 or 64")
      .one_of({4, 8, 16, 32, 64})
      .show_default()
      .type_name("N");
  app.add_option("--sharpen", settings.sharpness, "How far the resolved picture is sharpened: 0 (not) to 1")
      .check(complain_beyond_one)
      .show_default()
      .type_name("AMOUNT");
  app.add_flag("!--no-clamp-ringing", settings.filter.clamp_ringing,
               "Let catmull-rom, mitchell and lanczos overshoot at edges");
  app.add_option("--grain", settings.filter.grain, "Amplitude of noise's grain at scale 0; none at scale 1")
      .check(complain_beyond_one)
      .show_default()
      .type_name("A");
  app.add_flag("!--still-noise", settings.filter.noise_moves, "The same noise in every frame");
  add_choice(app, "--tone-map", settings.output.tone_map, choices<ToneMap>(),
             "clamp, reinhard or aces (default: aces)");
  app.add_flag("--check-motion", settings.checks_motion,
               "Say whether velocity points where samples come from, or would with another sign");
  app.add_flag("!--no-dither", settings.output.dither, "Round to 8 bits without dither");
}

std::string resolve_settings_text(const ResolveSettings& settings) {
  const std::string noise =
      settings.temporal.noise > 0 ? fmt::format(", denoised {}", settings.temporal.noise) : "";
  return fmt::format(
      "{}, view {}, sky motion {}, drawn velocity {}, velocity weight {}, ringing {}, grain {}, noise {}, "
      "sharpness "
      "{}, blur {} of {} "
      "samples{}",
      name_of(variant_of(settings)), name_of(settings.temporal.view),
      name_of(settings.conventions.sky_motion), name_of(settings.conventions.drawn_velocity),
      settings.quincunx.velocity_weight, settings.filter.clamp_ringing ? "clamped" : "free",
      settings.filter.grain, settings.filter.noise_moves ? "moves" : "still", settings.sharpness,
      settings.blur.shutter, settings.blur.samples, noise);
}

}  // namespace quincunx::tools
