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
  row.device_ms = 0;
  for (int i = 0; i < report.pass_count; ++i)
    row.device_ms += std::max(report.passes[i].ms, 0.0);
}

}  // namespace

std::vector<PassStatistics> pass_statistics(std::span<const FrameReport> reports) {
  struct Samples {
    std::vector<double> ms;
    std::vector<std::uint64_t> bytes;
  };
  std::vector<std::string> order;
  std::map<std::string, Samples> samples;
  for (const FrameReport& report : reports) {
    for (int i = 0; i < report.pass_count; ++i) {
      const PassReport& pass = report.passes[i];
      if (!samples.contains(pass.kernel)) order.emplace_back(pass.kernel);
      samples[pass.kernel].ms.push_back(pass.ms);
      samples[pass.kernel].bytes.push_back(pass.bytes);
    }
  }
  std::vector<PassStatistics> statistics;
  for (const std::string& kernel : order) {
    statistics.push_back(statistics_of(kernel, "OpenCL event", samples[kernel].ms, samples[kernel].bytes));
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
