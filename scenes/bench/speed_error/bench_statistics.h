// SPDX-License-Identifier: MIT
// The statistics of repeated measurements. Pure; thread-safe.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

using Samples = std::vector<double>;
using Rounds = std::vector<Samples>;  // the samples of each round

// Return figures of at least one sample: the median, which is the mean of the middle two where the count is even; the
// mean; its standard error, of at least two samples; the nearest rank that at least 95 % do not exceed.
double median_of(Samples samples);
double mean_of(const Samples& samples);
double deviation_of_mean(const Samples& samples);
double p95_of(Samples samples);

// Returns median and p95 of all samples, and the interval from 1000 resamplings of whole rounds with a fixed seed (a
// cluster bootstrap: a disturbance is shared by all samples of a round). Empty rounds do not count; all is zero where
// there is no sample.
Spread spread_of(const Rounds& rounds);

// Returns the least of the medians of rounds, which other programs disturbed least. At least one sample.
double least_median_of(const Rounds& rounds);

// Returns the spread of the quotients of the rounds' medians. Both have the same number of rounds, none empty.
Spread ratio_of(const Rounds& rounds, const Rounds& unit);

// Returns half the interval as part of the median: medians of repetitions differ by about that.
double relative_noise(const Spread& spread);

struct Point {
  double cost = 0;
  double error = 0;
};
// Returns for each point whether no other is at least as good in both figures and better in one; less is better. Equal
// points are all on the front.
std::vector<bool> pareto_front(std::span<const Point> points);

// Fills Row::front of all rows, each among the methods of its scene and scale.
void mark_fronts(std::vector<Row>& rows);

// The errors that fronts are made for: "psnr", "ssim", "flip", ...
struct ErrorMeasure {
  const char* name;   // field of Quality
  const char* label;  // "FLIP"
  bool higher_is_better;
  // A change counts as one from this much: absolute plus part of the old value.
  double absolute, relative;
  double (*value)(const Quality& quality);  // NaN where there is none

  double threshold(double before) const {
    return absolute + (relative > 0 ? relative * std::abs(before) : 0);  // `before` may be infinite
  }
};
std::span<const ErrorMeasure> error_measures();

}  // namespace quincunx::bench
