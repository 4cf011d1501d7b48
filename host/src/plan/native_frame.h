// SPDX-License-Identifier: MIT
// From the conventions of a caller's frames to those of the kernels, as far as no texel has to be touched: units and
// signs, the camera's matrix, rows of buffers. convert_inputs does the rest. Pure.
#pragma once

#include "plan/resources.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// Each returns its argument unchanged where the conventions are the library's. The pitch of a buffer whose rows are
// turned is negative, in two's complement, and its offset that of the highest row: layout_of() and kernels take both.
FrameInputs native_inputs(const ResolveSettings& settings, FrameInputs frame);
FocusInputs native_focus(const ResolveSettings& settings, FocusInputs focus);
FrameOutputs native_outputs(const ResolveSettings& settings, FrameOutputs outputs);

// Returns by how much of the viewport, +y down, the jitters alone have moved a still surface from the previous frame to
// this one, both as native_inputs() gives them.
Vec2 jitter_motion(const FrameInputs& frame, const FrameInputs& previous);

// What a pass has to do with the texels of an input.
enum class Conversion : std::uint8_t {
  kNone,
  kDepth,
  kVelocity,  // take the jitter out
  kRows,      // of an image, turn them
};
Conversion conversion_of(const InputImage& input, const ResolveSettings& settings);

}  // namespace quincunx
