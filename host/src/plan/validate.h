// SPDX-License-Identifier: MIT
// validate_focus(): validate() of a focus alone, for a caller who keeps the plan of its region.
#pragma once

#include "quincunx/advanced/focus.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx {

// Returns what validate() says of a focus. `region` is the plan's focus_plan(), null where it has none.
Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus);

}  // namespace quincunx
