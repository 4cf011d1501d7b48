// SPDX-License-Identifier: MIT
#include "programs/front_feed.h"

#include <algorithm>

#include "programs/picture_options.h"
#include "tools/program/method_names.h"

namespace quincunx::scenes {
namespace {

std::vector<ResolveSettings> resolves_of(std::span<const std::string> methods) {
  std::vector<ResolveSettings> resolves;
  for (const std::string& name : methods) {
    tools::choose(resolves.emplace_back(), tools::method_choices().at(name));
    resolves.back().present = false;
    resolves.back().measures_content = true;
  }
  return resolves;
}

Result<SequenceSettings> sequence_of(const FrontFeed& feed, Method method) {
  const auto path = ScalePath::fixed({feed.scale, feed.scale});
  if (!path.ok()) return path.status();
  SequenceSettings sequence;
  sequence.output = feed.crop.extent;
  sequence.scale_path = path.value();
  sequence.jitter = jitter_for(method);
  sequence.frames = feed.warm_up + feed.frames;
  sequence.fps = feed.fps;
  sequence.start_seconds = feed.seconds - feed.warm_up / feed.fps;
  sequence.detail = texture_detail_for(method, sequence.jitter);
  return sequence;
}

FrameView view_of(FrameSource& source, const FrontFeed& feed, int index) {
  FrameView view = source.sequence().at(index);
  view.window = view.previous_window = feed.crop.window;
  view.aspect = feed.crop.aspect;
  if (feed.held) view.seconds = view.previous_seconds = feed.seconds;
  return view;
}

}  // namespace

PictureCrop PictureCrop::middle_of(Extent output, Extent most) {
  const Extent extent = {std::min(output.width, most.width), std::min(output.height, most.height)};
  const glm::dvec2 picture(output.width, output.height);
  const glm::dvec2 corner((output.width - extent.width) / 2, (output.height - extent.height) / 2);
  return {.extent = extent,
          .window = {corner / picture, glm::dvec2(extent.width, extent.height) / picture},
          .aspect = static_cast<float>(output.width) / static_cast<float>(output.height)};
}

Status run_feed(const FrameSource& stage, const FrontFeed& feed, std::span<const std::string> methods,
                const std::function<Status(const FrontFrame&)>& each) {
  const std::vector<ResolveSettings> resolves = resolves_of(methods);
  const auto sequence = sequence_of(feed, resolves.front().method);
  if (!sequence.ok()) return sequence.status();
  auto source = stage.another(sequence.value(), PartsSettings(), FocusOptions());
  if (!source.ok()) return source.status();
  const auto plans = source.value()->connect_all(resolves);
  if (!plans.ok()) return plans.status();
  auto resolved = stage.device().allocate(feed.crop.extent, ResolveSettings{}.resolved);
  if (!resolved.ok()) return resolved.status();
  std::vector<ResolveService> services;
  for (const ResolvePlan& plan : plans.value()) {
    auto service = ResolveService::create(stage.device(), plan);
    if (!service.ok()) return service.status();
    services.push_back(std::move(service).value());
    services.back().allow_timing_waits(true);
  }
  for (int index = 0; index < feed.warm_up + feed.frames; ++index) {
    const FrameView view = view_of(*source.value(), feed, index);
    if (Status status = source.value()->draw(index, view); !status.ok()) return status;
    const auto inputs = source.value()->acquire();
    if (!inputs.ok()) return inputs.status();
    for (std::size_t i = 0; i < services.size(); ++i) {
      const FrameReport accepted = services[i].dispatch(inputs.value(), {.resolved = resolved->view()});
      if (!accepted.ok()) return accepted.status;
      if (Status status = services[i].finish(); !status.ok()) return status;
      const auto report = services[i].next_completed();
      if (!report) return Status::device("a finished frame has no report");
      const Status status = each({i, index - feed.warm_up, *report, resolved->view()});
      if (!status.ok()) return status;
    }
    source.value()->release();
  }
  return {};
}

}  // namespace quincunx::scenes
