// SPDX-License-Identifier: MIT
#include "quincunx/control/cost_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "quincunx/control/resolution_controller.h"
#include "ranges.h"

namespace quincunx {
namespace {

constexpr double kLongestHalfLife = 1e9;
constexpr double kMostWeight = 20;  // a mean over more frames would follow a changed scene too slowly

bool within(double value, double most) {
  return value > 0 && value <= most;
}

int bin_of(double area) {
  return static_cast<int>(area * CostTable::kBinsPerArea);
}

double work(double area, double fixed_part) {
  return fixed_part + (1 - fixed_part) * area;
}

}  // namespace

Result<CostTable> CostTable::create(double half_life_frames) {
  if (!(half_life_frames >= 1 && half_life_frames <= kLongestHalfLife)) {
    return Status::invalid(
        fmt::format("half_life_frames is {}; it must lie in [1, {}]", half_life_frames, kLongestHalfLife));
  }
  return CostTable(half_life_frames);
}

double CostTable::decay(double frames) const {
  return std::exp2(-frames / half_life_frames_);
}

const CostTable::Entry* CostTable::find(int bin) const {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), bin,
                                   [](const Entry& entry, int wanted) { return entry.bin < wanted; });
  return at != entries_.end() && at->bin == bin ? &*at : nullptr;
}

Status CostTable::record(std::uint64_t frame, double area_fraction, double gpu_ms) {
  Ranges ranges;
  ranges.lies_in("area_fraction", area_fraction, 0, kMaxArea, Ends::kOpenLow);
  ranges.lies_in("gpu_ms", gpu_ms, 0, ResolutionController::kMaxMs, Ends::kOpenLow);
  if (!ranges.status().ok()) return ranges.status();
  if (started_ && frame < frame_) {
    return Status::invalid(fmt::format("frame is {}, below the last one, {}", frame, frame_));
  }
  const double passed = started_ ? static_cast<double>(frame - frame_) : 0;
  for (Entry& entry : entries_)
    entry.age += passed;
  frame_ = frame;
  started_ = true;
  const int bin = bin_of(area_fraction);
  if (find(bin) == nullptr) {
    const auto place =
        std::find_if(entries_.begin(), entries_.end(), [bin](const Entry& e) { return e.bin > bin; });
    entries_.insert(place, Entry{.bin = bin});
  }
  Entry& entry = entries_[static_cast<std::size_t>(find(bin) - entries_.data())];
  const double before = std::min(entry.weight * decay(entry.age), kMostWeight - 1);
  entry.weight = before + 1;
  entry.area += (area_fraction - entry.area) / entry.weight;
  entry.gpu_ms += (gpu_ms - entry.gpu_ms) / entry.weight;
  entry.age = 0;
  return {};
}

double CostTable::confidence(double area_fraction) const {
  if (!within(area_fraction, kMaxArea)) return 0;
  const Entry* entry = find(bin_of(area_fraction));
  return entry == nullptr ? 0 : decay(entry->age);
}

std::optional<double> CostTable::predict(double area_fraction, double fixed_part) const {
  if (entries_.empty() || !within(area_fraction, kMaxArea)) return std::nullopt;
  const Entry* own = find(bin_of(area_fraction));
  const auto moved = [&](const Entry& entry) {
    return std::min(entry.gpu_ms * work(area_fraction, fixed_part) / work(entry.area, fixed_part),
                    ResolutionController::kMaxMs);
  };
  double sum = 0;
  double weights = 0;
  // Ages count from the youngest, so that a table that is old as a whole still has weights.
  double youngest = entries_.front().age;
  for (const Entry& entry : entries_)
    youngest = std::min(youngest, entry.age);
  for (const Entry& entry : entries_) {
    const double weight = decay(entry.age - youngest);
    sum += weight * moved(entry);
    weights += weight;
  }
  const double trust = own == nullptr ? 0 : decay(own->age);
  return trust * (own == nullptr ? 0 : moved(*own)) + (1 - trust) * sum / weights;
}

std::optional<double> CostTable::fixed_part() const {
  constexpr double kLeastSpan = 0.25;
  if (entries_.empty() || entries_.back().area - entries_.front().area < kLeastSpan) return std::nullopt;
  double weights = 0;
  double area = 0;
  double time = 0;
  for (const Entry& entry : entries_) {
    weights += decay(entry.age);
    area += decay(entry.age) * entry.area;
    time += decay(entry.age) * entry.gpu_ms;
  }
  if (!(weights > 0)) return std::nullopt;
  area /= weights;
  time /= weights;
  double covariance = 0;
  double variance = 0;
  for (const Entry& entry : entries_) {
    covariance += decay(entry.age) * (entry.area - area) * (entry.gpu_ms - time);
    variance += decay(entry.age) * (entry.area - area) * (entry.area - area);
  }
  const double slope = covariance / variance;
  const double at_output = time + slope * (1 - area);
  if (!(at_output > 0)) return std::nullopt;
  return std::clamp(1 - slope / at_output, 0.0, 0.9);
}

std::string CostTable::to_json() const {
  nlohmann::ordered_json root = {{"quincunx_cost_table", 1}, {"half_life_frames", half_life_frames_}};
  root["entries"] = nlohmann::ordered_json::array();
  for (const Entry& entry : entries_) {
    root["entries"].push_back({{"area_fraction", entry.area},
                               {"gpu_ms", entry.gpu_ms},
                               {"weight", entry.weight},
                               {"age_frames", entry.age}});
  }
  return root.dump(2) + "\n";
}

Result<CostTable> CostTable::from_json(const std::string& text) {
  try {
    const nlohmann::json root = nlohmann::json::parse(text);
    if (root.at("quincunx_cost_table") != 1) return Status::invalid("cost table: only version 1 can be read");
    Result<CostTable> table = create(root.at("half_life_frames").get<double>());
    if (!table.ok()) return Status::invalid("cost table: " + table.status().message());
    for (const nlohmann::json& item : root.at("entries")) {
      Entry entry{.area = item.at("area_fraction").get<double>(),
                  .gpu_ms = item.at("gpu_ms").get<double>(),
                  .weight = item.at("weight").get<double>(),
                  .age = item.at("age_frames").get<double>()};
      entry.bin = within(entry.area, kMaxArea) ? bin_of(entry.area) : -1;
      const bool sorted = table->entries_.empty() || entry.bin > table->entries_.back().bin;
      if (entry.bin < 0 || !sorted || !within(entry.gpu_ms, ResolutionController::kMaxMs) ||
          !within(entry.weight, kMostWeight) || !(entry.age >= 0 && std::isfinite(entry.age))) {
        return Status::invalid("cost table: bad entry " + item.dump());
      }
      table->entries_.push_back(entry);
    }
    return table;
  } catch (const nlohmann::json::exception& error) {
    const std::string why = error.what();  // "[json.exception.parse_error.101] parse error at line 1, ..."
    return Status::invalid("cost table: it must be the JSON that a table gave, and is not: " +
                           why.substr(why.find("] ") + 2));
  }
}

}  // namespace quincunx
