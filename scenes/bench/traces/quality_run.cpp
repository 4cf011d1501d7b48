// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <functional>
#include <utility>

#include "bench/harness/measuring.h"
#include "bench/harness/records.h"
#include "bench/traces/trace_run.h"
#include "quincunx/control/predictive_controller.h"

namespace quincunx::traces {
namespace {

using bench::checked;

struct Contender {
  std::string name;
  std::function<QualityScore(const QualityStage&)> replay;
};

PredictiveSettings pacing_of(const QualityRunSettings& settings) {
  return {.ladder = settings.ladder,
          .target_ms = settings.display.target_ms(),
          .buffers = settings.display.buffers};
}

std::vector<Contender> contenders(const QualityRunSettings& settings, const ResolutionLadder& ladder) {
  std::vector<Contender> list;
  list.push_back({"oracle", [&ladder](const QualityStage& stage) { return oracle(stage, ladder); }});
  list.push_back(
      {"quality", [&settings](const QualityStage& stage) {
         auto controller = checked(make_quality_controller(
             {.pacing = pacing_of(settings), .front = measured_front(*stage.machine, stage.seed)}));
         return replay_quality(stage, *controller);
       }});
  list.push_back({"quality, built-in front", [&settings](const QualityStage& stage) {
                    auto controller = checked(make_quality_controller({.pacing = pacing_of(settings)}));
                    return replay_quality(stage, *controller);
                  }});
  for (const MethodVariant& method : ErrorFront::built_in().methods()) {
    list.push_back({"predictive, " + name_of(method), [&settings, method](const QualityStage& stage) {
                      auto controller = checked(make_predictive_controller(pacing_of(settings)));
                      return replay_fixed(stage, controller->ladder(), controller.get(), method);
                    }});
  }
  for (const MethodVariant& method : ErrorFront::built_in().methods()) {
    list.push_back({"scale 1, " + name_of(method), [&ladder, method](const QualityStage& stage) {
                      return replay_fixed(stage, ladder, nullptr, method);
                    }});
  }
  return list;
}

// The input of a run with one seed.
struct Stage {
  std::uint64_t seed = 1;
  std::vector<ContentTrace> traces;
  ErrorFront machine;
};

// Makes a stage for each seed. A held-out split has another machine, too.
std::vector<Stage> stages_for(const QualityRunSettings& settings, const ResolutionLadder& ladder, Split split,
                              const ScriptedMachine& machine, double budget) {
  constexpr std::uint64_t kHeldOutMachine = 1000;
  const double megapixels = static_cast<double>(ladder.output().area()) * 1e-6;
  const ScriptedMachine in_budget = {machine.name, machine.balanced_part / budget};
  std::vector<Stage> stages;
  for (const std::uint64_t seed : settings.seeds) {
    const std::uint64_t of_machine = seed + (split == Split::kHeldOut ? kHeldOutMachine : 0);
    stages.push_back({seed, content_traces(split, seed),
                      front_of(in_budget, settings.display.target_ms(), megapixels, of_machine)});
    for (ContentTrace& trace : stages.back().traces) {
      for (FrameLoad& load : trace.load.frames) {
        load.fixed /= budget;
        load.scaling /= budget;
      }
    }
  }
  return stages;
}

QualityResult result_of(const QualityRunSettings& settings, const std::vector<Stage>& stages,
                        const Contender& contender) {
  QualityResult result = {.controller = contender.name};
  result.flips.resize(stages.front().traces.size());
  const auto seeds = static_cast<double>(stages.size());
  const double share = 1 / (seeds * static_cast<double>(result.flips.size()));
  QualityScore& mean = result.score;
  for (const Stage& stage : stages) {
    mean.frames = 0;
    for (std::size_t index = 0; index < stage.traces.size(); ++index) {
      const QualityScore score = contender.replay({.trace = &stage.traces[index],
                                                   .machine = &stage.machine,
                                                   .display = settings.display,
                                                   .seed = stage.seed,
                                                   .times_passes = settings.times_passes});
      mean.frames += score.frames;
      mean.dropped += score.dropped / seeds;
      mean.flip += share * score.flip;
      mean.changes_per_second += share * score.changes_per_second;
      mean.pixels += share * score.pixels;
      result.flips[index] += score.flip / seeds;
    }
  }
  return result;
}

}  // namespace

template <typename Io, bench::SameAs<QualityResult> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(traces, machine, budget, controller)
  io("frames", value.score.frames);
  io("dropped", value.score.dropped);
  io("flip", value.score.flip);
  QUINCUNX_EACH_FIELD(flip_over_oracle)
  io("changes_per_second", value.score.changes_per_second);
  io("pixels", value.score.pixels);
  QUINCUNX_EACH_FIELD(flips)
}

template <typename Io, bench::SameAs<QualityRun> Self>
void fields(Io& io, Self& value) {
  const QualityRunSettings& settings = value.settings;
  io("seeds", settings.seeds);
  fields(io, settings.display);
  io("times_passes", settings.times_passes);
  QUINCUNX_EACH_FIELD(results)
}

QualityRun run_quality(const QualityRunSettings& settings) {
  const ResolutionLadder ladder = checked(ResolutionLadder::create(settings.ladder));
  QualityRun run = {.settings = settings, .results = {}};
  for (const Split split : settings.splits) {
    for (const ScriptedMachine& machine : scripted_machines()) {
      for (const double budget : settings.budgets) {
        const std::vector<Stage> stages = stages_for(settings, ladder, split, machine, budget);
        const std::size_t oracle = run.results.size();
        for (const Contender& contender : contenders(settings, ladder)) {
          QualityResult result = result_of(settings, stages, contender);
          result.traces = split == Split::kDevelopment ? "development" : "held-out";
          result.machine = machine.name;
          result.budget = budget;
          run.results.push_back(std::move(result));
          QualityResult& last = run.results.back();
          for (std::size_t i = 0; i < last.flips.size(); ++i)
            last.flip_over_oracle +=
                last.flips[i] / run.results[oracle].flips[i] / static_cast<double>(last.flips.size());
        }
      }
    }
  }
  return run;
}

std::string text_of(const QualityRun& run) {
  std::string text, before;
  for (const QualityResult& result : run.results) {
    const std::string head = fmt::format("\n{} traces, {} machine, {:g} of the time\n", result.traces,
                                         result.machine, result.budget);
    if (head != before) {
      text += head + fmt::format("{:<36}{:>9}{:>9}{:>9}{:>11}{:>9}\n", "controller", "FLIP", "/oracle",
                                 "dropped", "changes/s", "pixels");
    }
    text += fmt::format("{:<36}{:>9.4f}{:>9.3f}{:>9.1f}{:>11.2f}{:>9.3f}\n", result.controller,
                        result.score.flip, result.flip_over_oracle, result.score.dropped,
                        result.score.changes_per_second, result.score.pixels);
    before = head;
  }
  return text + fmt::format(
                    "\nFLIP: expected, mean of all refreshes, dropped frames included; the traces' mean over "
                    "that of "
                    "the oracle.\ndropped: of {} frames, mean of {} seeds.  changes/s: of the method.\n",
                    run.results.front().score.frames, run.settings.seeds.size());
}

std::string json_of(const QualityRun& run) {
  return bench::json_of(run);
}

std::string csv_of(const QualityRun& run) {
  return bench::csv_text(run.results);
}

}  // namespace quincunx::traces
