// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/traces/trace_run.h"

namespace quincunx::traces {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(TraceKind kind) {
  switch (kind) {
    case TraceKind::kFeasible:
      return "feasible";
    case TraceKind::kInfeasible:
      return "infeasible";
    case TraceKind::kCpuBound:
      return "cpu-bound";
  }
  return "";
}

Json known(double value) {
  return value >= 0 ? Json(value) : Json(nullptr);
}

std::string frames_text(double value) {
  return value >= 0 ? fmt::format("{:.1f}", value) : "-";
}

Json json_of(const Display& display) {
  return {{"refresh_hz", display.refresh_hz},
          {"buffers", display.buffers},
          {"timer_latency_frames", display.timer_latency}};
}

Json json_of(const TraceRow& row) {
  return {{"trace", row.trace},
          {"kind", name_of(row.kind)},
          {"frames", row.score.frames},
          {"dropped", row.dropped},
          {"cpu_dropped", row.cpu_dropped},
          {"pixels_over_oracle", row.score.pixels},
          {"changes_per_second", row.score.changes_per_second},
          {"reversals_per_second", row.score.oscillation},
          {"settle_up_frames", known(row.score.settle_up)},
          {"settle_down_frames", known(row.score.settle_down)}};
}

Json json_of(const ControllerResult& result) {
  const TraceTotals& totals = result.totals;
  Json json = {{"controller", result.controller},
               {"ours", result.ours},
               {"traces", result.list},
               {"display", json_of(result.display)},
               {"frames", totals.frames},
               {"dropped", totals.dropped},
               {"dropped_per_thousand", totals.dropped_per_thousand()},
               {"pixels_over_oracle", totals.pixels},
               {"changes_per_second", totals.changes_per_second},
               {"reversals_per_second", totals.oscillation},
               {"settle_up_frames", known(totals.settle_up)},
               {"settle_down_frames", known(totals.settle_down)},
               {"rows", Json::array()}};
  for (const TraceRow& row : result.rows)
    json["rows"].push_back(json_of(row));
  return json;
}

}  // namespace

std::string text_of(const TraceRun& run) {
  std::string text;
  const ControllerResult* before = nullptr;
  for (const ControllerResult& result : run.results) {
    const Display& display = result.display;
    const bool same = before != nullptr && before->list == result.list &&
                      before->display.refresh_hz == display.refresh_hz &&
                      before->display.buffers == display.buffers &&
                      before->display.timer_latency == display.timer_latency;
    if (!same) {
      text += fmt::format("\n{} traces, {:g} Hz, {} buffers, timers {} frames late\n", result.list,
                          display.refresh_hz, display.buffers, display.timer_latency);
      text += fmt::format("{:<18}{:>10}{:>9}{:>11}{:>13}{:>10}{:>10}\n", "controller", "dropped", "pixels",
                          "changes/s", "reversals/s", "down", "up");
    }
    const TraceTotals& totals = result.totals;
    text += fmt::format("{:<18}{:>10.1f}{:>9.3f}{:>11.2f}{:>13.2f}{:>10}{:>10}\n", result.controller,
                        totals.dropped, totals.pixels, totals.changes_per_second, totals.oscillation,
                        frames_text(totals.settle_up), frames_text(totals.settle_down));
    before = &result;
  }
  text += fmt::format(
      "\ndropped: refreshes without a new frame, mean of {} seeds, over the feasible traces.  pixels: over "
      "the oracle's.\n"
      "down, up: frames to settle after a step that lowers, raises the resolution.  The first {} frames do "
      "not count.\n",
      run.settings.seeds.size(), kWarmUp);
  return text;
}

std::string json_of(const TraceRun& run) {
  const LadderSettings& ladder = run.settings.ladder;
  Json root = {{"output", {ladder.output.width, ladder.output.height}},
               {"min_scale", ladder.min_scale},
               {"max_scale", ladder.max_scale},
               {"seeds", run.settings.seeds},
               {"warm_up_frames", kWarmUp},
               {"results", Json::array()}};
  for (const ControllerResult& result : run.results)
    root["results"].push_back(json_of(result));
  return root.dump(1) + "\n";
}

std::string csv_of(const TraceRun& run) {
  std::string text =
      "traces,refresh_hz,buffers,timer_latency_frames,controller,trace,kind,frames,dropped,cpu_dropped,"
      "pixels_over_oracle,changes_per_second,reversals_per_second,settle_up_frames,settle_down_frames\n";
  const auto cell = [](double value) { return value >= 0 ? fmt::format("{:g}", value) : std::string(); };
  for (const ControllerResult& result : run.results) {
    for (const TraceRow& row : result.rows) {
      const Display& display = result.display;
      text += fmt::format("{},{:g},{},{},{},\"{}\",{},{},{:g},{:g},{:g},{:g},{:g},{},{}\n", result.list,
                          display.refresh_hz, display.buffers, display.timer_latency, result.controller,
                          row.trace, name_of(row.kind), row.score.frames, row.dropped, row.cpu_dropped,
                          row.score.pixels, row.score.changes_per_second, row.score.oscillation,
                          cell(row.score.settle_up), cell(row.score.settle_down));
    }
  }
  return text;
}

}  // namespace quincunx::traces
