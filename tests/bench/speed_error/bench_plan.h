// SPDX-License-Identifier: MIT
// BenchPlan: what will be measured: methods, scenes and scales that the options choose. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench_options.h"
#include "bench_result.h"
#include "frame_sequence.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct BenchMethod {
  std::string name;  // as --method of quincunx-render takes it
  std::string summary;
  ResolveSettings resolve;
  scenes::Jitter jitter = scenes::Jitter::kNone;  // of the frames that it gets
  float lod_bias = 0;
  bool is_default = false;  // what the programs take where no --method is given
};

// Every method that there is.
std::vector<BenchMethod> all_methods();

struct BenchPlan {
  std::vector<BenchMethod> methods;
  std::size_t frame_method = 0;  // index: the one whose whole frames are timed
  std::vector<std::string> scenes;
  std::vector<double> scales;
  Conditions conditions;
};

// Errors: kInvalidArgument, for a name or a number that is no good; the message says what would be.
Result<BenchPlan> plan_from(const BenchOptions& options);

// The frames of one scale as methods with this jitter and bias get them: those that warm up, then the
// measured.
scenes::SequenceSettings sequence_for(const BenchPlan& plan, double scale, const BenchMethod& method);

// Scene time of a frame of the sequence.
double seconds_of(const Conditions& conditions, int index);

}  // namespace quincunx::bench
