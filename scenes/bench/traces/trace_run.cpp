// SPDX-License-Identifier: MIT
#include "bench/traces/trace_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bench/traces/peer_controllers.h"
#include "quincunx/control/predictive_controller.h"

namespace quincunx::traces {
namespace {

Controller checked(Result<Controller> made) {
  if (!made.ok()) throw std::invalid_argument(made.status().message());
  return std::move(made).value();
}

ControllerKind peer(const std::string& name, Controller (*make)(const ResolutionLadder&, double)) {
  return {name, false, [make](const LadderSettings& ladder, const Display& display) {
            Result<ResolutionLadder> made = ResolutionLadder::create(ladder);
            if (!made.ok()) throw std::invalid_argument(made.status().message());
            return make(made.value(), display.target_ms());
          }};
}

// A mean over those values that are there.
class Mean {
 public:
  void add(double value) {
    if (value < 0) return;
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : -1; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

class RowMeans {
 public:
  void add(const ReplayScore& score) {
    frames_ = score.frames;
    dropped_.add(score.dropped);
    cpu_dropped_.add(score.cpu_dropped);
    pixels_.add(score.pixels);
    changes_.add(score.changes_per_second);
    oscillation_.add(score.oscillation);
    up_.add(score.settle_up);
    down_.add(score.settle_down);
  }
  TraceRow row(const LoadTrace& trace) const {
    TraceRow row{.trace = trace.name, .kind = trace.kind, .score = {}};
    row.dropped = dropped_.value();
    row.cpu_dropped = cpu_dropped_.value();
    row.score.frames = frames_;
    row.score.pixels = pixels_.value();
    row.score.changes_per_second = changes_.value();
    row.score.oscillation = oscillation_.value();
    row.score.settle_up = up_.value();
    row.score.settle_down = down_.value();
    return row;
  }

 private:
  int frames_ = 0;
  Mean dropped_, cpu_dropped_, pixels_, changes_, oscillation_, up_, down_;
};

TraceTotals totals_of(const std::vector<TraceRow>& rows) {
  TraceTotals totals;
  Mean pixels, changes, oscillation, up, down;
  for (const TraceRow& row : rows) {
    if (row.kind != TraceKind::kFeasible) continue;
    totals.frames += row.score.frames;
    totals.dropped += row.dropped;
    pixels.add(row.score.pixels);
    changes.add(row.score.changes_per_second);
    oscillation.add(row.score.oscillation);
    up.add(row.score.settle_up);
    down.add(row.score.settle_down);
  }
  totals.pixels = pixels.value();
  totals.changes_per_second = changes.value();
  totals.oscillation = oscillation.value();
  totals.settle_up = up.value();
  totals.settle_down = down.value();
  return totals;
}

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

std::vector<ControllerKind> controller_kinds() {
  return {
      {"predictive", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_predictive_controller(
             {.ladder = ladder, .target_ms = display.target_ms(), .buffers = display.buffers}));
       }},
      {"proportional [W]", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_proportional_controller({.ladder = ladder, .target_ms = display.target_ms()}));
       }},
      {"minimum of N [N]", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_minimum_of_n_controller({.ladder = ladder, .target_ms = display.target_ms()}));
       }},
      peer("Unreal-like", make_unreal_like),
      peer("Valve-like", make_valve_like),
      peer("Unity-like", make_unity_like),
      peer("Filament-like", make_filament_like),
  };
}

std::vector<NamedTraces> scripted_traces() {
  return {{"development", development_traces}, {"held-out", held_out_traces}};
}

TraceRun run_traces(const TraceSettings& settings) {
  TraceRun run{.settings = settings, .results = {}};
  for (const NamedTraces& list : settings.lists) {
    std::vector<std::vector<LoadTrace>> traces;
    for (const std::uint64_t seed : settings.seeds)
      traces.push_back(list.make(seed));
    for (const Display& display : settings.displays) {
      for (const ControllerKind& kind : controller_kinds()) {
        ControllerResult result{
            .controller = kind.name, .ours = kind.ours, .list = list.name, .display = display};
        for (std::size_t index = 0; index < traces.front().size(); ++index) {
          RowMeans means;
          for (const std::vector<LoadTrace>& of_seed : traces) {
            const LoadTrace& trace = of_seed[index];
            const Controller controller = kind.make(settings.ladder, display);
            means.add(score(trace, display, replay(trace, display, *controller)));
          }
          result.rows.push_back(means.row(traces.front()[index]));
        }
        result.totals = totals_of(result.rows);
        run.results.push_back(std::move(result));
      }
    }
  }
  return run;
}

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
  Json root = {{"output", {ladder.output_extent.width, ladder.output_extent.height}},
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
