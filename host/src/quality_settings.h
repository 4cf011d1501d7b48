// SPDX-License-Identifier: MIT
// The check of QualitySettings.
#pragma once

#include "quincunx/quality_controller.h"

namespace quincunx {

// Errors: kInvalidArgument for a field outside its range, but for the ladder and the target.
Status check(const QualitySettings& settings);

}  // namespace quincunx
