// SPDX-License-Identifier: MIT
#include "bench/speed_error/two_way_run.h"

#include <utility>

#include "bench/speed_error/contender.h"
#include "src/passes/two_way.h"

namespace quincunx::bench {
namespace {

constexpr int kAhead = 8;  // as --two-way has it by itself

struct KeptFrame {
  KeptHistory history;
  FrameInputs inputs;  // without images
};

FrameInputs without_images(FrameInputs inputs) {
  inputs.colour = inputs.velocity = inputs.depth = inputs.reactive = {};
  return inputs;
}

// A direction of the frames, and the service that accumulates them.
struct Direction {
  FrameFeed feed;
  ResolveService service;

  static Result<Direction> create(const scenes::FrameSource& stage, const scenes::SequenceSettings& sequence,
                                  ResolveSettings resolve, std::optional<int> noise) {
    resolve.output.present = false;
    auto feed = FrameFeed::create(stage, sequence, {resolve}, std::nullopt, std::nullopt, noise);
    if (!feed.ok()) return feed.status();
    auto service = TwoWay::create(stage.device(), feed->plans().front());
    if (!service.ok()) return service.status();
    return Direction{std::move(feed).value(), std::move(service).value()};
  }

  // Adds the next frame; `kept` null: it is not measured. Gives its inputs without images.
  Result<FrameInputs> add(bool merges, KeptHistory* kept) {
    const auto inputs = feed.next();
    if (!inputs.ok()) return inputs.status();
    const bool both = merges && !inputs->reset;
    const FrameReport report = TwoWay::add(service, inputs.value(), both, both || !merges ? kept : nullptr);
    if (!report.ok()) return report.status;
    if (Status status = service.finish(); !status.ok()) return status;
    feed.release();
    return without_images(inputs.value());
  }
};

Result<std::vector<std::vector<float>>> show(ResolveService& service, const std::vector<KeptFrame>& frames) {
  const Extent output = service.plan().settings.output_extent;
  auto image = service.device().allocate(output, service.plan().settings.output.linear);
  if (!image.ok()) return image.status();
  std::vector<std::vector<float>> pictures;
  for (const KeptFrame& frame : frames) {
    const FrameReport report = TwoWay::show(service, frame.inputs, frame.history, {.linear = image->view()});
    if (!report.ok()) return report.status;
    pictures.emplace_back(static_cast<std::size_t>(output.area()) * 4);
    if (Status status = service.device().download(image->view(), output, pictures.back().data());
        !status.ok())
      return status;
  }
  return pictures;
}

}  // namespace

Result<std::vector<std::vector<float>>> two_way_pictures(const scenes::FrameSource& stage,
                                                         const BenchPlan& plan, double scale,
                                                         const BenchMethod& method) {
  const int before = plan.conditions.warm_up - first_frame_for(plan.conditions, method);
  const int measured = plan.conditions.frames;
  scenes::SequenceSettings sequence = sequence_for(plan, scale, method);
  sequence.frames = before + measured + kAhead;
  auto forward = Direction::create(stage, sequence, method.resolve, plan.conditions.noise);
  if (!forward.ok()) return forward.status();
  std::vector<KeptFrame> frames(static_cast<std::size_t>(measured));
  for (int i = -before; i < measured + kAhead; ++i) {
    const bool keeps = i >= 0 && i < measured;
    KeptFrame unused, &frame = keeps ? frames[static_cast<std::size_t>(i)] : unused;
    auto inputs = forward->add(false, keeps ? &frame.history : nullptr);
    if (!inputs.ok()) return inputs.status();
    frame.inputs = std::move(inputs).value();
  }
  sequence.backwards = true;
  auto backward = Direction::create(stage, sequence, method.resolve, plan.conditions.noise);
  if (!backward.ok()) return backward.status();
  for (int i = measured + kAhead; i-- > 0;) {
    KeptHistory* const kept = i < measured ? &frames[static_cast<std::size_t>(i)].history : nullptr;
    if (const auto inputs = backward->add(kept != nullptr, kept); !inputs.ok()) return inputs.status();
    if (i + 1 < measured + kAhead) continue;
    if (Status status = TwoWay::turn(backward->service, forward->service); !status.ok()) return status;
  }
  return show(forward->service, frames);
}

}  // namespace quincunx::bench
