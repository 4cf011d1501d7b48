// SPDX-License-Identifier: MIT
#include "bench/traces/trace_run.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "bench/harness/records.h"

namespace quincunx::traces {
namespace {

// Returns the mean of a field over the scores that have it.
template <typename Value>
Value mean_of(const std::vector<ReplayScore>& scores, Value ReplayScore::*field) {
  double sum = 0;
  int count = 0;
  for (const ReplayScore& score : scores) {
    const std::optional<double> value = score.*field;
    if (!value) continue;
    sum += *value;
    ++count;
  }
  return count > 0 ? Value(sum / count) : Value();
}

// Returns the means of all but the frames.
ReplayScore mean_of(const std::vector<ReplayScore>& scores) {
  const auto mean = [&scores](auto field) { return mean_of(scores, field); };
  return {.dropped = mean(&ReplayScore::dropped),
          .cpu_dropped = mean(&ReplayScore::cpu_dropped),
          .pixels_over_oracle = mean(&ReplayScore::pixels_over_oracle),
          .changes_per_second = mean(&ReplayScore::changes_per_second),
          .reversals_per_second = mean(&ReplayScore::reversals_per_second),
          .settle_up_frames = mean(&ReplayScore::settle_up_frames),
          .settle_down_frames = mean(&ReplayScore::settle_down_frames)};
}

ReplayScore totals_of(const std::vector<TraceRow>& rows) {
  std::vector<ReplayScore> feasible;
  for (const TraceRow& row : rows) {
    if (row.kind == TraceKind::kFeasible) feasible.push_back(row.score);
  }
  ReplayScore totals = mean_of(feasible);
  totals.dropped = totals.cpu_dropped = 0;
  for (const ReplayScore& score : feasible) {
    totals.frames += score.frames;
    totals.dropped += score.dropped;
    totals.cpu_dropped += score.cpu_dropped;
  }
  return totals;
}

const char* name_of(TraceKind kind) {
  constexpr const char* kNames[] = {"feasible", "infeasible", "cpu-bound"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string frames_text(std::optional<double> frames) {
  return frames ? fmt::format("{:.1f}", *frames) : "-";
}

std::string text_of(const Display& display) {
  return fmt::format("{:g} Hz, {} buffers, timers {} frames late", display.refresh_hz, display.buffers,
                     display.timer_latency_frames);
}

}  // namespace

// A line of the CSV.
struct TraceLine {
  std::string traces;
  Display display;
  std::string controller;
  TraceRow row;
};

QUINCUNX_FIELDS(ReplayScore, frames, dropped, cpu_dropped, pixels_over_oracle, changes_per_second,
                reversals_per_second, settle_up_frames, settle_down_frames)

template <typename Io, bench::SameAs<TraceRow> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(trace)
  io("kind", std::string(name_of(value.kind)));
  fields(io, value.score);
}

template <typename Io, bench::SameAs<TraceLine> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(traces)
  fields(io, value.display);
  QUINCUNX_EACH_FIELD(controller)
  fields(io, value.row);
}

template <typename Io, bench::SameAs<ControllerResult> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(controller, ours, traces, display)
  fields(io, value.totals);
  io("dropped_per_thousand", value.totals.dropped_per_thousand());
  QUINCUNX_EACH_FIELD(rows)
}

template <typename Io, bench::SameAs<TraceRun> Self>
void fields(Io& io, Self& value) {
  const LadderSettings& ladder = value.settings.ladder;
  io("output", std::array{ladder.output_extent.width, ladder.output_extent.height});
  io("min_scale", ladder.min_scale);
  io("max_scale", ladder.max_scale);
  io("seeds", value.settings.seeds);
  io("warm_up_frames", kWarmUp);
  QUINCUNX_EACH_FIELD(results)
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
            .controller = kind.name, .ours = kind.ours, .traces = list.name, .display = display};
        for (std::size_t index = 0; index < traces.front().size(); ++index) {
          std::vector<ReplayScore> scores;
          for (const std::vector<LoadTrace>& of_seed : traces) {
            const LoadTrace& trace = of_seed[index];
            const auto controller = kind.make(settings.ladder, display);
            scores.push_back(score(trace, display, replay(trace, display, *controller)));
          }
          const LoadTrace& trace = traces.front()[index];
          result.rows.push_back({trace.name, trace.kind, mean_of(scores)});
          result.rows.back().score.frames = scores.front().frames;
        }
        result.totals = totals_of(result.rows);
        run.results.push_back(std::move(result));
      }
    }
  }
  return run;
}

std::string text_of(const TraceRun& run) {
  std::string text, before;
  for (const ControllerResult& result : run.results) {
    const std::string head = fmt::format("\n{} traces, {}\n", result.traces, text_of(result.display));
    if (head != before) {
      text += head + fmt::format("{:<18}{:>10}{:>9}{:>11}{:>13}{:>10}{:>10}\n", "controller", "dropped",
                                 "pixels", "changes/s", "reversals/s", "down", "up");
    }
    const ReplayScore& totals = result.totals;
    text += fmt::format("{:<18}{:>10.1f}{:>9.3f}{:>11.2f}{:>13.2f}{:>10}{:>10}\n", result.controller,
                        totals.dropped, totals.pixels_over_oracle, totals.changes_per_second,
                        totals.reversals_per_second, frames_text(totals.settle_up_frames),
                        frames_text(totals.settle_down_frames));
    before = head;
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
  return bench::json_of(run);
}

std::string csv_of(const TraceRun& run) {
  std::vector<TraceLine> lines;
  for (const ControllerResult& result : run.results) {
    for (const TraceRow& row : result.rows)
      lines.push_back({result.traces, result.display, result.controller, row});
  }
  return bench::csv_text(lines);
}

}  // namespace quincunx::traces
