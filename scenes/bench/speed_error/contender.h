// SPDX-License-Identifier: MIT
// FrameFeed: frames of one jitter at one scale, drawn and handed to OpenCL step by step, each step timed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed_error/bench_statistics.h"
#include "frames/frame_source.h"
#include "quincunx/resolve_service.h"

namespace quincunx::bench {

struct StepTime {
  double ms = 0;            // host clock
  double processor_ms = 0;  // processor time of this process, all threads

  StepTime& operator+=(const StepTime& other);
};

// Measures from its construction on.
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
  // Draws from the scene, context and device of `stage`, for these resolves of each frame; the parts are the stage's
  // where none are given. `noise` gives light the noise of so many samples a pixel, the same in each feed; it needs
  // RGBA16F targets and no focus. Throws a Failure where a step fails, as all that follows here does.
  static FrameFeed create(const scenes::FrameSource& stage, const scenes::SequenceSettings& sequence,
                          const std::vector<ResolveSettings>& resolves,
                          const std::optional<scenes::PartsSettings>& parts = {},
                          const std::optional<scenes::FocusOptions>& focus = {},
                          std::optional<int> noise = {});

  const std::vector<ResolvePlan>& plans() const { return plans_; }

  // Draws the next frame of the sequence and waits until OpenCL can read it.
  FrameInputs next();
  const FocusInputs* focus() const { return source_->focus(); }  // as in the last next(); null: none
  void release() { source_->release(); }                         // the frame of the last next()

  // Return the times of the last next().
  const StepTime& draw_time() const { return draw_; }
  const StepTime& interop_time() const { return interop_; }

  std::uint64_t bytes_in() const { return source_->bytes_in(); }  // from GL to OpenCL in the last next()
  gl::Bridge& bridge() { return source_->bridge(); }
  const gl::Bridge& bridge() const { return source_->bridge(); }

 private:
  explicit FrameFeed(std::unique_ptr<scenes::FrameSource> source) : source_(std::move(source)) {}

  std::unique_ptr<scenes::FrameSource> source_;
  std::vector<ResolvePlan> plans_;
  std::optional<int> noise_;
  double fps_ = 0;
  std::int64_t drawn_ = 0;  // frames
  StepTime draw_;
  StepTime interop_;
};

// Contender: one method with its own service and history, and what it has cost so far.

// The time of one dispatch, waited for.
struct DispatchTime {
  StepTime step;            // around dispatch and wait
  double resolve_ms = 0;    // OpenCL events of all passes but present
  std::uint64_t bytes = 0;  // read and written by the same passes
  std::string kernels;
};

class Contender {
 public:
  static Contender create(const Device& device, const ResolvePlan& plan);

  // Resolves a frame and waits for it. `focus` may be null.
  DispatchTime dispatch(const FrameInputs& inputs, const FocusInputs* focus, const FrameOutputs& outputs);

  const ResolvePlan& plan() const { return service_.plan(); }

  // Begins a round; keeps a time in it.
  void begin_round();
  void keep(const DispatchTime& time);

  // Returns the speed in all rounds, by the times of the float4 copy in the same rounds.
  Speed speed(const Rounds& copy_ms, const Rounds& copy_processor_ms) const;

 private:
  explicit Contender(ResolveService service) : service_(std::move(service)) {}

  ResolveService service_;
  Rounds ms_;
  Rounds processor_ms_;
  std::uint64_t bytes_ = 0;
  std::string kernels_;
};

}  // namespace quincunx::bench
