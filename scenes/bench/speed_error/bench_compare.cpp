// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bench/speed_error/bench_statistics.h"

namespace quincunx::bench {
namespace {

// Costs are compared as natural logarithms of quotients: the least change that a reader would care about, and how many
// standard deviations must lie beyond it (with some hundred rows, three would give false alarms).
constexpr double kCostMatters = 0.03;
constexpr double kDeviations = 4;
constexpr double kDeviationsOfInterval = 1.96;  // half a 95 % interval
constexpr double kNormalMad = 1.4826;           // standard deviation / median absolute deviation
constexpr std::size_t kFewestRows = 3;          // rows of a method, for a mean with a spread of its own

std::string key_text(const Row& row) {
  return fmt::format("{}, {}, {}", row.scene, row.scale, row.method);
}

bool same_key(const Row& a, const Row& b) {
  return a.scene == b.scene && a.scale == b.scale && a.method == b.method;
}

const Row* find(const BenchResult& result, const Row& like) {
  const auto found = std::find_if(result.rows.begin(), result.rows.end(),
                                  [&](const Row& row) { return same_key(row, like); });
  return found == result.rows.end() ? nullptr : &*found;
}

class Comparer {
 public:
  Comparer(const BenchResult& before, const BenchResult& after) : before_(before), after_(after) {
    const auto device = [](const Machine& m) {
      return std::tie(m.processor, m.processors, m.cl_device, m.cl_platform, m.cl_driver);
    };
    same_machine_ = device(before.machine) == device(after.machine);
    if (!same_machine_) {
      comparison_.notes.push_back(fmt::format("Cost is not compared: the old result is of {} ({} {}).",
                                              before.machine.cl_device, before.machine.cl_platform,
                                              before.machine.cl_driver));
    }
    for (const auto& [which, machine] :
         {std::pair{"old", &before.machine}, std::pair{"new", &after.machine}}) {
      if (!same_machine_ || machine->load_before <= machine->processors) continue;
      comparison_.notes.push_back(
          fmt::format("The machine was busy when the {} result was measured (load {:.1f} on {} "
                      "processors): costs are noisy.",
                      which, machine->load_before, machine->processors));
    }
    if (before.machine.gl_version != after.machine.gl_version) {
      comparison_.notes.push_back(
          fmt::format("The frames may differ a little: they were drawn by {}.", before.machine.gl_version));
    }
  }

  Comparison run() {
    std::vector<CostChange> costs;
    for (const Row& row : after_.rows) {
      const Row* old = find(before_, row);
      if (old == nullptr) {
        comparison_.added.push_back(key_text(row));
        continue;
      }
      compare_errors(*old, row);
      if (same_machine_) costs.push_back(cost_change(*old, row));
    }
    for (const Row& row : before_.rows) {
      if (find(after_, row) == nullptr) comparison_.missing.push_back(key_text(row));
    }
    compare_costs(costs);
    compare_means(costs);
    std::stable_sort(comparison_.changes.begin(), comparison_.changes.end(),
                     [](const Change& a, const Change& b) { return a.verdict > b.verdict; });
    return std::move(comparison_);
  }

 private:
  void compare_errors(const Row& old, const Row& row) {
    for (const ErrorMeasure& measure : error_measures()) {
      const double before = measure.value(old.quality);
      const double after = measure.value(row.quality);
      if (std::isnan(before) || std::isnan(after)) continue;
      // Infinite in both is no difference at all.
      const double growth = before == after ? 0 : after - before;
      add(row, measure.label, before, after, measure.higher_is_better ? -growth : growth,
          measure.threshold(before));
    }
    const auto count = [](const Row& r) { return static_cast<double>(r.quality.non_finite); };
    add(row, "non-finite pixels", count(old), count(row), count(row) - count(old), 0);
  }

  struct CostChange {
    const Row& row;
    Spread before;
    Spread after;
    double growth;     // logarithm of after / before
    double deviation;  // standard deviation of the growth, by the intervals of both
  };

  CostChange cost_change(const Row& old, const Row& row) const {
    const Spread& before = cost_of(before_.machine, old);
    const Spread& after = cost_of(after_.machine, row);
    return {row, before, after, std::log(after.median / before.median),
            std::hypot(relative_noise(before), relative_noise(after)) / kDeviationsOfInterval};
  }

  // Rows one by one. What differs between two runs and not between rounds (where memory lies, say) shows in
  // the spread of all rows' changes, so that counts as noise too.
  void compare_costs(const std::vector<CostChange>& costs) {
    if (costs.empty()) return;
    Samples growths;
    for (const CostChange& cost : costs)
      growths.push_back(cost.growth);
    const double middle = median_of(growths);
    for (double& growth : growths)
      growth = std::abs(growth - middle);
    comparison_.cost_deviation = kNormalMad * median_of(growths);
    for (const CostChange& cost : costs) {
      const bool apart = cost.after.low > cost.before.high || cost.after.high < cost.before.low;
      add(cost.row, "cost, copies", cost.before.median, cost.after.median, apart ? cost.growth : 0,
          kCostMatters + kDeviations * std::max(comparison_.cost_deviation, cost.deviation));
    }
  }

  // Each method over all its rows: finer than the rows, for their noise averages out.
  void compare_means(const std::vector<CostChange>& costs) {
    for (const MethodRow& method : after_.methods) {
      Samples growths, before, after;
      for (const CostChange& cost : costs) {
        if (cost.row.method != method.name) continue;
        growths.push_back(cost.growth);
        before.push_back(cost.before.median);
        after.push_back(cost.after.median);
      }
      if (growths.size() < kFewestRows) continue;
      const Row all{.scene = "all",
                    .scale = 0,
                    .method = method.name,
                    .render = {},
                    .quality = {},
                    .speed = {},
                    .front = {}};
      add(all, "cost, copies, mean", mean_of(before), mean_of(after), mean_of(growths),
          kCostMatters + kDeviations * deviation_of_mean(growths));
    }
  }

  // `growth` > 0 is worse.
  void add(const Row& row, const char* measure, double before, double after, double growth, double noise) {
    if (std::abs(growth) <= noise) {
      ++comparison_.same;
      return;
    }
    comparison_.changes.push_back({row.scene, row.scale, row.method, measure, before, after,
                                   growth > 0 ? Verdict::kWorse : Verdict::kBetter});
  }

  const BenchResult& before_;
  const BenchResult& after_;
  bool same_machine_ = false;
  Comparison comparison_;
};

Status check_conditions(const Conditions& before, const Conditions& after) {
  Status status;
  const auto check = [&status](const char* option, const auto& old, const auto& now) {
    if (old == now || !status.ok()) return;
    status = Status::invalid(fmt::format(
        "the results cannot be compared: the old one has {} {}, the new one {}; measure with the same",
        option, old, now));
  };
  const auto size = [](Extent extent) { return fmt::format("{}x{}", extent.width, extent.height); };
  check("--output", size(before.output), size(after.output));
  check("--frames", before.frames, after.frames);
  check("--warm-up", before.warm_up, after.warm_up);
  if (before.history_warm_up && after.history_warm_up)
    check("--history-warm-up", *before.history_warm_up, *after.history_warm_up);
  check("--seed", before.seed, after.seed);
  check("--fps", before.fps, after.fps);
  check("--start", before.start, after.start);
  check("--noise", before.noise.value_or(0), after.noise.value_or(0));
  check("--truth", before.truth_samples, after.truth_samples);
  return status;
}

std::string list_text(const char* title, const std::vector<std::string>& items) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), kMost); ++i)
    text += fmt::format("{}{}\n", i == 0 ? title : "", items[i]);
  if (items.size() > kMost) text += fmt::format("  and {} more\n", items.size() - kMost);
  return text;
}

}  // namespace

bool Comparison::worse() const {
  return std::any_of(changes.begin(), changes.end(),
                     [](const Change& change) { return change.verdict == Verdict::kWorse; });
}

Result<Comparison> compare(const BenchResult& before, const BenchResult& after) {
  if (Status status = check_conditions(before.conditions, after.conditions); !status.ok()) return status;
  return Comparer(before, after).run();
}

std::string text_of(const Comparison& comparison) {
  std::string text;
  for (const std::string& note : comparison.notes)
    text += note + "\n";
  for (const Change& change : comparison.changes) {
    text += fmt::format("{:<6}  {:<12} {:<5} {:<22} {:<26} {:.4g} -> {:.4g}\n",
                        change.verdict == Verdict::kWorse ? "WORSE" : "better", change.scene,
                        change.scale > 0 ? fmt::format("{}", change.scale) : "all", change.method,
                        change.measure, change.before, change.after);
  }
  text += list_text("only in the old result:\n", comparison.missing);
  text += list_text("only in the new result:\n", comparison.added);
  const auto worse = std::count_if(comparison.changes.begin(), comparison.changes.end(),
                                   [](const Change& change) { return change.verdict == Verdict::kWorse; });
  text += fmt::format("noise of a cost between the two runs: ±{:.1f} % (standard deviation over all rows)\n",
                      100 * comparison.cost_deviation);
  text += fmt::format("{} figures worse, {} better, {} within noise\n", worse,
                      static_cast<std::ptrdiff_t>(comparison.changes.size()) - worse, comparison.same);
  return text;
}

}  // namespace quincunx::bench
