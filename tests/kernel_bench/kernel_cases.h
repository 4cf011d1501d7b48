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

// Full against partial clears of a colour (RGBA16F) and a velocity (RG16F) target: what clearing less is
// worth.

// At scales from 0.3 to 1: clear_region of both targets' viewport and, where `opengl`, GL's scissored clear
// of it; beside them GL's clear of the whole. Targets have the stage's output extent. With `opengl` a context
// is current, now and whenever the cases run or end.
void add_clear_cases(std::vector<Case>& cases, Stage& stage, bool opengl);

// clear_region of `render` in an image of the stage's output extent; `what` without its bytes.
void add_clear(std::vector<Case>& cases, Stage& stage, PixelFormat format, Extent render, Case what);

}  // namespace quincunx::bench
