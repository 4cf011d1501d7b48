// SPDX-License-Identifier: MIT
#include "frames/method_resolves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "frames/picture_options.h"

namespace quincunx::scenes {
ResolveSettings method_settings(const ResolveSettings& settings, const MethodVariant& method) {
  ResolveSettings chosen = settings;
  apply(method, chosen);
  chosen.control.measures_content = chosen.control.fades = true;
  return chosen;
}

MethodSampling sampling_for(const QualityChoice& choice) {
  const Method method = choice.method.method;
  const Method from = choice.fading_from.value_or(choice.method).method;
  const tools::Jitter jitter = std::min(jitter_for(method), jitter_for(from));
  const auto weight = static_cast<float>(choice.weight);
  const TextureDetail to = texture_detail_for(method, jitter), left = texture_detail_for(from, jitter);
  return {.jitter = jitter,
          .detail = {.lod_bias = std::lerp(left.lod_bias, to.lod_bias, weight),
                     .follows_scale = std::lerp(left.follows_scale, to.follows_scale, weight)}};
}

Result<MethodResolves> MethodResolves::create(FrameSource& source, const ResolveSettings& settings,
                                              std::vector<MethodVariant> methods,
                                              std::vector<ResolveSettings> beside) {
  std::vector<ResolveSettings> resolves;
  for (const MethodVariant& method : methods)
    resolves.push_back(method_settings(settings, method));
  if (methods.empty()) resolves.push_back(settings);
  const std::size_t own = resolves.size();
  resolves.insert(resolves.end(), beside.begin(), beside.end());
  const auto plans = source.connect_all(std::move(resolves));
  if (!plans.ok()) return plans.status();
  std::vector<ResolveService> services;
  for (std::size_t i = 0; i < own; ++i) {
    auto service = ResolveService::create(source.device(), plans.value()[i]);
    if (!service.ok()) return service.status();
    services.push_back(std::move(service).value());
  }
  Image fading;
  if (services.size() > 1) {
    const ResolveSettings& planned = plans->front().settings;
    auto image = source.device().allocate(planned.output_extent, planned.output.linear);
    if (!image.ok()) return image.status();
    fading = std::move(image).value();
  }
  MethodResolves made(std::move(methods), std::move(services), std::move(fading));
  made.plans_beside_.assign(plans->begin() + static_cast<std::ptrdiff_t>(own), plans->end());
  return made;
}

MethodResolves::MethodResolves(std::vector<MethodVariant> methods, std::vector<ResolveService> services,
                               Image fading)
    : methods_(std::move(methods)),
      services_(std::move(services)),
      last_frame_(services_.size()),
      fading_(std::move(fading)) {}

std::size_t MethodResolves::index_of(const MethodVariant& method) const {
  return static_cast<std::size_t>(std::find(methods_.begin(), methods_.end(), method) - methods_.begin());
}

FrameReport dispatch(ResolveService& service, const FrameInputs& inputs, const FocusInputs* focus,
                     const FrameOutputs& outputs) {
  const bool has_focus = focus != nullptr && service.plan().has_focus();
  return has_focus ? service.dispatch(inputs, *focus, outputs) : service.dispatch(inputs, outputs);
}

FrameReport MethodResolves::dispatch(std::size_t method, FrameInputs inputs, const FocusInputs* focus,
                                     const FrameOutputs& outputs) {
  inputs.reset |= !last_frame_[method] || *last_frame_[method] + 1 != inputs.frame_index;
  last_frame_[method] = inputs.frame_index;
  return scenes::dispatch(services_[method], inputs, focus, outputs);
}

FrameReport MethodResolves::dispatch(FrameInputs inputs, const FocusInputs* focus,
                                     const FrameOutputs& outputs,
                                     const std::optional<QualityChoice>& choice) {
  Dispatched dispatched{
      .method = choice ? index_of(choice->method) : 0, .fading_from = {}, .cut = inputs.reset};
  if (choice && choice->fading_from) {
    dispatched.fading_from = index_of(*choice->fading_from);
    const FrameReport report = dispatch(*dispatched.fading_from, inputs, focus, {.linear = fading_.view()});
    if (!report.ok()) return report;
    inputs.fading_from = fading_.view();
    inputs.fade_weight = static_cast<float>(choice->weight);
  }
  const FrameReport report = dispatch(dispatched.method, inputs, focus, outputs);
  if (report.ok()) dispatched_.push_back(dispatched);
  return report;
}

std::optional<FrameReport> MethodResolves::next_completed() {
  if (dispatched_.empty()) return std::nullopt;
  Dispatched& oldest = dispatched_.front();
  if (!oldest.report) oldest.report = services_[oldest.method].next_completed();
  if (oldest.fading_from && !oldest.fading_report)
    oldest.fading_report = services_[*oldest.fading_from].next_completed();
  if (!oldest.report || (oldest.fading_from && !oldest.fading_report)) return std::nullopt;
  FrameReport report = *oldest.report;
  if (report.content) report.content->cut = oldest.cut;
  if (oldest.fading_report) {
    for (const PassReport& pass : oldest.fading_report->passes)
      report.passes.push_back(pass);
  }
  dispatched_.erase(dispatched_.begin());  // a few at most, and its memory stays
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
