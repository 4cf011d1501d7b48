// SPDX-License-Identifier: MIT
#include <algorithm>
#include <tuple>
#include <utility>

#include "bench/speed_error/bench_plan.h"
#include "tools/program/method_names.h"

namespace quincunx::bench {

// In the order of growing effort that Method, TwoFrameForm and TemporalPreset have; of the names of one form
// only the longest.
std::vector<BenchMethod> all_methods() {
  const std::string usual = tools::method_name(ResolveSettings{});
  std::vector<BenchMethod> methods;
  for (const auto& [name, choice] : tools::method_choices()) {
    BenchMethod method{.name = name, .summary = choice.summary, .resolve = {}};
    tools::choose(method.resolve, choice);
    if (tools::method_name(method.resolve) != name) continue;
    method.jitter = scenes::jitter_for(choice.method);
    method.detail = scenes::texture_detail_for(choice.method, method.jitter);
    method.accumulates = choice.method == Method::kTemporal;
    method.is_default = name == usual;
    methods.push_back(std::move(method));
  }
  std::stable_sort(methods.begin(), methods.end(), [](const BenchMethod& a, const BenchMethod& b) {
    const auto effort = [](const ResolveSettings& settings) {
      return std::tuple(settings.method, settings.quincunx.form, settings.temporal.preset);
    };
    return effort(a.resolve) < effort(b.resolve);
  });
  return methods;
}

}  // namespace quincunx::bench
