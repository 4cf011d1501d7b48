// SPDX-License-Identifier: MIT
// channel_options: which channels quincunx-resolve reads, and what they mean.
#pragma once

#include "tools/sequence/resolve_options.h"

namespace quincunx::tools {

class CommandLine;

void add_channel_options(CommandLine& app, ResolveOptions& options);

}  // namespace quincunx::tools
