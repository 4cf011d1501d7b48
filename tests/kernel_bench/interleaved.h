// SPDX-License-Identifier: MIT
// Timing of many cases side by side: every round runs each case once, so that a busy machine slows all alike.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quincunx::bench {

struct Case {
  std::string name;
  double scale = 1;                  // render extent / output extent
  double wanted = 0;                 // aim of the project, in times of the first case; 0: none
  std::uint64_t bytes = 0;           // read and written, each texel counted once
  std::function<double()> run = {};  // runs once, to the end, and returns ms on the clock that suits it
};

struct Timing {
  double median = 0, p95 = 0, minimum = 0;
};

struct Figures {
  Case what;
  Timing ms;            // as Case::run returned them
  Timing processor_ms;  // of the whole process, all threads: on a CPU what the run cost, however busy it was
};

// After `warm_rounds` that do not count.
std::vector<Figures> run_interleaved(const std::vector<Case>& cases, int warm_rounds, int rounds);

// Wall clock of one run, ms.
double wall_ms(const std::function<void()>& run);

}  // namespace quincunx::bench
