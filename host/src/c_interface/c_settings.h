// SPDX-License-Identifier: MIT
// Settings of the C interface as the library's own, and back.
#pragma once

#include "quincunx/c/settings.h"
#include "quincunx/resolve_plan.h"

namespace quincunx::c {

struct SceneSettings {
  SceneNeeds needs;
  ResolveSettings resolve;
};

// struct_size is 0.
quincunx_settings to_c(const SceneSettings& settings);

// Errors: kInvalidArgument for a struct_size that is none, and for a number that is no value of its field; the
// message names the field. Checks that plan_for() makes are left to it.
Result<SceneSettings> from_c(const quincunx_settings* settings);

// struct_size is 0.
quincunx_needs needs_of(const ResolvePlan& plan);

// Returns the status with C's names of the fields in place of those of C++.
Status in_c_words(const Status& status);

}  // namespace quincunx::c
