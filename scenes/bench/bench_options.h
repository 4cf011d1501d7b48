// SPDX-License-Identifier: MIT
// BenchOptions: what the command line of quincunx-bench asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/front.h"
#include "bench/parts.h"
#include "bench/resize.h"
#include "bench/traces/trace_command.h"
#include "bench/tune.h"
#include "frames/picture_options.h"
#include "quincunx/advanced/extent.h"

namespace quincunx::bench {

// Scene, scale and method of the base are of no use here: there are several of each.
struct BenchOptions : scenes::PictureOptions {
  std::vector<std::string> scenes;   // empty: all that are built in
  std::vector<std::string> methods;  // empty: all
  std::vector<double> scales = {0.35, 0.5, 0.71, 0.85, 1};
  int warm_up = 2;  // frames before the measured ones, and before the timed ones
  // Before the measured ones, of methods that accumulate; at least warm_up.
  int history_warm_up = scenes::kWarmUpFrames;
  int rounds = 5;
  int noise = 0;  // samples a pixel of frames that a path tracer might have made; 0: without noise
  int truth = 8;  // samples along each side of a pixel
  bool quick = false;

  std::string out;      // folder; empty: no files
  std::string compare;  // an older bench.json; empty: none
  std::string from;     // a bench.json instead of measuring; empty: measure
  bool list_methods = false;
  traces::TraceOptions traces;
  ResizeOptions resize;
  PartsOptions parts_bench;
  TuneOptions tune;
  FrontOptions front;
  bool json = false;

  std::string command_line;
};

// Returns the table of options; they write into `options`, which must outlive the parsing.
tools::CommandLine command_line(BenchOptions& options);

// Reads a command line. On --help, --version or an error it prints and gives the exit code instead.
std::optional<int> parse_command_line(int argc, char** argv, BenchOptions& options);

}  // namespace quincunx::bench
