// SPDX-License-Identifier: MIT
// run_bench: measures everything that a plan asks for.
#pragma once

#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

struct BenchRun {
  BenchResult result;
  Gallery gallery;
};

// Takes minutes; shows progress on a terminal unless `quiet`. Errors: of any part, as it words them.
Result<BenchRun> run_bench(const BenchPlan& plan, const BenchOptions& options);

}  // namespace quincunx::bench
