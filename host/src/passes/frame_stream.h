// SPDX-License-Identifier: MIT
// FrameStream: frames of one plan after each other: its passes, and the frame before. The service runs one for the
// picture and, where there is a focus, a FocusStream for its region.
//
// Not thread-safe. May throw what PassChain throws.
#pragma once

#include "passes/pass_chain.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class FrameStream {
 public:
  // The plan is one that plan_for() has made. `two_way`: as PlanFacts has it.
  FrameStream(const Device& device, const ResolvePlan& plan, bool two_way = false);

  const ResolvePlan& plan() const { return plan_; }
  PassChain& chain() { return chain_; }
  const PassChain& chain() const { return chain_; }

  // Whether the frame before counts in this one. A dense frame has left no history.
  bool has_history(const FrameInputs& inputs) const { return leaves_history() && !inputs.reset; }
  // Whether the next frame can find a history.
  bool leaves_history() const {
    return has_previous_ && plan_.reads_history(previous_.render_extent, previous_.output_extent);
  }
  // Returns the extent of the last frame's picture.
  Extent last_output() const { return chain_.output_of(previous_); }

  // Checks what validate() cannot see: the previous frame must still be where it was.
  Status check_history(const FrameInputs& inputs) const;

  // As PassChain::frame(), of inputs in the caller's conventions.
  PassFrame frame(const FrameInputs& inputs, const FrameOutputs& outputs, Counter counter);

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

// The frames of a focus's region, and the picture that is made of them.
class FocusStream {
 public:
  // `plan` is a plan's focus_plan().
  FocusStream(const Device& device, const ResolvePlan& plan)
      : frames_(device, plan),
        picture_(allocate_image(device, plan.settings.output_extent, plan.settings.output.linear)) {}

  const ResolvePlan& plan() const { return frames_.plan(); }
  PassChain& chain() { return frames_.chain(); }
  void forget() { frames_.forget(); }

  // As FrameStream::check_history().
  Status check_history(const FocusInputs& focus) const;

  // Enqueues the region's passes, as PassChain::run().
  void run(const FocusInputs& focus, Counter counter, FrameReport& report, cl::Event* events);

  // Binds the region's picture to the frame that it is laid over; `focus` outlives that frame.
  void lay_over(PassFrame& frame, const FocusInputs& focus) const;

 private:
  FrameStream frames_;
  Image picture_;
};

}  // namespace quincunx
