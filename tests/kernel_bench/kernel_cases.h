// SPDX-License-Identifier: MIT
// The project's own passes, each kernel variant that matters for speed as one case.
#pragma once

#include <vector>

#include "stage.h"

namespace quincunx::bench {

// Passes from the render to the output extent, at one scale.
void add_scaled_cases(std::vector<Case>& cases, Stage& stage, double scale);

// Passes at the output's size.
void add_output_cases(std::vector<Case>& cases, Stage& stage);

}  // namespace quincunx::bench
