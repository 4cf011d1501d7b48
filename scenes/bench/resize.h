// SPDX-License-Identifier: MIT
// quincunx-bench --resize: the cost of another resolution, and whole frames with both kinds of targets.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct BenchOptions;

struct ResizeOptions {
  bool wanted = false;
  int resizes = 200;
};

// All zero where there is no sample.
struct Quantiles {
  double min = 0;
  double median = 0;
  double p95 = 0;  // nearest rank
};
QUINCUNX_FIELDS(Quantiles, min, median, p95)

// One way to have targets of another size.
struct ResizeCost {
  std::string way;         // "kept"
  std::string what;        // in a few words
  Quantiles resize_us;     // host time until the targets are complete
  Quantiles first_use_ms;  // clearing them and waiting for that
};
QUINCUNX_FIELDS(ResizeCost, way, what, resize_us, first_use_ms)

// Whole frames at one scale, or at another in each.
struct TargetFrames {
  std::string scale;            // "0.5", "random"
  std::string targets;          // "viewport", "placed"
  std::array<int, 2> render{};  // extent of the last frame
  Quantiles draw_ms, interop_ms, resolve_ms, frame_ms;
  double frame_processor_ms = 0;  // median of whole frames, all threads
  std::uint64_t gl_bytes = 0;
  std::uint64_t opencl_bytes = 0;
};
QUINCUNX_FIELDS(TargetFrames, scale, targets, render, draw_ms, interop_ms, resolve_ms, frame_ms,
                frame_processor_ms, gl_bytes, opencl_bytes)

struct ResizeResult : RunFacts {
  std::string scene, method;
  std::array<int, 2> output{};
  int resizes = 0;  // number for each way
  int frames = 0;   // number for each row
  std::vector<ResizeCost> costs;
  std::vector<TargetFrames> rows;
};
QUINCUNX_FIELDS(ResizeResult, version, command, date, scene, method, output, resizes, frames, machine, costs,
                rows)

std::string text_of(const ResizeResult& result);
std::string csv_of(const ResizeResult& result);  // the frames

// Measures the scene and the method of single_plan_from() at the scales that the options name; by default 0.5, 0.7 and
// 1. Throws a Failure where a step fails.
ResizeResult run_resize(const BenchOptions& options);

}  // namespace quincunx::bench
