// SPDX-License-Identifier: MIT
#include "bench/traces/recorded_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

namespace quincunx::traces {
namespace {

std::vector<std::string> cells(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> list;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    list.push_back(cell);
  return list;
}

// Columns by name; -1 where there is none.
struct Columns {
  int gpu_ms = -1;
  int area_fraction = -1;
  int cpu_ms = -1;

  explicit Columns(const std::vector<std::string>& header) {
    const auto find = [&header](const char* name) {
      const auto at = std::find(header.begin(), header.end(), name);
      return at == header.end() ? -1 : static_cast<int>(at - header.begin());
    };
    gpu_ms = find("gpu_ms");
    area_fraction = find("area_fraction");
    cpu_ms = find("cpu_ms");
  }
};

// A positive finite number, or nothing (0).
double positive(const std::vector<std::string>& row, int column) {
  if (column < 0 || column >= static_cast<int>(row.size())) return 0;
  const std::string& text = row[static_cast<std::size_t>(column)];
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size() && std::isfinite(value) && value > 0 ? value : 0;
}

}  // namespace

Result<LoadTrace> recorded_trace(const std::string& name, const std::string& csv,
                                 const Recording& recording) {
  if (!(recording.target_ms > 0) || !(recording.fixed_part >= 0 && recording.fixed_part <= 0.9)) {
    return Status::invalid(
        fmt::format("target_ms is {} and fixed_part {}; the first must be above 0, the second in [0, 0.9]",
                    recording.target_ms, recording.fixed_part));
  }
  std::stringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const Columns columns(cells(line));
  if (columns.gpu_ms < 0 || columns.area_fraction < 0) {
    return Status::invalid(name + ": line 1 must name the columns gpu_ms and area_fraction");
  }
  LoadTrace trace{.name = name, .frames = {}};
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    const std::vector<std::string> row = cells(line);
    const double gpu = positive(row, columns.gpu_ms) / recording.target_ms;
    const double area = positive(row, columns.area_fraction);
    if (gpu <= 0 || area <= 0) {
      return Status::invalid(
          fmt::format("{}: line {} needs a positive gpu_ms and area_fraction", name, number));
    }
    const double level = gpu / (recording.fixed_part + (1 - recording.fixed_part) * area);
    trace.frames.push_back({.fixed = level * recording.fixed_part,
                            .scaling = level * (1 - recording.fixed_part),
                            .cpu = positive(row, columns.cpu_ms) / recording.target_ms});
  }
  if (trace.frames.empty()) return Status::invalid(name + ": no frames after the header");
  return trace;
}

}  // namespace quincunx::traces
