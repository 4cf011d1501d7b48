// SPDX-License-Identifier: MIT
// run_bench: measures everything that a plan asks for; and what all measurements run on, a scene on the device that the
// options name, and the machine.
#pragma once

#include <memory>
#include <string>

#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_result.h"
#include "frames/frame_source.h"

namespace quincunx::bench {

// Throws a Failure where a step fails.
std::unique_ptr<scenes::FrameSource> open_stage(const BenchOptions& options, const std::string& scene,
                                                const scenes::SequenceSettings& sequence);

void describe_machine(const scenes::FrameSource& source, Machine& machine);

// Returns the number of processes that ran or wanted to; 0 where it is not known.
double load_of_last_minute();

// Returns what is known when a run begins.
RunFacts facts_of(const BenchOptions& options, const scenes::FrameSource& stage);

struct BenchRun {
  BenchResult result;
  Gallery gallery;
};

// Takes minutes; shows progress on a terminal unless `quiet`. Throws a Failure where a step fails.
BenchRun run_bench(const BenchPlan& plan, const BenchOptions& options);

}  // namespace quincunx::bench
