// SPDX-License-Identifier: MIT
#include "frame_stream.h"

#include <fmt/format.h>

namespace quincunx {

FrameStream::FrameStream(const Device& device, const ResolvePlan& plan)
    : plan_(plan), chain_(device, PlanFacts(plan.needs, plan.settings)) {}

// Of the images that change with every frame, one that is read again tells.
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

}  // namespace quincunx
