// SPDX-License-Identifier: MIT
#include "bench/parts/parts_rows.h"

#include <utility>

#include "bench/speed_error/bench_quality.h"
#include "bench/speed_error/contender.h"

namespace quincunx::bench {
namespace {

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
  static Result<RowRun> create(const PartScene& scene, const PartCase& wanted) {
    const BenchMethod& method = scene.plan.methods.front();
    ResolveSettings resolve = method.resolve;
    resolve.output.present = false;
    auto feed = FrameFeed::create(scene.stage, sequence_for(scene.plan, wanted.scale, method), {resolve},
                                  wanted.parts);
    if (!feed.ok()) return feed.status();
    auto contender = Contender::create(scene.stage.device(), feed->plans().front());
    if (!contender.ok()) return contender.status();
    auto resolved = scene.stage.device().allocate(scene.plan.conditions.output, resolve.output.linear);
    if (!resolved.ok()) return resolved.status();
    return RowRun(scene, std::move(feed).value(), std::move(contender).value(), std::move(resolved).value());
  }

  Status run() {
    const Conditions& conditions = scene_.plan.conditions;
    const int first = first_frame_for(conditions, scene_.plan.methods.front());
    for (int frame = first; frame < conditions.warm_up + conditions.frames; ++frame) {
      if (Status status = run_frame(frame - conditions.warm_up); !status.ok()) return status;
    }
    return {};
  }

  PartRow row(const PartCase& wanted) const {
    const Quality quality = tally_.quality();
    return {.part = wanted.part,
            .scale = wanted.label,
            .draw = draw_.median(),
            .resolve = resolve_.median(),
            .frame = frame_.median(),
            .psnr = quality.psnr,
            .flip = quality.flip,
            .render = render_};
  }

 private:
  RowRun(const PartScene& scene, FrameFeed feed, Contender contender, Image resolved)
      : scene_(scene),
        feed_(std::move(feed)),
        contender_(std::move(contender)),
        resolved_(std::move(resolved)) {}

  // `measured`: which of the measured frames; below 0: it warms up.
  Status run_frame(int measured_frame) {
    auto inputs = feed_.next();
    if (!inputs.ok()) return inputs.status();
    auto time = contender_.dispatch(inputs.value(), nullptr, {.linear = resolved_.view()});
    if (!time.ok()) return time.status();
    render_ = inputs->render_extent;
    const float exposure = inputs->exposure;
    feed_.release();
    if (measured_frame < 0) return {};
    StepTime whole = feed_.draw_time();
    whole += feed_.interop_time();
    whole += time->step;
    draw_.add(feed_.draw_time());
    resolve_.add(time->step);
    frame_.add(whole);
    return measure(static_cast<std::size_t>(measured_frame), exposure);
  }

  Status measure(std::size_t frame, float exposure) {
    const Extent output = scene_.plan.conditions.output;
    std::vector<float> rgba(static_cast<std::size_t>(output.area()) * 4);
    const Status read = scene_.stage.device().download(resolved_.view(), output, rgba.data());
    if (!read.ok()) return read;
    const SceneTruth& truth = scene_.truth;
    tally_.add(tools::measured(output, std::move(rgba), exposure), truth.pictures[frame],
               frame > 0 ? &truth.pictures[frame - 1] : nullptr, truth.masks[frame]);
    return {};
  }

  PartScene scene_;
  FrameFeed feed_;
  Contender contender_;
  Image resolved_;
  QualityTally tally_;
  Times draw_, resolve_, frame_;
  Extent render_;
};

}  // namespace

Result<PartRow> measure_row(const PartScene& scene, const PartCase& wanted) {
  auto run = RowRun::create(scene, wanted);
  if (!run.ok()) return run.status();
  if (Status status = run->run(); !status.ok()) return status;
  return run->row(wanted);
}

}  // namespace quincunx::bench
