// SPDX-License-Identifier: MIT
// The headlines of a result, and its table, in words. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

// A result for the reader to take home: a heading of a few words with a figure, and one sentence.
struct Finding {
  std::string figure;   // "0.041"
  std::string heading;  // "least error at scale 0.71"
  std::string sentence;
};
std::vector<Finding> findings_of(const BenchResult& result);

// The scale that headlines speak of: the one nearest to 0.7. At least one row.
double headline_scale(const BenchResult& result);

// Means over all scenes of one method at one scale.
struct MethodMean {
  double scale = 1;
  std::string method;
  double flip = 0;
  double psnr = 0;            // dB, from the mean squared error
  RegionFigures region_psnr;  // the same, over the scenes that have the region
  double ms = 0;
  double cost = 0;        // copies, by the clock that holds
  bool on_front = false;  // on the front of FLIP over cost
};
std::vector<MethodMean> method_means(const BenchResult& result);

// The frame time at about 0.7 as part of that at 1, the mean over the scenes; nothing where one is missing.
struct SeventyPercent {
  double scale = 0;
  double wall = 0;
  double processor = 0;
};
std::optional<SeventyPercent> seventy_percent(const BenchResult& result);

// Half the width of a median's 95 % interval as part of the median: the median over all rows.
struct TypicalNoise {
  double ms = 0;
  double cost = 0;  // copies, by the clock that holds
};
TypicalNoise typical_noise(const BenchResult& result);

std::string text_of(const BenchResult& result);  // findings and method_means() for a terminal

}  // namespace quincunx::bench
