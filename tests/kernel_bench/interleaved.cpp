// SPDX-License-Identifier: MIT
#include "interleaved.h"

#include <algorithm>
#include <chrono>

#include "bench/harness/process_clock.h"

namespace quincunx::bench {
namespace {

Timing summarise(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return {ms[ms.size() / 2], ms[ms.size() * 95 / 100], ms.front()};
}

}  // namespace

std::vector<Figures> run_interleaved(const std::vector<Case>& cases, int warm_rounds, int rounds) {
  struct Samples {
    std::vector<double> ms, processor;
  };
  std::vector<Samples> samples(cases.size());
  for (int round = -warm_rounds; round < rounds; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double start = processor_ms();
      const double ms = cases[i].run();
      const double processor = processor_ms() - start;
      if (round < 0) continue;
      samples[i].ms.push_back(ms);
      samples[i].processor.push_back(processor);
    }
  }
  std::vector<Figures> figures;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    figures.push_back({cases[i], summarise(samples[i].ms), summarise(samples[i].processor)});
  }
  return figures;
}

double wall_ms(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace quincunx::bench
