// SPDX-License-Identifier: MIT
// Contender: one method with its own service and history, and what it has cost so far.
#pragma once

#include <string>

#include "bench/speed_error/bench_statistics.h"
#include "bench/speed_error/frame_feed.h"
#include "quincunx/resolve_service.h"

namespace quincunx::bench {

// Of one dispatch, waited for.
struct DispatchTime {
  StepTime step;            // around dispatch and wait
  double resolve_ms = 0;    // OpenCL events of all passes but present
  std::uint64_t bytes = 0;  // of the same passes
  std::string kernels;
};

class Contender {
 public:
  static Result<Contender> create(const Device& device, const ResolvePlan& plan);

  // `focus` null: none.
  Result<DispatchTime> dispatch(const FrameInputs& inputs, const FocusInputs* focus,
                                const FrameOutputs& outputs);

  const ResolvePlan& plan() const { return service_.plan(); }

  // Keeps a time under the latest round.
  void begin_round();
  void keep(const DispatchTime& time);

  // `copy_ms`, `copy_processor_ms`: of the float4 copy in the same rounds.
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
