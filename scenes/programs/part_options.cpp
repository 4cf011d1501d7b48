// SPDX-License-Identifier: MIT
#include "programs/part_options.h"

#include <fmt/format.h>

#include <string>

#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kAutomatic = "auto";
constexpr double kDefaultBudget = 0.1;  // of a frame's time
constexpr double kLongestBudget = 1000;

// What both options of a part are called.
struct PartNames {
  std::string scale;
  std::string budget;
  std::string what;
};

void read_scale(const std::string& option, const std::string& text, PartOption& part) {
  part.automatic = text == kAutomatic;
  if (part.automatic) return;
  const auto scale = tools::number_in(text);
  if (!scale || !(*scale >= kLeastPartScale && *scale <= 1)) {
    throw tools::UsageError{
        option, fmt::format("'{}' is no scale of a part; give a number from {} to 1, or auto", text,
                            kLeastPartScale)};
  }
  part.scale = static_cast<float>(*scale);
}

// part(): where the option is, made by the first of the two that is given.
template <typename Part>
void add_part(tools::CommandLine& app, const PartNames& names, Part part) {
  const auto scale =
      app.add_option_function<std::string>(
             names.scale,
             [part, option = names.scale](const std::string& text) { read_scale(option, text, part()); },
             names.what)
          .type_name("S|auto");
  app.add_option_function<float>(
         names.budget, [part](const float& budget) { part().budget_ms = static_cast<double>(budget); },
         "With auto: milliseconds of OpenGL's work a frame (default: a tenth of a frame of --fps)")
      .in_range(0.001, kLongestBudget)
      .needs(scale)
      .type_name("MS");
  app.when_read([&app, part, names] {
    if (app.has(names.budget) && !part().automatic)
      throw tools::UsageError{names.budget, "nothing holds it; give " + names.scale + " auto"};
  });
}

PartSettings settings_for(const PartOption& part, double fps) {
  if (!part.automatic) return {.scale = part.scale};
  return {.budget_ms = part.budget_ms > 0 ? part.budget_ms : kDefaultBudget * 1000 / fps};
}

}  // namespace

std::string text_of(const PartOption& part) {
  return part.automatic ? kAutomatic : fmt::format("{:g}", part.scale);
}

PartOption part_option(const std::string& text, double budget_ms) {
  if (text == kAutomatic) return {.automatic = true, .budget_ms = budget_ms};
  return {.scale = static_cast<float>(tools::number_in(text).value_or(1))};
}

void add_part_options(tools::CommandLine& app, PartOptions& options) {
  add_part(app,
           {"--shadow-scale", "--shadow-budget",
            "Side of the shadow map's part in use, of the whole (default: 1); auto: held by a controller"},
           [&options]() -> PartOption& { return options.shadow; });
  add_part(app,
           {"--particle-scale", "--particle-budget",
            "Particles in a viewport of their own: its scale, of the frame's (default: drawn with everything "
            "else); auto: held by a controller"},
           [&options]() -> PartOption& {
             if (!options.particles) options.particles.emplace();
             return *options.particles;
           });
}

PartsSettings parts_for(const PartOptions& options, double fps) {
  PartsSettings settings{.shadow = settings_for(options.shadow, fps)};
  if (options.particles) settings.particles = settings_for(*options.particles, fps);
  return settings;
}

}  // namespace quincunx::scenes
