// SPDX-License-Identifier: MIT
#include "bench/tune/tune_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quincunx::bench {
namespace {

// Rows, parts of rows, and tiles of small items, wide and high.
constexpr WorkShape kShapes[] = {
    {.group_width = 1, .group_height = 4, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 1, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 16, .pixels_per_item = 0},
    {.group_width = 1, .group_height = 4, .pixels_per_item = 256},
    {.group_width = 8, .group_height = 8, .pixels_per_item = 1},
    {.group_width = 8, .group_height = 8, .pixels_per_item = 32},
    {.group_width = 16, .group_height = 8, .pixels_per_item = 1},
    {.group_width = 16, .group_height = 8, .pixels_per_item = 16},
    {.group_width = 32, .group_height = 4, .pixels_per_item = 1},
    {.group_width = 64, .group_height = 1, .pixels_per_item = 1},
    {.group_width = 64, .group_height = 4, .pixels_per_item = 1},
};

constexpr double kRefused = std::numeric_limits<double>::infinity();

Samples quotients(const Samples& times, const Samples& plain) {
  Samples all;
  for (std::size_t round = 0; round < std::min(times.size(), plain.size()); ++round)
    all.push_back(times[round] / plain[round]);
  return all;
}

}  // namespace

std::vector<WorkShape> shapes_to_try(const WorkShape& plain, std::size_t most_items) {
  std::vector<WorkShape> shapes = {plain};
  for (const WorkShape& shape : kShapes) {
    const auto items = static_cast<std::size_t>(shape.group_width * shape.group_height);
    if (shape != plain && items <= most_items) shapes.push_back(shape);
  }
  return shapes;
}

std::map<std::string, std::vector<double>> quotients_of(const std::vector<ShapeTimes>& cases) {
  std::map<std::string, std::vector<Samples>> pooled;  // a refused shape has too few
  std::map<std::string, std::size_t> complete;
  for (const ShapeTimes& shapes : cases) {
    for (const auto& [kernel, plain] : shapes.front()) {
      auto& all = pooled[kernel];
      all.resize(shapes.size());
      complete[kernel] += plain.size();
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto times = shapes[i].find(kernel);
        if (times == shapes[i].end()) continue;
        const Samples more = quotients(times->second, plain);
        all[i].insert(all[i].end(), more.begin(), more.end());
      }
    }
  }
  std::map<std::string, std::vector<double>> result;
  for (const auto& [kernel, shapes] : pooled) {
    for (const Samples& samples : shapes) {
      const bool refused = samples.empty() || samples.size() < complete[kernel];
      result[kernel].push_back(refused ? kRefused : median_of(samples));
    }
  }
  return result;
}

DeviceProfile choose_profile(const std::vector<WorkShape>& shapes,
                             const std::map<std::string, std::vector<double>>& quotients) {
  const auto best = [](const std::vector<double>& of_shapes) {
    return static_cast<std::size_t>(std::min_element(of_shapes.begin(), of_shapes.end()) - of_shapes.begin());
  };
  DeviceProfile profile;
  std::vector<double> logarithms(shapes.size());
  for (const auto& [kernel, of_shapes] : quotients) {
    profile.passes[kernel] = shapes[best(of_shapes)];
    for (std::size_t i = 0; i < shapes.size(); ++i)
      logarithms[i] += std::log(of_shapes[i]);
  }
  const std::size_t at = best(logarithms);
  const double mean = std::exp(logarithms[at] / static_cast<double>(quotients.size()));
  profile.shape = mean <= 1 - kLeastGain ? shapes[at] : shapes.front();
  return profile;
}

void keep_what_gains(DeviceProfile& profile, const WorkShape& plain, const std::vector<ShapeTimes>& again) {
  for (const auto& [kernel, of_both] : quotients_of(again)) {
    if (!(of_both[1] <= 1 - kLeastGain)) profile.passes[kernel] = plain;
  }
}

}  // namespace quincunx::bench
