// SPDX-License-Identifier: MIT
// quincunx-bench --parts: its options, and what it measures: whole frames whose picture, shadow map or particles have
// another scale, and their errors.
#pragma once

#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct BenchOptions;

struct PartsOptions {
  bool wanted = false;
  double base_scale = 0.71;  // scale of the picture, where a part's scale is changed
};

// --parts, and options that need it.
// Median times of a frame: host clock, and this process's processor time of all threads.
struct PartTimes {
  double ms = 0;
  double processor_ms = 0;
};

struct PartRow {
  std::string part;    // "picture", "shadow map", "particles"
  std::string scale;   // "0.5", "together"
  PartTimes draw;      // OpenGL
  PartTimes resolve;   // OpenCL
  PartTimes frame;     // both, and the way between them
  double psnr = 0;     // dB, tone mapped
  double flip = 0;     // mean
  Extent render = {};  // the frame's viewport
};

struct PartsResult {
  std::string version, command, date;
  std::string scene, method;
  Extent output;
  int frames = 0;  // measured, of each row
  Machine machine;
  std::vector<PartRow> rows;  // the first is what the others are compared with
};

// The saving and the loss of a row against the first one. `flip_per_ms`: the error that a saved millisecond costs, NaN
// where none is saved.
struct PartChange {
  double saved_processor_ms = 0;
  double flip = 0;
  double flip_per_ms = 0;
};
PartChange change_of(const PartRow& row, const PartRow& base);

std::string text_of(const PartsResult& result);
std::string json_of(const PartsResult& result);
std::string csv_of(const PartsResult& result);

// Measures the first scene with the first method that the options name; by default the courtyard and the default
// method. The picture's own scale goes through those that the options name. Errors: of any part, as that part words
// them.
Result<PartsResult> run_parts(const BenchOptions& options);

}  // namespace quincunx::bench
