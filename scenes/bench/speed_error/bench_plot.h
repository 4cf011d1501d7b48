// SPDX-License-Identifier: MIT
// plot_of: the picture of a result that a document shows: error over cost at the headline scale. Pure.
#pragma once

#include <string>

#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

// An SVG that stands alone: mean FLIP of all scenes over the mean cost in copies, one point a method, with
// the Pareto front. Empty where there are no rows.
std::string plot_of(const BenchResult& result);

}  // namespace quincunx::bench
