// SPDX-License-Identifier: MIT
#include "tools/program/pass_statistics.h"

#include <algorithm>
#include <map>
#include <string>

namespace quincunx::tools {
namespace {

void add_report(FrameRow& row, const FrameReport& report) {
  row.render = report.render;
  row.ratio = report.ratio;
  row.used_previous = report.used_previous;
  row.non_finite_pixels = report.non_finite_pixels;
  const std::span passes(report.passes.data(), static_cast<std::size_t>(report.pass_count));
  if (std::any_of(passes.begin(), passes.end(), [](const PassReport& pass) { return pass.ms < 0; })) return;
  row.device_ms = 0;
  for (const PassReport& pass : passes)
    row.device_ms += pass.ms;
}

}  // namespace

std::vector<PassStatistics> pass_statistics(std::span<const FrameReport> reports, PassTimer timer) {
  struct Samples {
    std::vector<double> ms;
    std::vector<std::uint64_t> bytes;
  };
  std::vector<std::string> order;
  std::map<std::string, Samples> samples;
  for (const FrameReport& report : reports) {
    for (int i = 0; i < report.pass_count; ++i) {
      const PassReport& pass = report.passes[i];
      const std::string name = name_of(pass);
      if (!samples.contains(name)) order.push_back(name);
      samples[name].ms.push_back(pass.ms);
      samples[name].bytes.push_back(pass.bytes);
    }
  }
  std::vector<PassStatistics> statistics;
  for (const std::string& kernel : order) {
    statistics.push_back(statistics_of(kernel, name_of(timer), samples[kernel].ms, samples[kernel].bytes));
    if (statistics.back().count == 0) statistics.back().clock = name_of(PassTimer::kNone);
  }
  return statistics;
}

void add_measured(std::span<FrameRow> rows, std::span<const FrameReport> reports) {
  auto measured = reports.begin();
  for (FrameRow& row : rows) {
    while (measured != reports.end() && static_cast<std::int64_t>(measured->frame_index) < row.index)
      ++measured;
    if (measured == reports.end()) return;
    if (static_cast<std::int64_t>(measured->frame_index) == row.index) add_report(row, *measured);
  }
}

}  // namespace quincunx::tools
