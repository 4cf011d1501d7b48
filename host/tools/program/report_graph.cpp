// SPDX-License-Identifier: MIT
#include "tools/program/report_graph.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace quincunx::tools {

namespace {

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
