// SPDX-License-Identifier: MIT
// quincunx-bench --resize: its options, and what it measures: the cost of another resolution, and frames with both
// kinds of targets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/bench_statistics.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct BenchOptions;

struct ResizeOptions {
  bool wanted = false;
  int resizes = 200;
};

// --resize, and options that need it.
struct Quantiles {
  double least = 0;
  double median = 0;
  double p95 = 0;  // nearest rank
};

Quantiles quantiles_of(const Samples& samples);  // all zero where there is none

// One way to have targets of another size.
struct ResizeCost {
  std::string name;     // "kept"
  std::string what;     // in a few words
  Quantiles resize_us;  // host time until the targets are complete
  Quantiles first_ms;   // clearing them and waiting for that: their first use
};

// Whole frames at one scale, or at another in each.
struct TargetFrames {
  std::string scale;  // "0.5", "random"
  Targets targets = Targets::kViewport;
  Extent render;  // extent of the last frame
  Quantiles draw_ms, interop_ms, resolve_ms, frame_ms;
  double processor_ms = 0;  // median of whole frames, all threads
  std::uint64_t gl_bytes = 0;
  std::uint64_t opencl_bytes = 0;
};

struct ResizeResult {
  std::string version, command, date;
  std::string scene, method;
  Extent output;
  int resizes = 0;  // number for each way
  int frames = 0;   // number for each row
  Machine machine;
  std::vector<ResizeCost> costs;
  std::vector<TargetFrames> rows;
};

std::string text_of(const ResizeResult& result);
std::string json_of(const ResizeResult& result);
std::string csv_of(const ResizeResult& result);  // the frames

// Measures the first scene with the first method at the scales that the options name; by default the courtyard, the
// default method and 0.5, 0.7 and 1. Errors: of any part, as that part words them.
Result<ResizeResult> run_resize(const BenchOptions& options);

}  // namespace quincunx::bench
