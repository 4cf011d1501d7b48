// SPDX-License-Identifier: MIT
#include "bench/speed_error/frame_feed.h"

#include <epoxy/gl.h>

#include <chrono>

#include "bench/harness/process_clock.h"

namespace quincunx::bench {
namespace {

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
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

Result<FrameFeed> FrameFeed::create(const scenes::FrameSource& stage,
                                    const scenes::SequenceSettings& sequence,
                                    const std::vector<ResolveSettings>& resolves,
                                    const std::optional<scenes::PartsSettings>& parts,
                                    const std::optional<scenes::FocusOptions>& focus) {
  auto source = stage.another(sequence, parts, focus);
  if (!source.ok()) return source.status();
  FrameFeed feed(std::move(source).value());
  auto plans = feed.source_->connect_all(resolves);
  if (!plans.ok()) return plans.status();
  feed.plans_ = std::move(plans).value();
  return feed;
}

Result<FrameInputs> FrameFeed::next() {
  const StepClock draw;
  if (Status status = source_->begin(drawn_); !status.ok()) return status;
  glFinish();
  draw_ = draw.elapsed();
  const StepClock interop;
  if (Status status = source_->submit(); !status.ok()) return status;
  auto inputs = source_->acquire();
  interop_ = interop.elapsed();
  ++drawn_;
  return inputs;
}

}  // namespace quincunx::bench
