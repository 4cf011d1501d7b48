// SPDX-License-Identifier: MIT
#include "bench/traces/trace_run.h"

#include <stdexcept>
#include <utility>

#include "bench/traces/peer_controllers.h"
#include "quincunx/predictive_controller.h"

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

}  // namespace quincunx::traces
