// SPDX-License-Identifier: MIT
// PartOptions: what a command line says of the parts of a frame that have a resolution of their own.
#pragma once

#include "programs/part_scales.h"

namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::scenes {

struct PartOption {
  bool automatic = false;  // a controller chooses the scale
  float scale = 1;
  double budget_ms = 0;  // of the controller; 0: not given
};

struct PartOptions {
  PartOption shadow;
};

void add_part_options(tools::CommandLine& app, PartOptions& options);

// `fps`: frames a second that are made, of which a tenth is each budget that is not given.
PartsSettings parts_for(const PartOptions& options, double fps);

}  // namespace quincunx::scenes
