// SPDX-License-Identifier: MIT
// The options of every command line that say how frames are resolved and presented.
#pragma once

#include <string>

#include "quincunx/resolve_plan.h"

namespace quincunx::tools {

class CommandLine;

// --method with its forms and settings, --tone-map, --no-dither. `settings` must outlive the parsing and
// holds the defaults. `default_method`: what --help says of the method's.
void add_resolve_options(CommandLine& app, ResolveSettings& settings,
                         const std::string& default_method = "temporal");

// Returns these options as text, as far as linear pixels depend on them: "quincunx:velocity, velocity weight 1".
std::string resolve_settings_text(const ResolveSettings& settings);

}  // namespace quincunx::tools
