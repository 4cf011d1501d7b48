// SPDX-License-Identifier: MIT
#include "bench/parts.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "bench/bench_options.h"
#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_quality.h"
#include "bench/speed_error/bench_run.h"
#include "bench/speed_error/contender.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

constexpr double kLeastSaving = 0.01;  // share of the first row's time: less is noise

constexpr float kPartScales[] = {0.75f, 0.5f, 0.25f, 0.125f};

struct PartScene {
  const scenes::FrameSource& stage;
  const BenchPlan& plan;  // its first method counts
  const SceneTruth& truth;
};

struct PartCase {
  std::string part;
  std::string label;
  double scale = 1;  // scale of the picture
  scenes::PartsSettings parts;
};

// Returns the cases in order; the first is the one that all others are compared with.
std::vector<PartCase> cases_of(const BenchPlan& plan, double base, bool has_particles) {
  std::vector<PartCase> cases = {{"picture", fmt::format("{:g}", base), base, {}}};
  for (const double scale : plan.scales) {
    if (scale != base) cases.push_back({"picture", fmt::format("{:g}", scale), scale, {}});
  }
  for (const float scale : kPartScales)
    cases.push_back({"shadow map", fmt::format("{:g}", scale), base, {.shadow = {.scale = scale}}});
  if (!has_particles) return cases;
  const auto add_particles = [&](float scale) {
    cases.push_back({"particles",
                     fmt::format("{:g}", scale),
                     base,
                     {.shadow = {}, .particles = scenes::PartSettings{.scale = scale}}});
  };
  add_particles(1);
  for (const float scale : kPartScales)
    add_particles(scale);
  return cases;
}

// One kind of time over the measured frames.
struct Times {
  Samples ms, processor_ms;

  void add(const StepTime& time) {
    ms.push_back(time.ms);
    processor_ms.push_back(time.processor_ms);
  }
  PartTimes median() const { return {median_of(ms), median_of(processor_ms)}; }
};

class RowRun {
 public:
  static RowRun create(const PartScene& scene, const PartCase& wanted) {
    const BenchMethod& method = scene.plan.methods.front();
    ResolveSettings resolve = method.resolve;
    resolve.output.present = false;
    auto feed = FrameFeed::create(scene.stage, sequence_for(scene.plan, wanted.scale, method), {resolve},
                                  wanted.parts);
    auto contender = Contender::create(scene.stage.device(), feed.plans().front());
    auto resolved =
        checked(scene.stage.device().allocate(scene.plan.conditions.output, resolve.output.linear));
    return RowRun(scene, std::move(feed), std::move(contender), std::move(resolved));
  }

  void run() {
    const Conditions& conditions = scene_.plan.conditions;
    const int first = first_frame_for(conditions, scene_.plan.methods.front());
    for (int frame = first; frame < conditions.warm_up + conditions.frames; ++frame) {
      run_frame(frame - conditions.warm_up);
    }
  }

  PartRow row(const PartCase& wanted) const {
    const Quality quality = tally_.quality();
    return {.part = wanted.part,
            .scale = wanted.label,
            .render = {render_.width, render_.height},
            .draw = draw_.median(),
            .resolve = resolve_.median(),
            .frame = frame_.median(),
            .psnr = quality.psnr,
            .flip = quality.flip,
            .flip_per_ms = {}};
  }

 private:
  RowRun(const PartScene& scene, FrameFeed feed, Contender contender, Image resolved)
      : scene_(scene),
        feed_(std::move(feed)),
        contender_(std::move(contender)),
        resolved_(std::move(resolved)) {}

  // `measured`: which of the measured frames; below 0: it warms up.
  void run_frame(int measured_frame) {
    auto inputs = feed_.next();
    auto time = contender_.dispatch(inputs, nullptr, {.linear = resolved_.view()});
    render_ = inputs.render_extent;
    const float exposure = inputs.exposure;
    feed_.release();
    if (measured_frame < 0) return;
    StepTime whole = feed_.draw_time();
    whole += feed_.interop_time();
    whole += time.step;
    draw_.add(feed_.draw_time());
    resolve_.add(time.step);
    frame_.add(whole);
    measure(static_cast<std::size_t>(measured_frame), exposure);
  }

  void measure(std::size_t frame, float exposure) {
    const Extent output = scene_.plan.conditions.output;
    std::vector<float> rgba(static_cast<std::size_t>(output.area()) * 4);
    checked(scene_.stage.device().download(resolved_.view(), output, rgba.data()));
    const SceneTruth& truth = scene_.truth;
    tally_.add(tools::measured(output, std::move(rgba), exposure), truth.pictures[frame],
               frame > 0 ? &truth.pictures[frame - 1] : nullptr, truth.masks[frame]);
  }

  PartScene scene_;
  FrameFeed feed_;
  Contender contender_;
  Image resolved_;
  QualityTally tally_;
  Times draw_, resolve_, frame_;
  Extent render_;
};

// Measures frames one after the other, so that the shadow map keeps its size from one to the next. The measured ones
// are those of the truth, after the plan's warm-up. One thread, that of the GL context.
PartRow measure_row(const PartScene& scene, const PartCase& wanted) {
  auto run = RowRun::create(scene, wanted);
  run.run();
  return run.row(wanted);
}

void compare(PartRow& row, const PartRow& base) {
  row.saved_processor_ms = base.frame.processor_ms - row.frame.processor_ms;
  if (row.saved_processor_ms > kLeastSaving * base.frame.processor_ms)
    row.flip_per_ms = (row.flip - base.flip) / row.saved_processor_ms;
}

}  // namespace

std::string text_of(const PartsResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}, {} -> {}x{}, {}, {}, load {:.1f} to {:.1f}, {} frames of each\n\n", result.scene,
                 result.method, result.output[0], result.output[1], result.machine.cl_device,
                 result.machine.gl_renderer, result.machine.load_before, result.machine.load_after,
                 result.frames);
  fmt::format_to(out, "{:<12}{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>9}{:>9}{:>10}{:>13}\n", "part", "scale",
                 "draw", "resolve", "frame", "draw", "resolve", "frame", "PSNR", "FLIP", "saves",
                 "FLIP a ms");
  for (const PartRow& row : result.rows) {
    const std::string exchange = row.flip_per_ms ? fmt::format("{:+.6f}", *row.flip_per_ms) : "-";
    fmt::format_to(
        out, "{:<12}{:<10}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>8.2f}{:>9.2f}{:>9.4f}{:>10.2f}{:>13}\n",
        row.part, row.scale, row.draw.ms, row.resolve.ms, row.frame.ms, row.draw.processor_ms,
        row.resolve.processor_ms, row.frame.processor_ms, row.psnr, row.flip, row.saved_processor_ms,
        exchange);
  }
  text +=
      "\nms, medians: first by the host's clock, then of the processor, all threads; \"saves\" and \"FLIP a "
      "ms\" "
      "are\nof the latter, against the first row: the mean FLIP that a saved millisecond costs.\n";
  return text;
}

std::string csv_of(const PartsResult& result) {
  std::string text =
      "part,scale,draw_ms,resolve_ms,frame_ms,draw_processor_ms,resolve_processor_ms,frame_processor_ms,psnr,"
      "flip\n";
  for (const PartRow& row : result.rows) {
    text += fmt::format("{},{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g}\n", row.part, row.scale, row.draw.ms,
                        row.resolve.ms, row.frame.ms, row.draw.processor_ms, row.resolve.processor_ms,
                        row.frame.processor_ms, row.psnr, row.flip);
  }
  return text;
}

PartsResult run_parts(const BenchOptions& options) {
  auto plan = checked(single_plan_from(options));
  const BenchMethod& method = plan.methods.front();
  auto stage = open_stage(options, plan.scenes.front(), sequence_for(plan, 1, method));
  const scenes::Scene& scene = stage->scene();
  plan.conditions = conditions_for(plan.conditions, scene);
  PartsResult result{facts_of(options, *stage),
                     plan.scenes.front(),
                     method.name,
                     {options.output.width, options.output.height},
                     plan.conditions.frames,
                     {}};
  const auto truth = make_truth(stage->renderer(), scene, result.machine.gl_version, plan.conditions);
  const auto cases = cases_of(plan, options.parts_bench.base_scale, static_cast<bool>(scene.particles));
  using Show = tools::Progress::Show;
  tools::Progress progress("measuring", static_cast<std::int64_t>(cases.size()),
                           options.quiet ? Show::kNever : Show::kOnTerminal);
  for (const PartCase& wanted : cases) {
    auto row = measure_row({*stage, plan, truth}, wanted);
    result.rows.push_back(std::move(row));
    compare(result.rows.back(), result.rows.front());
    progress.update(static_cast<std::int64_t>(result.rows.size()), wanted.part + " at " + wanted.label);
  }
  result.machine.load_after = load_of_last_minute();
  return result;
}

}  // namespace quincunx::bench
