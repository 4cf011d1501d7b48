// SPDX-License-Identifier: MIT
// FrameFeed: frames of one jitter at one scale, drawn and handed to OpenCL step by step, each step timed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "programs/frame_source.h"
#include "quincunx/resolve_service.h"

namespace quincunx::bench {

struct StepTime {
  double ms = 0;            // host clock
  double processor_ms = 0;  // of this process, all threads

  StepTime& operator+=(const StepTime& other);
};

// Starts where it is made.
class StepClock {
 public:
  StepClock();
  StepTime elapsed() const;

 private:
  double start_ms_;
  double start_processor_ms_;
};

// One thread, that of the GL context.
class FrameFeed {
 public:
  // From the scene, context and device of `stage`, for these resolves of each frame; the parts are the stage's where
  // none are given.
  static Result<FrameFeed> create(const scenes::FrameSource& stage, const scenes::SequenceSettings& sequence,
                                  const std::vector<ResolveSettings>& resolves,
                                  const std::optional<scenes::PartsSettings>& parts = {},
                                  const std::optional<scenes::FocusOptions>& focus = {});

  const std::vector<ResolvePlan>& plans() const { return plans_; }

  // Draws the next frame of the sequence and waits until OpenCL can read it.
  Result<FrameInputs> next();
  const FocusInputs* focus() const { return source_->focus(); }  // of the last next(); null: none
  void release() { source_->release(); }                         // the frame of the last next()

  // Of the last next().
  const StepTime& draw_time() const { return draw_; }
  const StepTime& interop_time() const { return interop_; }

  std::uint64_t bytes_in() const { return source_->bytes_in(); }  // of the last next(), from GL to OpenCL
  gl::Bridge& bridge() { return source_->bridge(); }
  const gl::Bridge& bridge() const { return source_->bridge(); }

 private:
  explicit FrameFeed(std::unique_ptr<scenes::FrameSource> source) : source_(std::move(source)) {}

  std::unique_ptr<scenes::FrameSource> source_;
  std::vector<ResolvePlan> plans_;
  std::int64_t drawn_ = 0;  // frames
  StepTime draw_;
  StepTime interop_;
};

}  // namespace quincunx::bench
