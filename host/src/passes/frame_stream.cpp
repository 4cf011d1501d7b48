// SPDX-License-Identifier: MIT
#include "passes/frame_stream.h"

#include <fmt/format.h>

#include "plan/inputs.h"

namespace quincunx {

namespace {

PlanFacts facts_of(const ResolvePlan& plan, bool two_way) {
  PlanFacts facts(plan.needs, plan.settings);
  facts.two_way = two_way;
  return facts;
}

}  // namespace

FrameStream::FrameStream(const Device& device, const ResolvePlan& plan, bool two_way)
    : plan_(plan), chain_(device, facts_of(plan, two_way)) {}

Status FrameStream::check_history(const FrameInputs& inputs) const {
  if (!has_history(inputs)) return {};
  for (const PlannedBuffer& buffer : plan_.buffers) {
    if (buffer.input == nullptr || is_input(buffer)) continue;
    const ImageView& now = inputs.*buffer.input;
    const ImageView& before = previous_.*buffer.input;
    if (now.memory != before.memory || now.offset != before.offset) continue;
    return Status::invalid(
        fmt::format("{} is the memory of the previous frame, which this dispatch reads as history; give "
                    "consecutive frames different memory, or set reset",
                    input_of(buffer).name));
  }
  return {};
}

PassFrame FrameStream::frame(const FrameInputs& inputs, const FrameOutputs& outputs, Counter counter) {
  const FrameInputs native = native_inputs(plan_.settings, inputs);
  if (!has_previous_) return chain_.frame(native, nullptr, outputs, counter);
  const FrameInputs previous = native_inputs(plan_.settings, previous_);
  PassFrame made = chain_.frame(native, has_history(inputs) ? &previous : nullptr, outputs, counter);
  made.jitter_motion = jitter_motion(native, previous);
  return made;
}

Status FocusStream::check_history(const FocusInputs& focus) const {
  const Status status = frames_.check_history(focus.frame);
  return status.ok() ? status : Status::invalid("of focus.frame: " + std::string(status.message()));
}

void FocusStream::run(const FocusInputs& focus, Counter counter, FrameReport& report, cl::Event* events) {
  const FrameOutputs outputs{.linear = picture_.view()};
  chain().run(frames_.frame(focus.frame, outputs, counter), outputs, report, events);
  for (PassReport& pass : report.passes)
    pass.in_focus = true;
  report.focused = true;
  frames_.keep(focus.frame);
}

void FocusStream::lay_over(PassFrame& frame, const FocusInputs& focus) const {
  frame.focus = &focus;
  frame[Resource::kFocus] = picture_.view();
  frame[Resource::kFocusMask] = focus.mask;
}

}  // namespace quincunx
