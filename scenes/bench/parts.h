// SPDX-License-Identifier: MIT
// quincunx-bench --parts: whole frames whose picture, shadow map or particles have another scale, and their errors.
#pragma once

#include <array>
#include <optional>
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

// Median times of a frame: host clock, and this process's processor time of all threads.
struct PartTimes {
  double ms = 0;
  double processor_ms = 0;
};
QUINCUNX_FIELDS(PartTimes, ms, processor_ms)

struct PartRow {
  std::string part;             // "picture", "shadow map", "particles"
  std::string scale;            // "0.5", "together"
  std::array<int, 2> render{};  // the frame's viewport
  PartTimes draw;               // OpenGL
  PartTimes resolve;            // OpenCL
  PartTimes frame;              // both, and the way between them
  double psnr = 0;              // dB, tone mapped
  double flip = 0;              // mean
  // Against the first row: the time that this one saves, and the mean FLIP that a saved millisecond costs; absent where
  // none is saved.
  double saved_processor_ms = 0;
  std::optional<double> flip_per_ms;
};
QUINCUNX_FIELDS(PartRow, part, scale, render, draw, resolve, frame, psnr, flip, saved_processor_ms,
                flip_per_ms)

struct PartsResult : RunFacts {
  std::string scene, method;
  std::array<int, 2> output{};
  int frames = 0;             // measured, of each row
  std::vector<PartRow> rows;  // the first is what the others are compared with
};
QUINCUNX_FIELDS(PartsResult, version, command, date, scene, method, output, frames, machine, rows)

std::string text_of(const PartsResult& result);
std::string csv_of(const PartsResult& result);

// Measures the scene and the method of single_plan_from(). The picture's own scale goes through those that the options
// name. Throws a Failure where a step fails.
PartsResult run_parts(const BenchOptions& options);

}  // namespace quincunx::bench
