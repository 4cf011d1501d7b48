// SPDX-License-Identifier: MIT
#include "quincunx/frame.h"

#include "quincunx/resolve_plan.h"

namespace quincunx {

FrameOutputs outputs_for(const ResolvePlan& plan, const ImageView& linear, const ImageView& presented) {
  FrameOutputs outputs{.presented = presented};
  (plan.blurs() ? outputs.blurred : outputs.resolved) = linear;
  return outputs;
}

}  // namespace quincunx
