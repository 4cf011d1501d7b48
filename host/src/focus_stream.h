// SPDX-License-Identifier: MIT
// FocusStream: the frames of a focus's region, and the picture that is made of them.
//
// Not thread-safe. May throw what PassChain throws.
#pragma once

#include "frame_stream.h"
#include "quincunx/focus.h"

namespace quincunx {

class FocusStream {
 public:
  // `plan` is a plan's focus_plan().
  FocusStream(const Device& device, const ResolvePlan& plan)
      : frames_(device, plan),
        picture_(allocate_image(device, plan.settings.output, plan.settings.resolved)) {}

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
