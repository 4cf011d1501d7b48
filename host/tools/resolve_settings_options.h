// SPDX-License-Identifier: MIT
// The options of every command line that say how frames are resolved and presented.
#pragma once

#include "quincunx/resolve_plan.h"

namespace CLI {
class App;
}

namespace quincunx::tools {

// --method with its forms and settings, --tone-map, --no-dither. `settings` must outlive the parsing and
// holds the defaults.
void add_resolve_options(CLI::App& app, ResolveSettings& settings);

}  // namespace quincunx::tools
