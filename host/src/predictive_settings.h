// SPDX-License-Identifier: MIT
// The check of PredictiveSettings, for every controller that is made from them.
#pragma once

#include "quincunx/predictive_controller.h"

namespace quincunx {

// Errors: kInvalidArgument for a field outside its range, but for the ladder and the target.
Status check(const PredictiveSettings& settings);

}  // namespace quincunx
