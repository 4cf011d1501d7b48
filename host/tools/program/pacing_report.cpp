// SPDX-License-Identifier: MIT
#include "tools/program/pacing_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tools/program/run_report.h"

namespace quincunx::tools {
namespace {

constexpr double kMsPerSecond = 1000;

double area_of(const PacingRun& run, const PacedFrame& frame) {
  return static_cast<double>(frame.render.area()) / static_cast<double>(run.output.area());
}

void add_area(PacingSummary& summary, double area, double share) {
  summary.mean_area += area * share;
  summary.least_area = std::min(summary.least_area, area);
  summary.largest_area = std::max(summary.largest_area, area);
}

std::string percent_faster(const PacingSummary& summary, const PacingSummary& other) {
  if (summary.mean_busy_ms <= 0) return "-";
  return fmt::format("{:.2f}x", other.mean_busy_ms / summary.mean_busy_ms);
}

void add_row(std::string& text, const PacingRun& run, const PacingSummary& first) {
  const PacingSummary row = summary_of(run);
  text += fmt::format("  {:<14} {:>8.2f} {:>8} {:>9} {:>8.1f} {:>8.1f} {:>7} {:>7.3f} {:>10.1f} {:>8}\n",
                      run.controller, row.achieved_fps, row.dropped, row.dropped_at_start, row.mean_busy_ms,
                      row.p95_busy_ms, row.over_target, row.mean_area, row.changes_per_second,
                      percent_faster(first, row));
}

void add_graphs(std::string& text, const PacingRun& run) {
  std::vector<double> scales;
  std::vector<double> busy;
  for (const PacedFrame& frame : run.frames) {
    scales.push_back(std::sqrt(area_of(run, frame)));
    busy.push_back(frame.busy_ms);
  }
  text += "\nScale over the frames (root of the area fraction)\n" + ratio_graph(scales);
  text += "\nBusy time over the frames, ms\n" + ratio_graph(busy);
}

// Adds, for a controller that chooses the method, how many frames had which, and when it changed.
void add_methods(std::string& text, const PacingRun& run) {
  std::map<std::string, int> frames;
  for (const PacedFrame& frame : run.frames) {
    if (!frame.method.empty()) ++frames[frame.method];
  }
  if (frames.empty()) return;
  text += "\nMethods: frames shown of each\n";
  for (const auto& [method, count] : frames)
    text += fmt::format("  {:<22} {:>6}\n", method, count);
  text += fmt::format("Changes of method: {}\n", run.method_changes.size());
  for (const MethodChange& change : run.method_changes)
    text += fmt::format("  frame {:>5}: {} -> {}\n", change.frame, change.from, change.to);
  text += "At the end of the run\n" + run.reasons;
}

constexpr int kColumns = 72;
constexpr int kRows = 8;
constexpr double kFlat = 1e-6;  // below this spread a single row says it all

std::vector<double> column_means(std::span<const double> values) {
  const int total = static_cast<int>(values.size());
  const int columns = std::min(total, kColumns);
  std::vector<double> means(columns);
  for (int i = 0; i < columns; ++i) {
    const int first = static_cast<int>(static_cast<std::int64_t>(i) * total / columns);
    const int end = static_cast<int>(static_cast<std::int64_t>(i + 1) * total / columns);
    for (int j = first; j < end; ++j)
      means[i] += values[j] / (end - first);
  }
  return means;
}

}  // namespace

PacingSummary summary_of(const PacingRun& run) {
  PacingSummary summary;
  if (run.frames.empty()) return summary;
  const auto count = static_cast<double>(run.frames.size());
  const double refresh_ms = kMsPerSecond / run.target_fps;
  std::vector<double> busy;
  int changes = 0;
  summary.least_area = summary.largest_area = area_of(run, run.frames.front());
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const PacedFrame& frame = run.frames[i];
    busy.push_back(frame.busy_ms);
    summary.dropped += frame.missed;
    if (frame.shown_ms <= kMsPerSecond) summary.dropped_at_start += frame.missed;
    summary.mean_busy_ms += frame.busy_ms / count;
    summary.over_target += frame.busy_ms > refresh_ms ? 1 : 0;
    if (i > 0 && frame.render != run.frames[i - 1].render) ++changes;
    add_area(summary, area_of(run, frame), 1 / count);
  }
  const PassStatistics statistics = statistics_of("", "", busy);
  summary.median_busy_ms = statistics.median_ms;
  summary.p95_busy_ms = statistics.p95_ms;
  const double seconds = (run.frames.back().shown_ms - run.frames.front().shown_ms) / kMsPerSecond;
  if (seconds > 0) {
    summary.achieved_fps = (count - 1) / seconds;
    summary.changes_per_second = changes / seconds;
    summary.method_changes_per_second = static_cast<double>(run.method_changes.size()) / seconds;
  }
  return summary;
}

std::string pacing_text(const std::vector<PacingRun>& runs) {
  if (runs.empty()) return {};
  const PacingRun& run = runs.front();
  std::string text =
      fmt::format("\nPacing: target {:.2f} frames a second ({:.2f} ms), {} buffers\n  busy time: {}\n",
                  run.target_fps, kMsPerSecond / run.target_fps, run.buffers, run.measured_by);
  text += fmt::format("  {:<14} {:>8} {:>8} {:>9} {:>8} {:>8} {:>7} {:>7} {:>10} {:>8}\n", "", "achieved",
                      "dropped", "in 1st s", "busy ms", "p95 ms", "over", "pixels", "changes/s", "speed-up");
  const PacingSummary first = summary_of(run);
  for (const PacingRun& each : runs)
    add_row(text, each, first);
  add_methods(text, run);
  add_graphs(text, run);
  return text;
}

std::string ratio_graph(std::span<const double> ratios) {
  if (ratios.empty()) return {};
  const std::vector<double> means = column_means(ratios);
  const auto [low_at, high_at] = std::minmax_element(means.begin(), means.end());
  const double low = *low_at;
  const double high = *high_at;
  const int rows = high - low < kFlat ? 1 : kRows;
  const double step = rows == 1 ? 1 : (high - low) / (rows - 1);
  std::string text;
  for (int row = rows - 1; row >= 0; --row) {
    text += fmt::format("  {:>5.3f} |", low + row * step);
    std::string marks;
    for (const double mean : means)
      marks += std::lround((mean - low) / step) == row ? '*' : ' ';
    marks.erase(marks.find_last_not_of(' ') + 1);
    text += marks + "\n";
  }
  text += fmt::format("  {:>5} +{}\n", "", std::string(means.size(), '-'));
  return text;
}

}  // namespace quincunx::tools
