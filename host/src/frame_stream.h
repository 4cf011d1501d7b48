// SPDX-License-Identifier: MIT
// FrameStream: frames of one plan after each other: its passes, and the frame before. The service runs one for the
// picture and, where there is a focus, one for that.
//
// Not thread-safe. May throw what PassChain throws.
#pragma once

#include "pass_chain.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class FrameStream {
 public:
  // The plan is one that plan_for() has made.
  FrameStream(const Device& device, const ResolvePlan& plan);

  const ResolvePlan& plan() const { return plan_; }
  PassChain& chain() { return chain_; }
  const PassChain& chain() const { return chain_; }

  // Whether the frame before counts in this one. A dense frame has left no history.
  bool has_history(const FrameInputs& inputs) const { return leaves_history() && !inputs.reset; }
  // Whether the next frame can find a history.
  bool leaves_history() const {
    return has_previous_ && plan_.reads_history(previous_.render, previous_.output);
  }
  // Of the last frame's picture.
  Extent last_output() const { return chain_.output_of(previous_); }

  // What validate() cannot see: the previous frame must still be where it was.
  Status check_history(const FrameInputs& inputs) const;

  // As PassChain::frame().
  PassFrame frame(const FrameInputs& inputs, const FrameOutputs& outputs, Counter counter) {
    return chain_.frame(inputs, has_history(inputs) ? &previous_ : nullptr, outputs, counter);
  }

  // From now on the frame before is this one, or none.
  void keep(const FrameInputs& inputs) {
    previous_ = inputs;
    has_previous_ = true;
  }
  void forget() { has_previous_ = false; }

 private:
  ResolvePlan plan_;
  PassChain chain_;
  FrameInputs previous_;
  bool has_previous_ = false;
};

}  // namespace quincunx
