// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "bench/speed_error/bench_statistics.h"

namespace quincunx::bench {
namespace {

constexpr double kSeventy = 0.7;
constexpr double kNearSeventy = 0.05;

std::vector<double> scales_of(const BenchResult& result) {
  std::set<double> scales;
  for (const Row& row : result.rows)
    scales.insert(row.scale);
  return {scales.begin(), scales.end()};
}

double squared_error_of(double decibels) {
  return std::pow(10, -decibels / 10);
}

double decibels_of(const Samples& squared_errors) {
  return -10 * std::log10(mean_of(squared_errors));
}

MethodMean mean_over_scenes(const BenchResult& result, double scale, const std::string& method) {
  Samples flip, squared_error, ms, cost;
  std::array<Samples, kRegions> regions;
  for (const Row& row : result.rows) {
    if (row.scale != scale || row.method != method) continue;
    flip.push_back(row.quality.flip);
    squared_error.push_back(squared_error_of(row.quality.psnr));
    for (std::size_t i = 0; i < kRegions; ++i) {
      if (row.quality.region_psnr[i]) regions[i].push_back(squared_error_of(*row.quality.region_psnr[i]));
    }
    ms.push_back(row.speed.ms.median);
    cost.push_back(cost_of(result.machine, row).median);
  }
  MethodMean mean{.scale = scale,
                  .method = method,
                  .flip = mean_of(flip),
                  .psnr = decibels_of(squared_error),
                  .region_psnr = {},
                  .ms = mean_of(ms),
                  .cost = mean_of(cost)};
  for (std::size_t i = 0; i < kRegions; ++i) {
    if (!regions[i].empty()) mean.region_psnr[i] = decibels_of(regions[i]);
  }
  return mean;
}

const FrameRow* frame_at(const BenchResult& result, const std::string& scene, double scale) {
  const auto found = std::find_if(result.frames.begin(), result.frames.end(), [&](const FrameRow& row) {
    return row.scene == scene && row.scale == scale;
  });
  return found == result.frames.end() ? nullptr : &*found;
}

std::string scenes_text(const BenchResult& result) {
  return result.scenes.size() == 1 ? result.scenes.front().name
                                   : fmt::format("mean of {} scenes", result.scenes.size());
}

void add_best(const BenchResult& result, std::vector<Finding>& findings) {
  const double scale = headline_scale(result);
  std::vector<MethodMean> means = method_means(result);
  std::erase_if(means, [scale](const MethodMean& mean) { return mean.scale != scale; });
  const auto least = std::min_element(
      means.begin(), means.end(), [](const MethodMean& a, const MethodMean& b) { return a.flip < b.flip; });
  findings.push_back(
      {fmt::format("{:.4f}", least->flip),
       fmt::format("FLIP of {}: the least error at scale {}", least->method, scale),
       fmt::format("{}; PSNR {:.2f} dB, for {:.2f} ms: {:.2f} times a plain copy of the picture.",
                   scenes_text(result), least->psnr, least->ms, least->cost)});
  const auto bilinear = std::find_if(means.begin(), means.end(),
                                     [](const MethodMean& mean) { return mean.method == "bilinear"; });
  if (bilinear == means.end() || bilinear == least) return;
  findings.push_back({fmt::format("{:+.2f} dB", least->psnr - bilinear->psnr),
                      fmt::format("over bilinear at scale {}", scale),
                      fmt::format("Bilinear has {:.2f} dB and FLIP {:.4f} for {:.2f} ms, {:.2f} copies.",
                                  bilinear->psnr, bilinear->flip, bilinear->ms, bilinear->cost)});
}

void add_frame_time(const BenchResult& result, std::vector<Finding>& findings) {
  const auto seventy = seventy_percent(result);
  if (!seventy) return;
  findings.push_back(
      {fmt::format("{:.0f} %", 100 * seventy->wall),
       fmt::format("of the frame time remains at scale {}", seventy->scale),
       fmt::format(
           "Drawn, handed over and resolved by {}, beside scale 1; {}. Of the processor time, {:.0f} % "
           "remain.",
           result.frames.front().method, scenes_text(result), 100 * seventy->processor)});
}

void add_share(const BenchResult& result, std::vector<Finding>& findings) {
  const double scale = headline_scale(result);
  Samples shares;
  for (const FrameRow& row : result.frames) {
    if (row.scale == scale) shares.push_back(row.resolve_ms.median / row.frame_ms.median);
  }
  if (shares.empty()) return;
  findings.push_back(
      {fmt::format("{:.0f} %", 100 * mean_of(shares)),
       fmt::format("of the frame is the resolve at scale {}", scale),
       fmt::format("{} and the present pass; {}.", result.frames.front().method, scenes_text(result))});
}

void add_soundness(const BenchResult& result, std::vector<Finding>& findings) {
  std::int64_t non_finite = 0;
  for (const Row& row : result.rows)
    non_finite += row.quality.non_finite;
  findings.push_back({fmt::format("{}", non_finite), "non-finite pixels",
                      fmt::format("in {} combinations of scene, scale and method.", result.rows.size())});
  const TypicalNoise noise = typical_noise(result);
  findings.push_back(
      {fmt::format("±{:.1f} %", 100 * noise.cost), "noise of the costs",
       fmt::format(
           "Half of them, in copies by {}, are known better than that (95 % interval over {} rounds); of the "
           "milliseconds, ±{:.1f} %.",
           cost_clock(result.machine), result.conditions.rounds, 100 * noise.ms)});
}

}  // namespace

double headline_scale(const BenchResult& result) {
  const std::vector<double> scales = scales_of(result);
  return *std::min_element(scales.begin(), scales.end(), [](double a, double b) {
    return std::abs(a - kSeventy) < std::abs(b - kSeventy);
  });
}

std::vector<MethodMean> method_means(const BenchResult& result) {
  std::vector<MethodMean> means;
  for (const double scale : scales_of(result)) {
    std::vector<Point> points;
    for (const MethodRow& method : result.methods) {
      means.push_back(mean_over_scenes(result, scale, method.name));
      points.push_back({means.back().cost, means.back().flip});
    }
    const std::vector<bool> front = pareto_front(points);
    for (std::size_t i = 0; i < front.size(); ++i)
      means[means.size() - front.size() + i].on_front = front[i];
  }
  return means;
}

std::optional<SeventyPercent> seventy_percent(const BenchResult& result) {
  if (result.rows.empty()) return std::nullopt;
  const double scale = headline_scale(result);
  if (std::abs(scale - kSeventy) > kNearSeventy) return std::nullopt;
  Samples wall, processor;
  for (const SceneRow& scene : result.scenes) {
    const FrameRow* part = frame_at(result, scene.name, scale);
    const FrameRow* whole = frame_at(result, scene.name, 1);
    if (part == nullptr || whole == nullptr) return std::nullopt;
    wall.push_back(part->frame_ms.median / whole->frame_ms.median);
    processor.push_back(part->frame_processor_ms.median / whole->frame_processor_ms.median);
  }
  return SeventyPercent{scale, mean_of(wall), mean_of(processor)};
}

TypicalNoise typical_noise(const BenchResult& result) {
  Samples ms, cost;
  for (const Row& row : result.rows) {
    ms.push_back(relative_noise(row.speed.ms));
    cost.push_back(relative_noise(cost_of(result.machine, row)));
  }
  return ms.empty() ? TypicalNoise{} : TypicalNoise{.ms = median_of(ms), .cost = median_of(cost)};
}

std::vector<Finding> findings_of(const BenchResult& result) {
  std::vector<Finding> findings;
  if (result.rows.empty()) return findings;
  add_best(result, findings);
  add_frame_time(result, findings);
  add_share(result, findings);
  add_soundness(result, findings);
  return findings;
}

std::string text_of(const BenchResult& result) {
  std::string text =
      fmt::format("{}, {}x{}, {} measured frames in each of {} rounds\n{} | {}\n", scenes_text(result),
                  result.conditions.output.width, result.conditions.output.height, result.conditions.frames,
                  result.conditions.rounds, result.machine.cl_device, result.machine.gl_renderer);
  text +=
      fmt::format("\n{:<6} {:<24} {:>8} {:>8} {:>9} {:>8}  {:>8} {:>8} {:>8} {:>8} {:>8}\n", "scale",
                  "method", "FLIP", "PSNR dB", "ms", "copies", "thin", "behind", "disoccl", "edge", "rest");
  for (const MethodMean& mean : method_means(result)) {
    text += fmt::format("{:<6} {:<24} {:>8.4f} {:>8.2f} {:>9.3f} {:>8.2f}{}", mean.scale, mean.method,
                        mean.flip, mean.psnr, mean.ms, mean.cost, mean.on_front ? " *" : "  ");
    for (const auto& psnr : mean.region_psnr)
      text += psnr ? fmt::format("{:>8.2f} ", *psnr) : fmt::format("{:>8} ", "-");
    text.back() = '\n';
  }
  text += fmt::format(
      "* no other method is cheaper and better; copies by {}; the last five are PSNR, dB, of regions\n\n",
      cost_clock(result.machine));
  for (const Finding& finding : findings_of(result))
    text += fmt::format("{:>9}  {}. {}\n", finding.figure, finding.heading, finding.sentence);
  return text;
}

}  // namespace quincunx::bench
