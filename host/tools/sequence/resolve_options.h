// SPDX-License-Identifier: MIT
// ResolveOptions: what the command line of quincunx-resolve asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "tools/image/image_io.h"
#include "tools/sequence/sequence_input.h"

namespace quincunx::tools {

struct ResolveOptions {
  std::string input;          // pattern
  std::string out;            // pattern; may be empty with --dry-run, --explain and --truth
  SequenceInput sequence;     // how the frames are to be understood, but for the jitter
  std::string jitter;         // as JitterSource::parse() takes it
  ResolveSettings resolve;    // sizes and formats follow from the frames
  bool method_named = false;  // else it follows from the frames, too
  ChannelType stored = ChannelType::kHalf;
  float exposure = 0;
  std::string truth;         // pattern; empty: none
  std::string truth_colour;  // its layer, as SequenceInput has it

  std::optional<std::vector<std::int64_t>> frames;  // absent: all there are
  std::optional<int> warm_up;                       // absent: what the method looks back
  bool resume = false;
  bool skip_bad_frames = false;

  bool dry_run = false;
  bool explain = false;
  bool list_devices = false;
  int threads = 1;
  std::string device;
  std::string report;  // base name of .txt and .json; empty: none
  bool json = false;
  bool quiet = false;
  int verbosity = 0;

  std::string command_line;  // as typed, for the report
};

// Reads a command line. On --help, --version or a usage error it prints and gives the exit code (0 or 2)
// instead.
std::optional<int> parse_command_line(int argc, char** argv, ResolveOptions& options);

}  // namespace quincunx::tools
