// SPDX-License-Identifier: MIT
#include "programs/part_options.h"

#include <fmt/format.h>

#include <string>

#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

constexpr double kDefaultBudget = 0.1;  // of a frame's time
constexpr double kLongestBudget = 1000;

// What both options of a part are called.
struct PartNames {
  std::string scale;
  std::string budget;
  std::string what;
};

void read_scale(const std::string& option, const std::string& text, PartOption& part) {
  part.automatic = text == "auto";
  if (part.automatic) return;
  const auto scale = tools::number_in(text);
  if (!scale || !(*scale >= kLeastPartScale && *scale <= 1)) {
    throw tools::UsageError{
        option, fmt::format("'{}' is no scale of a part; give a number from {} to 1, or auto", text,
                            kLeastPartScale)};
  }
  part.scale = static_cast<float>(*scale);
}

void add_part(tools::CommandLine& app, const PartNames& names, PartOption& part) {
  const auto scale =
      app.add_option_function<std::string>(
             names.scale,
             [&part, option = names.scale](const std::string& text) { read_scale(option, text, part); },
             names.what)
          .type_name("S|auto");
  app.add_option(names.budget, part.budget_ms,
                 "With auto: milliseconds of OpenGL's work a frame (default: a tenth of a frame of --fps)")
      .in_range(0.001, kLongestBudget)
      .needs(scale)
      .type_name("MS");
  app.when_read([&app, &part, names] {
    if (app.has(names.budget) && !part.automatic)
      throw tools::UsageError{names.budget, "nothing holds it; give " + names.scale + " auto"};
  });
}

PartSettings settings_for(const PartOption& part, double fps) {
  if (!part.automatic) return {.scale = part.scale};
  return {.budget_ms = part.budget_ms > 0 ? part.budget_ms : kDefaultBudget * 1000 / fps};
}

}  // namespace

void add_part_options(tools::CommandLine& app, PartOptions& options) {
  add_part(app,
           {"--shadow-scale", "--shadow-budget",
            "Side of the shadow map's part in use, of the whole (default: 1); auto: held by a controller"},
           options.shadow);
}

PartsSettings parts_for(const PartOptions& options, double fps) {
  return {.shadow = settings_for(options.shadow, fps)};
}

}  // namespace quincunx::scenes
