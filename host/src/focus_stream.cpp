// SPDX-License-Identifier: MIT
#include "focus_stream.h"

namespace quincunx {

Status FocusStream::check_history(const FocusInputs& focus) const {
  const Status status = frames_.check_history(focus.frame);
  return status.ok() ? status : Status::invalid("of focus.frame: " + std::string(status.message()));
}

void FocusStream::run(const FocusInputs& focus, Counter counter, FrameReport& report, cl::Event* events) {
  const FrameOutputs outputs = outputs_for(plan(), picture_.view(), {});
  chain().run(frames_.frame(focus.frame, outputs, counter), outputs, report, events);
  for (int i = 0; i < report.pass_count; ++i)
    report.passes[static_cast<std::size_t>(i)].in_focus = true;
  report.focused = true;
  frames_.keep(focus.frame);
}

void FocusStream::lay_over(PassFrame& frame, const FocusInputs& focus) const {
  frame.focus = &focus;
  frame[Resource::kFocus] = picture_.view();
  frame[Resource::kFocusMask] = focus.mask;
}

}  // namespace quincunx
