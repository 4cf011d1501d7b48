// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_run.h"

#include <fmt/format.h>

#include "bench/harness/clocks.h"
#include "bench/speed_error/bench_machine.h"
#include "bench/speed_error/bench_statistics.h"
#include "bench/speed_error/case_run.h"
#include "tools/program/clock.h"
#include "tools/program/jitter.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

class Runner {
 public:
  Runner(const BenchPlan& plan, const BenchOptions& options)
      : plan_(plan),
        options_(options),
        gallery_(plan),
        progress_(
            "measuring",
            static_cast<std::int64_t>(plan.scenes.size() * (1 + plan.scales.size() * steps_of_a_case())),
            options.quiet ? tools::Progress::Show::kNever : tools::Progress::Show::kOnTerminal) {}

  Status run() {
    for (const std::string& scene : plan_.scenes) {
      if (Status status = run_scene(scene); !status.ok()) return status;
    }
    mark_fronts(result_.rows);
    return {};
  }

  BenchResult& result() { return result_; }
  Gallery take_gallery() { return gallery_.take(); }

 private:
  std::size_t steps_of_a_case() const { return static_cast<std::size_t>(plan_.conditions.rounds) + 1; }
  void step(const std::string& what) { progress_.update(++done_, what); }

  Status run_scene(const std::string& name) {
    scenes::FrameSourceSettings settings;
    settings.scene = name;
    settings.seed = plan_.conditions.seed;
    settings.device = options_.device;
    settings.interop = options_.interop;
    settings.platform = options_.platform;
    settings.sequence = sequence_for(plan_, 1, plan_.methods.front());
    auto stage = scenes::FrameSource::create(settings);
    if (!stage.ok()) return stage.status();
    if (Status status = check_event_times(stage.value()->device()); !status.ok()) return status;
    describe_machine(*stage.value(), result_.machine);
    const scenes::Scene& scene = stage.value()->scene();
    BenchPlan plan = plan_;
    plan.conditions = conditions_for(plan_.conditions, scene);
    auto truth = make_truth(stage.value()->renderer(), scene, result_.machine.gl_version, plan.conditions);
    if (!truth.ok()) return truth.status();
    step(name + ": truth");
    result_.scenes.push_back(
        {name, scene.summary, scene.reason, truth->flicker, truth->disoccluded_part, truth->region_part});
    gallery_.begin_scene(name, truth->pictures.back());
    for (const double scale : plan_.scales) {
      if (Status status = run_case(*stage.value(), plan, truth.value(), name, scale); !status.ok())
        return status;
    }
    return gallery_.end_scene();
  }

  Status run_case(const scenes::FrameSource& stage, const BenchPlan& plan, const SceneTruth& truth,
                  const std::string& scene, double scale) {
    auto made = CaseRun::create(stage, plan, truth, scale);
    if (!made.ok()) return made.status();
    CaseRun& run = *made.value();
    if (Status status = run.run_quality(stage); !status.ok()) return status;
    step(fmt::format("{} at {}", scene, scale));
    for (int round = 0; round < plan_.conditions.rounds; ++round) {
      if (Status status = run.run_timed(); !status.ok()) return status;
      step(fmt::format("{} at {}", scene, scale));
    }
    for (Row& row : run.rows(scene))
      result_.rows.push_back(std::move(row));
    result_.copies.push_back(run.copy_row(scene));
    result_.frames.push_back(run.frame_row(scene));
    result_.machine.interop = run.interop();
    for (std::size_t i = 0; i < plan_.methods.size(); ++i)
      gallery_.add(scale, run.picture(i));
    return {};
  }

  const BenchPlan& plan_;
  const BenchOptions& options_;
  BenchResult result_;
  GalleryMaker gallery_;
  tools::Progress progress_;
  std::int64_t done_ = 0;
};

}  // namespace

Result<BenchRun> run_bench(const BenchPlan& plan, const BenchOptions& options) {
  const tools::Clock::time_point start = tools::Clock::now();
  Runner runner(plan, options);
  BenchResult& result = runner.result();
  result.version = QUINCUNX_VERSION;
  result.command = options.command_line;
  result.date = tools::date_now();
  result.conditions = plan.conditions;
  for (const BenchMethod& method : plan.methods) {
    result.methods.push_back(
        {method.name, method.summary, tools::name_of(method.jitter),
         method.detail.lod_bias + method.detail.follows_scale * texture_lod_bias({1, 1}, {1, 1})});
  }
  result.machine.load_before = load_of_last_minute();
  if (Status status = runner.run(); !status.ok()) return status;
  result.machine.load_after = load_of_last_minute();
  result.wall_seconds = tools::ms_since(start) / 1000;
  BenchRun run{std::move(result), runner.take_gallery()};
  return run;
}

}  // namespace quincunx::bench
