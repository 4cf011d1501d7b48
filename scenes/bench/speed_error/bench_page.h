// SPDX-License-Identifier: MIT
// page_of: a result as one HTML file that needs nothing else.
#pragma once

#include <string>

#include "bench/speed_error/bench_gallery.h"
#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

// The template with style, script, figures and pictures put in. An empty gallery leaves the viewer out. Pure.
std::string page_of(const BenchResult& result, const Gallery& gallery);

}  // namespace quincunx::bench
