// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/traces/quality_run.h"

namespace quincunx::traces {

std::string text_of(const QualityRun& run) {
  std::string text;
  const QualityResult* before = nullptr;
  for (const QualityResult& result : run.results) {
    if (before == nullptr || before->traces != result.traces || before->machine != result.machine ||
        before->budget != result.budget) {
      text += fmt::format("\n{} traces, {} machine, {:g} of the time\n", result.traces, result.machine,
                          result.budget);
      text += fmt::format("{:<36}{:>9}{:>9}{:>9}{:>11}{:>9}\n", "controller", "FLIP", "/oracle", "dropped",
                          "changes/s", "pixels");
    }
    text += fmt::format("{:<36}{:>9.4f}{:>9.3f}{:>9.1f}{:>11.2f}{:>9.3f}\n", result.controller, result.error,
                        result.over_oracle, result.dropped, result.changes_per_second, result.area);
    before = &result;
  }
  return text + fmt::format(
                    "\nFLIP: expected, mean of all refreshes, dropped frames included; the traces' mean over "
                    "that of "
                    "the oracle.\ndropped: of {} frames, mean of {} seeds.  changes/s: of the method.\n",
                    run.results.front().frames, run.settings.seeds.size());
}

std::string json_of(const QualityRun& run) {
  nlohmann::ordered_json root = {{"seeds", run.settings.seeds},
                                 {"refresh_hz", run.settings.display.refresh_hz},
                                 {"buffers", run.settings.display.buffers},
                                 {"timer_latency_frames", run.settings.display.timer_latency},
                                 {"times_passes", run.settings.times_passes},
                                 {"results", nlohmann::ordered_json::array()}};
  for (const QualityResult& result : run.results) {
    root["results"].push_back({{"traces", result.traces},
                               {"machine", result.machine},
                               {"budget", result.budget},
                               {"controller", result.controller},
                               {"frames", result.frames},
                               {"dropped", result.dropped},
                               {"flip", result.error},
                               {"flip_over_oracle", result.over_oracle},
                               {"changes_per_second", result.changes_per_second},
                               {"pixels", result.area},
                               {"flips", result.errors}});
  }
  return root.dump(1) + "\n";
}

std::string csv_of(const QualityRun& run) {
  std::string text =
      "traces,machine,budget,controller,frames,dropped,flip,flip_over_oracle,changes_per_second,pixels\n";
  for (const QualityResult& result : run.results) {
    text += fmt::format("{},{},{:g},\"{}\",{},{:g},{:g},{:g},{:g},{:g}\n", result.traces, result.machine,
                        result.budget, result.controller, result.frames, result.dropped, result.error,
                        result.over_oracle, result.changes_per_second, result.area);
  }
  return text;
}

}  // namespace quincunx::traces
