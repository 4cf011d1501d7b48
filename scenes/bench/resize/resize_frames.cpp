// SPDX-License-Identifier: MIT
#include "bench/resize/resize_frames.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "bench/speed_error/contender.h"

namespace quincunx::bench {
namespace {

class Kind {
 public:
  static Result<std::unique_ptr<Kind>> create(const scenes::FrameSource& stage,
                                              const scenes::SequenceSettings& sequence,
                                              ResolveSettings resolve, Targets targets) {
    resolve.targets = targets;
    auto feed = FrameFeed::create(stage, sequence, {resolve});
    if (!feed.ok()) return feed.status();
    auto contender = Contender::create(stage.device(), feed->plans().front());
    if (!contender.ok()) return contender.status();
    return std::unique_ptr<Kind>(new Kind(targets, std::move(feed).value(), std::move(contender).value()));
  }

  Status run_frame(bool keep) {
    auto inputs = feed_.next();
    if (!inputs.ok()) return inputs.status();
    auto presented = feed_.bridge().begin_present();
    if (!presented.ok()) return presented.status();
    auto time = contender_.dispatch(inputs.value(), nullptr, {.presented = presented.value()});
    if (!time.ok()) return time.status();
    const StepClock clock;
    if (Status status = feed_.bridge().present(); !status.ok()) return status;
    StepTime interop = feed_.interop_time();
    interop += clock.elapsed();
    render_ = inputs->render;
    feed_.release();
    if (keep) add(interop, time->step);
    return {};
  }

  TargetFrames row(const std::string& scale) const {
    const gl::Bridge::Memory memory = feed_.bridge().memory();
    return {.scale = scale,
            .targets = targets_,
            .render = render_,
            .draw_ms = quantiles_of(draw_ms_),
            .interop_ms = quantiles_of(interop_ms_),
            .resolve_ms = quantiles_of(resolve_ms_),
            .frame_ms = quantiles_of(frame_ms_),
            .processor_ms = median_of(processor_ms_),
            .gl_bytes = memory.gl_bytes,
            .opencl_bytes = memory.opencl_bytes};
  }

 private:
  Kind(Targets targets, FrameFeed feed, Contender contender)
      : targets_(targets), feed_(std::move(feed)), contender_(std::move(contender)) {}

  void add(const StepTime& interop, const StepTime& resolve) {
    StepTime whole = feed_.draw_time();
    whole += interop;
    whole += resolve;
    draw_ms_.push_back(feed_.draw_time().ms);
    interop_ms_.push_back(interop.ms);
    resolve_ms_.push_back(resolve.ms);
    frame_ms_.push_back(whole.ms);
    processor_ms_.push_back(whole.processor_ms);
  }

  Targets targets_;
  FrameFeed feed_;
  Contender contender_;
  Extent render_;
  Samples draw_ms_, interop_ms_, resolve_ms_, frame_ms_, processor_ms_;
};

Result<scenes::SequenceSettings> sequence_of(const TargetFramesSettings& settings) {
  const auto scale = static_cast<float>(settings.scale);
  auto path = settings.scale_path.empty() ? scenes::ScalePath::fixed({scale, scale})
                                          : scenes::ScalePath::parse(settings.scale_path, settings.seed);
  if (!path.ok()) return path.status();
  scenes::SequenceSettings sequence;
  sequence.output = settings.output;
  sequence.scale_path = path.value();
  sequence.jitter = settings.method.jitter;
  sequence.frames = settings.warm_up + settings.frames;
  sequence.fps = settings.fps;
  sequence.detail = settings.method.detail;
  return sequence;
}

}  // namespace

Result<std::vector<TargetFrames>> measure_frames(const scenes::FrameSource& stage,
                                                 const TargetFramesSettings& settings) {
  const auto sequence = sequence_of(settings);
  if (!sequence.ok()) return sequence.status();
  std::vector<std::unique_ptr<Kind>> kinds;
  for (const Targets targets : {Targets::kViewport, Targets::kPlaced}) {
    auto kind = Kind::create(stage, sequence.value(), settings.method.resolve, targets);
    if (!kind.ok()) return kind.status();
    kinds.push_back(std::move(kind).value());
  }
  for (int frame = 0; frame < settings.warm_up + settings.frames; ++frame) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      Kind& kind = *kinds[(i + static_cast<std::size_t>(frame)) % kinds.size()];
      if (Status status = kind.run_frame(frame >= settings.warm_up); !status.ok()) return status;
    }
  }
  const std::string scale = settings.scale_path.empty() ? fmt::format("{:g}", settings.scale) : "random";
  std::vector<TargetFrames> rows;
  for (const auto& kind : kinds)
    rows.push_back(kind->row(scale));
  return rows;
}

}  // namespace quincunx::bench
