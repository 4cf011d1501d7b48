// SPDX-License-Identifier: MIT
// DumpOptions: what the command line of quincunx-dump asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "programs/dump_stages.h"
#include "programs/picture_options.h"

namespace quincunx::scenes {

struct DumpOptions : PictureOptions {
  std::int64_t frame = 0;     // of the run
  std::vector<Stage> stages;  // empty: all that the plan has
  std::string out;            // folder of the stages
  bool png = true;
  bool exr = true;
  int truth = 0;             // N: N x N samples a pixel; 0: no truth, 8 where a stage needs it
  std::int64_t warm_up = 1;  // frames drawn and resolved before `frame`, for its history

  std::string sequence;          // pattern: the whole run in the exchange format instead
  bool device_depth = false;     // of --sequence
  bool dilate_velocity = false;  // the same
};

// Reads a command line. On --help, --version or a usage error it prints and gives the exit code (0 or 2)
// instead.
std::optional<int> parse_command_line(int argc, char** argv, DumpOptions& options);

}  // namespace quincunx::scenes
