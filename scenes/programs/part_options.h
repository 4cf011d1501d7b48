// SPDX-License-Identifier: MIT
// PartOptions: what a command line says of the parts of a frame that have a resolution of their own.
#pragma once

#include <optional>
#include <string>

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
  std::optional<PartOption> particles;  // absent: drawn with everything else
};

// "0.5" or "auto", as --shadow-scale takes it. From such a text; one that is neither gives the whole.
std::string text_of(const PartOption& part);
PartOption part_option(const std::string& text, double budget_ms);

void add_part_options(tools::CommandLine& app, PartOptions& options);

// `fps`: frames a second that are made, of which a tenth is each budget that is not given.
PartsSettings parts_for(const PartOptions& options, double fps);

}  // namespace quincunx::scenes
