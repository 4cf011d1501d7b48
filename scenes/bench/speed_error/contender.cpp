// SPDX-License-Identifier: MIT
#include "bench/speed_error/contender.h"

#include <string_view>

namespace quincunx::bench {

Result<Contender> Contender::create(const Device& device, const ResolvePlan& plan) {
  auto service = ResolveService::create(device, plan);
  if (!service.ok()) return service.status();
  return Contender(std::move(service).value());
}

Result<DispatchTime> Contender::dispatch(const FrameInputs& inputs, const FocusInputs* focus,
                                         const FrameOutputs& outputs) {
  DispatchTime time;
  const StepClock clock;
  const FrameReport accepted =
      focus != nullptr ? service_.dispatch(inputs, *focus, outputs) : service_.dispatch(inputs, outputs);
  if (!accepted.ok()) return accepted.status;
  if (Status status = service_.finish(); !status.ok()) return status;
  time.step = clock.elapsed();
  const auto report = service_.next_completed();
  if (!report) return Status::device("a finished frame has no report");
  for (int i = 0; i < report->pass_count; ++i) {
    const PassReport& pass = report->passes[i];
    if (std::string_view(pass.kernel) == "present") continue;
    time.resolve_ms += pass.ms;
    time.bytes += pass.bytes;
    time.kernels += (time.kernels.empty() ? "" : " + ") + name_of(pass);
  }
  return time;
}

void Contender::begin_round() {
  ms_.emplace_back();
  processor_ms_.emplace_back();
}

void Contender::keep(const DispatchTime& time) {
  ms_.back().push_back(time.resolve_ms);
  processor_ms_.back().push_back(time.step.processor_ms);
  bytes_ = time.bytes;
  kernels_ = time.kernels;
}

Speed Contender::speed(const Rounds& copy_ms, const Rounds& copy_processor_ms) const {
  Speed speed;
  speed.ms = spread_of(ms_);
  speed.least_ms = least_median_of(ms_);
  speed.processor_ms = spread_of(processor_ms_);
  speed.ratio = ratio_of(ms_, copy_ms);
  speed.processor_ratio = ratio_of(processor_ms_, copy_processor_ms);
  speed.bytes = bytes_;
  speed.gigabytes_per_second = static_cast<double>(bytes_) / speed.ms.median * 1e-6;
  speed.kernels = kernels_;
  return speed;
}

}  // namespace quincunx::bench
