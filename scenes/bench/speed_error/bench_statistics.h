// SPDX-License-Identifier: MIT
// The statistics of repeated measurements. Pure; thread-safe.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

using Samples = std::vector<double>;
using Rounds = std::vector<Samples>;  // the samples of each round

// The mean of the middle two where the count is even. At least one sample.
double median_of(Samples samples);

double mean_of(const Samples& samples);            // at least one sample
double deviation_of_mean(const Samples& samples);  // standard error of the mean; at least two samples

double p95_of(Samples samples);  // nearest rank: the smallest that at least 95 % do not exceed

// Median and p95 of all samples; the interval from 1000 resamplings of whole rounds (a cluster bootstrap, for
// what disturbs a round disturbs all of its samples; fixed seed). Empty rounds do not count; all zero where
// there is no sample.
Spread spread_of(const Rounds& rounds);

// The least of the medians of rounds: that which other programs disturbed least. At least one sample.
double least_median_of(const Rounds& rounds);

// Returns the spread of the quotients of the rounds' medians. Both have the same number of rounds, none empty.
Spread ratio_of(const Rounds& rounds, const Rounds& unit);

// The medians of repetitions differ by about this part of themselves: half the interval.
double relative_noise(const Spread& spread);

// For each point whether no other is at least as good in both and better in one; both are better when less.
// Equal points are all on the front.
struct Point {
  double cost = 0;
  double error = 0;
};
std::vector<bool> pareto_front(std::span<const Point> points);

// Fills Row::front of all rows, each among the methods of its scene and scale.
void mark_fronts(std::vector<Row>& rows);

// The errors that fronts are made for: "psnr", "ssim", "flip", ...
struct ErrorMeasure {
  const char* name;   // field of Quality
  const char* label;  // "FLIP"
  bool higher_is_better;
  double (*value)(const Quality& quality);  // NaN where there is none
};
std::span<const ErrorMeasure> error_measures();

}  // namespace quincunx::bench
