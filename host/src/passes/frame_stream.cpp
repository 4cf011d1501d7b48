// SPDX-License-Identifier: MIT
#include "passes/frame_stream.h"

#include <fmt/format.h>

#include "plan/native_frame.h"

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

// Looks at one of the images that change with every frame and are read again.
Status FrameStream::check_history(const FrameInputs& inputs) const {
  if (!has_history(inputs) || !plan_.keeps_previous_frame()) return {};
  const auto is_shared = [this](Resource resource, const ImageView& now, const ImageView& before) {
    return chain_.has(previous_of(resource)) && now.memory == before.memory && now.offset == before.offset;
  };
  const char* shared = nullptr;
  if (is_shared(Resource::kColour, inputs.colour, previous_.colour)) {
    shared = name_of(Resource::kColour);
  } else if (plan_.accumulates() && is_shared(Resource::kDepth, inputs.depth, previous_.depth)) {
    shared = name_of(Resource::kDepth);
  }
  if (shared == nullptr) return {};
  return Status::invalid(
      fmt::format("{} is the memory of the previous frame, which this dispatch reads as history; give "
                  "consecutive frames different memory, or set reset",
                  shared));
}

PassFrame FrameStream::frame(const FrameInputs& inputs, const FrameOutputs& outputs, Counter counter) {
  const FrameInputs current = native_inputs(plan_.settings, inputs);
  if (!has_previous_) return chain_.frame(current, nullptr, outputs, counter);
  const FrameInputs previous = native_inputs(plan_.settings, previous_);
  PassFrame made = chain_.frame(current, has_history(inputs) ? &previous : nullptr, outputs, counter);
  made.jitter_motion = jitter_motion(current, previous);
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
