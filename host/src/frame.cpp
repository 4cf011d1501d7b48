// SPDX-License-Identifier: MIT
#include "quincunx/frame.h"

#include "quincunx/resolve_plan.h"

namespace quincunx {

FrameOutputs outputs_for(const ResolvePlan& plan, const ImageView& linear, const ImageView& presented) {
  FrameOutputs outputs{.presented = presented};
  (plan.is_dual() ? outputs.displayed : plan.blurs() ? outputs.blurred : outputs.resolved) = linear;
  return outputs;
}

std::string name_of(const PassReport& pass) {
  return (pass.in_focus ? "focus: " : "") + std::string(pass.kernel);
}

}  // namespace quincunx
