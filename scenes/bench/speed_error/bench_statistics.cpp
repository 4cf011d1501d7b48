// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <ranges>
#include <type_traits>

namespace quincunx::bench {
namespace {

constexpr int kResamplings = 1000;
constexpr double kConfidence = 0.95;

// Returns a figure; NaN where there is none.
template <auto kField>
double figure(const Quality& quality) {
  std::optional<double> value;
  if constexpr (std::is_same_v<decltype(kField), Region>) {
    value = quality.region_psnr[static_cast<std::size_t>(kField)];
  } else {
    value = quality.*kField;
  }
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

constexpr ErrorMeasure kMeasures[] = {
    {"flip", "FLIP", false, 0.0005, 0.005, figure<&Quality::flip>},
    {"psnr", "PSNR, dB", true, 0.05, 0, figure<&Quality::psnr>},
    {"psnr_linear", "PSNR of linear light, dB", true, 0.05, 0, figure<&Quality::psnr_linear>},
    {"ssim", "SSIM", true, 0.001, 0, figure<&Quality::ssim>},
    {"error_p99", "99th percentile of error", false, 0.001, 0.01, figure<&Quality::error_p99>},
    {"relative_error", "relative HDR error", false, 1e-5, 0.02, figure<&Quality::relative_error>},
    {"worst_window", "worst 16×16 window", false, 0.002, 0.01, figure<&Quality::worst_window>},
    {"flicker", "flicker", false, 1e-5, 0.01, figure<&Quality::flicker>},
    {"ghosting", "ghosting", false, 0.0005, 0.01, figure<&Quality::ghosting>},
    {"psnr_thin", "PSNR of thin things, dB", true, 0.1, 0, figure<Region::kThin>},
    {"psnr_behind_thin", "PSNR behind thin things, dB", true, 0.1, 0, figure<Region::kBehindThin>},
    {"psnr_disoccluded", "PSNR of what is disoccluded, dB", true, 0.1, 0, figure<Region::kDisoccluded>},
    {"psnr_edge", "PSNR of edges of motion, dB", true, 0.1, 0, figure<Region::kEdge>},
    {"psnr_rest", "PSNR of the rest, dB", true, 0.1, 0, figure<Region::kRest>},
    {"psnr_focus", "PSNR in focus, dB", true, 0.1, 0, figure<&Quality::psnr_focus>},
    {"psnr_outside", "PSNR outside of the focus, dB", true, 0.1, 0, figure<&Quality::psnr_outside>},
};

Samples joined(const Rounds& rounds, std::span<const std::size_t> chosen) {
  Samples all;
  for (const std::size_t round : chosen)
    all.insert(all.end(), rounds[round].begin(), rounds[round].end());
  return all;
}

// Nearest rank of a sorted list.
double quantile(const Samples& sorted, double part) {
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(part * static_cast<double>(sorted.size())));
  return sorted[static_cast<std::size_t>(std::max<std::ptrdiff_t>(rank - 1, 0))];
}

}  // namespace

double median_of(Samples samples) {
  const std::size_t middle = samples.size() / 2;
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(middle);
  std::nth_element(samples.begin(), at, samples.end());
  if (samples.size() % 2 == 1) return *at;
  return (*at + *std::max_element(samples.begin(), at)) / 2;
}

double least_median_of(const Rounds& rounds) {
  double least = std::numeric_limits<double>::infinity();
  for (const Samples& round : rounds) {
    if (!round.empty()) least = std::min(least, median_of(round));
  }
  return least;
}

double mean_of(const Samples& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

double deviation_of_mean(const Samples& samples) {
  const double mean = mean_of(samples);
  double squares = 0;
  for (const double sample : samples)
    squares += (sample - mean) * (sample - mean);
  const auto count = static_cast<double>(samples.size());
  return std::sqrt(squares / (count - 1) / count);
}

double p95_of(Samples samples) {
  std::sort(samples.begin(), samples.end());
  return quantile(samples, 0.95);
}

Spread spread_of(const Rounds& all_rounds) {
  Rounds rounds = all_rounds;
  std::erase_if(rounds, [](const Samples& samples) { return samples.empty(); });
  if (rounds.empty()) return {};
  std::vector<std::size_t> chosen(rounds.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    chosen[i] = i;
  const Samples everything = joined(rounds, chosen);

  std::mt19937 random(1);
  Samples medians(kResamplings);
  for (double& median : medians) {
    for (std::size_t& round : chosen)
      round = random() % rounds.size();
    median = median_of(joined(rounds, chosen));
  }
  std::sort(medians.begin(), medians.end());
  return {.median = median_of(everything),
          .p95 = p95_of(everything),
          .low = quantile(medians, (1 - kConfidence) / 2),
          .high = quantile(medians, (1 + kConfidence) / 2)};
}

Spread ratio_of(const Rounds& rounds, const Rounds& unit) {
  Rounds ratios;
  for (std::size_t i = 0; i < rounds.size(); ++i)
    ratios.push_back({median_of(rounds[i]) / median_of(unit[i])});
  return spread_of(ratios);
}

double relative_noise(const Spread& spread) {
  return spread.median > 0 ? (spread.high - spread.low) / (2 * spread.median) : 0;
}

std::vector<bool> pareto_front(std::span<const Point> points) {
  std::vector<bool> front;
  front.reserve(points.size());
  for (const Point& one : points) {
    const bool beaten = std::any_of(points.begin(), points.end(), [&](const Point& other) {
      return other.cost <= one.cost && other.error <= one.error &&
             (other.cost < one.cost || other.error < one.error);
    });
    front.push_back(!beaten);
  }
  return front;
}

void mark_fronts(std::vector<Row>& rows) {
  for (Row& row : rows)
    row.front.clear();
  for (const ErrorMeasure& measure : kMeasures) {
    for (Row& row : rows) {
      std::vector<Point> points;
      std::size_t own = 0;
      for (const Row& other : rows) {
        if (other.scene != row.scene || other.scale != row.scale) continue;
        if (&other == &row) own = points.size();
        const double error = measure.value(other.quality);
        points.push_back({other.speed.ms.median, measure.higher_is_better ? -error : error});
      }
      if (!std::isnan(points[own].error) && pareto_front(points)[own]) row.front.emplace_back(measure.name);
    }
  }
}

std::span<const ErrorMeasure> error_measures() {
  return kMeasures;
}

const Spread& cost_of(const Machine& machine, const Row& row) {
  return machine.cl_on_processor ? row.speed.processor_ratio : row.speed.ratio;
}

const char* cost_clock(const Machine& machine) {
  return machine.cl_on_processor ? "processor time" : "OpenCL event time";
}

}  // namespace quincunx::bench
