// SPDX-License-Identifier: MIT
// Parts of validate(), for callers who have no more: a frame without outputs; a focus, with the plan of its region.
#pragma once

#include "quincunx/advanced/focus.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx {

Status validate_inputs(const ResolvePlan& plan, const FrameInputs& inputs);

// Returns what validate() says of a focus. `region` is the plan's focus_plan(), null where it has none.
Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus);

}  // namespace quincunx
