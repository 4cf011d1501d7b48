// SPDX-License-Identifier: MIT
// LoadTrace: what each frame of a scripted load would cost, and the lists that controllers are measured on.
//
// Loads are multiples of the target time, so that a trace serves every refresh rate. A frame drawn at area
// fraction p takes  target * (fixed + scaling * p^exponent) * noise.  Same seed, same trace, on every
// machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/status.h"

namespace quincunx::traces {

struct FrameLoad {
  double fixed = 0;     // cost that does not follow the resolution
  double scaling = 0;   // cost at the output resolution that does
  double exponent = 1;  // 1: in proportion to the pixels
  double cpu = 0.5;     // time that the processor needs to prepare the frame
  double noise = 1;     // factor on the graphics time

  double gpu(double area_fraction) const;  // in targets
};

// The use of a trace in the totals.
enum class TraceKind {
  kFeasible,    // a resolution on the ladder fits every frame but single spikes: part of the totals
  kInfeasible,  // for a while nothing fits: dropped frames cannot be avoided
  kCpuBound,    // for a while the processor is too slow, whatever the resolution
};

struct LoadTrace {
  std::string name;
  TraceKind kind = TraceKind::kFeasible;
  std::vector<FrameLoad> frames;
  // Frames at which the load steps for good; settling is counted from each. Empty where nothing steps.
  std::vector<int> steps_up = {};
  std::vector<int> steps_down = {};
};

// Which list a trace belongs to. Controllers of this project were tuned on kDevelopment only; kHeldOut has
// other shapes, other magnitudes, other fixed parts, a cost that is not linear in pixels, and other seeds.
enum class Split { kDevelopment, kHeldOut };

constexpr int kFrames = 1800;

// Return 16 feasible traces, then one infeasible and one bound by the processor.
std::vector<LoadTrace> development_traces(std::uint64_t seed);
std::vector<LoadTrace> held_out_traces(std::uint64_t seed);
std::vector<LoadTrace> traces_of(Split split, std::uint64_t seed);

// How a load that a real program recorded becomes a trace.
struct Recording {
  double target_ms = 1000.0 / 60;  // what the recorded times are divided by
  double fixed_part = 0.25;  // share of the cost at the output resolution that does not scale, in [0, 0.9]
};

// Makes a trace of CSV text: a header line that names at least `gpu_ms` and `area_fraction`, in any order and among
// others, then a line for each frame; `cpu_ms` is read where it is there. No quotes. Errors: kInvalidArgument naming
// the line.
Result<LoadTrace> recorded_trace(const std::string& name, const std::string& csv, const Recording& recording);

}  // namespace quincunx::traces
