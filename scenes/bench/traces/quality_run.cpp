// SPDX-License-Identifier: MIT
#include "bench/traces/quality_run.h"

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "quincunx/control/predictive_controller.h"

namespace quincunx::traces {
namespace {

template <typename Made>
Made checked(Result<Made> made) {
  if (!made.ok()) throw std::invalid_argument(made.status().message());
  return std::move(made).value();
}

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
  result.errors.resize(stages.front().traces.size());
  const auto seeds = static_cast<double>(stages.size());
  const double share = 1 / (seeds * static_cast<double>(result.errors.size()));
  for (const Stage& stage : stages) {
    result.frames = 0;
    for (std::size_t index = 0; index < stage.traces.size(); ++index) {
      const QualityScore score = contender.replay({.trace = &stage.traces[index],
                                                   .machine = &stage.machine,
                                                   .display = settings.display,
                                                   .seed = stage.seed,
                                                   .times_passes = settings.times_passes});
      result.frames += score.frames;
      result.dropped += score.dropped / seeds;
      result.error += share * score.error;
      result.errors[index] += score.error / seeds;
      result.changes_per_second += share * score.changes_per_second;
      result.area += share * score.area;
    }
  }
  return result;
}

}  // namespace

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
          for (std::size_t i = 0; i < last.errors.size(); ++i)
            last.over_oracle +=
                last.errors[i] / run.results[oracle].errors[i] / static_cast<double>(last.errors.size());
        }
      }
    }
  }
  return run;
}

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
