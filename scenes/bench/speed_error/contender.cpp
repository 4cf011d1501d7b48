// SPDX-License-Identifier: MIT
#include "bench/speed_error/contender.h"

#include <epoxy/gl.h>
#include <half.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "bench/harness/measuring.h"
#include "random.h"

namespace quincunx::bench {
namespace {

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Multiplies the light of each pixel by a gamma factor of mean 1 and variance 1 / samples.
void add_noise(const Device& device, const FrameInputs& inputs, int samples, std::uint32_t time) {
  const Extent extent = inputs.render_extent;
  std::vector<std::uint16_t> colour(static_cast<std::size_t>(extent.area()) * 4);
  checked(device.download(inputs.colour, extent, colour.data()));
  for (std::size_t i = 0; i < colour.size(); i += 4) {
    scenes::Random random(time, i);
    float sum = 0;
    for (int sample = 0; sample < samples; ++sample)
      sum -= std::log(1 - random.unit());
    const float factor = sum / static_cast<float>(samples);
    for (std::size_t c = i; c < i + 3; ++c)
      colour[c] = imath_float_to_half(std::min(factor * imath_half_to_float(colour[c]), 65504.f));
  }
  checked(device.upload(inputs.colour, extent, colour.data()));
}

}  // namespace

StepTime& StepTime::operator+=(const StepTime& other) {
  ms += other.ms;
  processor_ms += other.processor_ms;
  return *this;
}

StepClock::StepClock() : start_ms_(now_ms()), start_processor_ms_(bench::processor_ms()) {}

StepTime StepClock::elapsed() const {
  return {now_ms() - start_ms_, bench::processor_ms() - start_processor_ms_};
}

FrameFeed FrameFeed::create(const scenes::FrameSource& stage, const scenes::SequenceSettings& sequence,
                            const std::vector<ResolveSettings>& resolves,
                            const std::optional<scenes::PartsSettings>& parts,
                            const std::optional<scenes::FocusOptions>& focus, std::optional<int> noise) {
  auto source = checked(stage.another(sequence, parts, focus));
  FrameFeed feed(std::move(source));
  feed.plans_ = checked(feed.source_->connect_all(resolves));
  feed.noise_ = noise;
  feed.fps_ = sequence.fps;
  return feed;
}

FrameInputs FrameFeed::next() {
  const StepClock draw;
  checked(source_->begin(drawn_));
  glFinish();
  draw_ = draw.elapsed();
  const StepClock interop;
  checked(source_->submit());
  FrameInputs inputs = checked(source_->acquire());
  interop_ = interop.elapsed();
  ++drawn_;
  if (!noise_) return inputs;
  // Quarters of frames, because scenes with cuts begin between two.
  const auto time = static_cast<std::uint32_t>(std::llround(4 * fps_ * source_->oldest().view.seconds));
  add_noise(source_->device(), inputs, *noise_, time);
  return inputs;
}

Contender Contender::create(const Device& device, const ResolvePlan& plan) {
  auto service = checked(ResolveService::create(device, plan));
  return Contender(std::move(service));
}

DispatchTime Contender::dispatch(const FrameInputs& inputs, const FocusInputs* focus,
                                 const FrameOutputs& outputs) {
  DispatchTime time;
  const StepClock clock;
  const FrameReport accepted =
      focus != nullptr ? service_.dispatch(inputs, *focus, outputs) : service_.dispatch(inputs, outputs);
  checked(accepted.status);
  checked(service_.finish());
  time.step = clock.elapsed();
  const auto report = service_.next_completed();
  if (!report) throw Failure(Status::device("a finished frame has no report"));
  for (const PassReport& pass : report->passes) {
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
