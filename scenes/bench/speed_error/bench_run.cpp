// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_run.h"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_statistics.h"
#include "bench/speed_error/case_run.h"
#include "tools/program/clock.h"
#include "tools/program/jitter.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string system_name() {
  utsname names{};
  return uname(&names) == 0 ? fmt::format("{} {} {}", names.sysname, names.release, names.machine)
                            : "unknown";
}

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

  void run() {
    for (const std::string& scene : plan_.scenes)
      run_scene(scene);
    mark_fronts(result_.rows);
  }

  BenchResult& result() { return result_; }
  Gallery take_gallery() { return gallery_.take(); }

 private:
  std::size_t steps_of_a_case() const { return static_cast<std::size_t>(plan_.conditions.rounds) + 1; }
  void step(const std::string& what) { progress_.update(++done_, what); }

  void run_scene(const std::string& name) {
    auto stage = open_stage(options_, name, sequence_for(plan_, 1, plan_.methods.front()));
    checked(check_event_times(stage->device()));
    describe_machine(*stage, result_.machine);
    const scenes::Scene& scene = stage->scene();
    BenchPlan plan = plan_;
    plan.conditions = conditions_for(plan_.conditions, scene);
    auto truth = make_truth(stage->renderer(), scene, result_.machine.gl_version, plan.conditions);
    step(name + ": truth");
    result_.scenes.push_back(
        {name, scene.summary, scene.reason, truth.flicker, truth.disoccluded_part, truth.region_part});
    gallery_.begin_scene(name, truth.pictures.back());
    for (const double scale : plan_.scales)
      run_case(*stage, plan, truth, name, scale);
    gallery_.end_scene();
  }

  void run_case(const scenes::FrameSource& stage, const BenchPlan& plan, const SceneTruth& truth,
                const std::string& scene, double scale) {
    const auto run = CaseRun::create(stage, plan, truth, scale);
    run->run_quality(stage);
    step(fmt::format("{} at {}", scene, scale));
    for (int round = 0; round < plan_.conditions.rounds; ++round) {
      run->run_timed();
      step(fmt::format("{} at {}", scene, scale));
    }
    for (Row& row : run->rows(scene))
      result_.rows.push_back(std::move(row));
    result_.copies.push_back(run->copy_row(scene));
    result_.frames.push_back(run->frame_row(scene));
    result_.machine.interop = run->interop();
    for (std::size_t i = 0; i < plan_.methods.size(); ++i)
      gallery_.add(scale, run->picture(i));
  }

  const BenchPlan& plan_;
  const BenchOptions& options_;
  BenchResult result_;
  GalleryMaker gallery_;
  tools::Progress progress_;
  std::int64_t done_ = 0;
};

}  // namespace

void describe_machine(const scenes::FrameSource& source, Machine& machine) {
  machine.processor = processor_name();
  machine.processors = static_cast<int>(std::thread::hardware_concurrency());
  machine.memory_gib =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 30);
  machine.system = system_name();
  const DeviceInfo& cl = source.device().info();
  machine.cl_device = cl.name;
  machine.cl_platform = cl.platform;
  machine.cl_driver = cl.driver;
  machine.cl_version = cl.version;
  machine.cl_on_processor = cl.kind == DeviceKind::kCpu;
  const gl::ContextInfo& gl = source.context().info();
  machine.gl_renderer = gl.renderer;
  machine.gl_version = gl.version;
}

double load_of_last_minute() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

std::unique_ptr<scenes::FrameSource> open_stage(const BenchOptions& options, const std::string& scene,
                                                const scenes::SequenceSettings& sequence) {
  scenes::FrameSourceSettings settings;
  settings.scene = scene;
  settings.seed = options.seed;
  settings.device = options.device;
  settings.interop = options.interop;
  settings.platform = options.platform;
  settings.sequence = sequence;
  return checked(scenes::FrameSource::create(settings));
}

RunFacts facts_of(const BenchOptions& options, const scenes::FrameSource& stage) {
  RunFacts facts{QUINCUNX_VERSION, options.command_line, tools::date_now(), {}};
  describe_machine(stage, facts.machine);
  facts.machine.load_before = load_of_last_minute();
  return facts;
}

BenchRun run_bench(const BenchPlan& plan, const BenchOptions& options) {
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
  runner.run();
  result.machine.load_after = load_of_last_minute();
  result.wall_seconds = tools::ms_since(start) / 1000;
  BenchRun run{std::move(result), runner.take_gallery()};
  return run;
}

}  // namespace quincunx::bench
