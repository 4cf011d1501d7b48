// SPDX-License-Identifier: MIT
#include "programs/method_resolves.h"

#include <algorithm>
#include <utility>

#include "programs/picture_options.h"
#include "tools/program/method_names.h"

namespace quincunx::scenes {
namespace {

void add_passes(FrameReport& report, const FrameReport& other) {
  const int room = FrameReport::kMaxPasses - report.pass_count;
  const int count = std::min(other.pass_count, room);
  std::copy_n(other.passes.begin(), count, report.passes.begin() + report.pass_count);
  report.pass_count += count;
}

}  // namespace

ResolveSettings with_method(const ResolveSettings& settings, const FrontMethod& method) {
  ResolveSettings chosen = settings;
  tools::choose(chosen, tools::method_choices().at(name_of(method)));
  return chosen;
}

// As long as the old method is shown, the new one takes what suits that.
MethodSampling sampling_for(const QualityChoice& choice) {
  const Method shown = choice.fading_from.value_or(choice.method).method;
  const tools::Jitter jitter = jitter_for(shown);
  return {jitter, lod_bias_for(shown, jitter)};
}

Result<MethodResolves> MethodResolves::create(FrameSource& source, const ResolveSettings& settings,
                                              std::vector<FrontMethod> methods) {
  std::vector<ResolveSettings> resolves;
  for (const FrontMethod& method : methods)
    resolves.push_back(with_method(settings, method));
  if (methods.empty()) resolves.push_back(settings);
  const auto plans = source.connect_all(std::move(resolves));
  if (!plans.ok()) return plans.status();
  std::vector<ResolveService> services;
  for (const ResolvePlan& plan : plans.value()) {
    auto service = ResolveService::create(source.device(), plan);
    if (!service.ok()) return service.status();
    services.push_back(std::move(service).value());
  }
  Image unseen;
  if (services.size() > 1) {
    const ResolveSettings& planned = plans->front().settings;
    auto image = source.device().allocate(planned.output, planned.resolved);
    if (!image.ok()) return image.status();
    unseen = std::move(image).value();
  }
  return MethodResolves(std::move(methods), std::move(services), std::move(unseen));
}

MethodResolves::MethodResolves(std::vector<FrontMethod> methods, std::vector<ResolveService> services,
                               Image unseen)
    : methods_(std::move(methods)),
      services_(std::move(services)),
      last_frame_(services_.size()),
      unseen_(std::move(unseen)) {}

std::size_t MethodResolves::index_of(const FrontMethod& method) const {
  return static_cast<std::size_t>(std::find(methods_.begin(), methods_.end(), method) - methods_.begin());
}

FrameReport MethodResolves::dispatch(const FrameSource& source, std::size_t method, const FrameInputs& inputs,
                                     const FrameOutputs& outputs) {
  FrameInputs own = inputs;
  own.reset |= !last_frame_[method] || *last_frame_[method] + 1 != inputs.frame_index;
  last_frame_[method] = inputs.frame_index;
  return source.dispatch(services_[method], own, outputs);
}

FrameReport MethodResolves::dispatch(const FrameSource& source, const FrameInputs& inputs,
                                     const FrameOutputs& outputs,
                                     const std::optional<QualityChoice>& choice) {
  Running frame;
  if (choice) frame.shown = index_of(choice->fading_from.value_or(choice->method));
  if (choice && choice->fading_from) frame.unseen = index_of(choice->method);
  FrameReport report = dispatch(source, frame.shown, inputs, outputs);
  if (!report.ok()) return report;
  if (frame.unseen) {
    const FrameReport unseen = dispatch(source, *frame.unseen, inputs, {.resolved = unseen_.view()});
    if (!unseen.ok()) return unseen;
  }
  running_.push_back(frame);
  return report;
}

std::optional<FrameReport> MethodResolves::next_completed() {
  if (running_.empty()) return std::nullopt;
  Running& oldest = running_.front();
  if (!oldest.shown_report) oldest.shown_report = services_[oldest.shown].next_completed();
  if (oldest.unseen && !oldest.unseen_report)
    oldest.unseen_report = services_[*oldest.unseen].next_completed();
  if (!oldest.shown_report || (oldest.unseen && !oldest.unseen_report)) return std::nullopt;
  FrameReport report = *oldest.shown_report;
  if (oldest.unseen_report) add_passes(report, *oldest.unseen_report);
  running_.pop_front();
  return report;
}

void MethodResolves::allow_timing_waits(bool allow) {
  for (ResolveService& service : services_)
    service.allow_timing_waits(allow);
}

// They share one queue.
Status MethodResolves::finish() {
  return services_.front().finish();
}

}  // namespace quincunx::scenes
