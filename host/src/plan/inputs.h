// SPDX-License-Identifier: MIT
// What becomes of a caller's FrameInputs before passes see them: they are checked, and brought to the kernels'
// conventions as far as no texel has to be touched: units and signs, the camera's matrix, rows of buffers.
// convert_inputs does the rest. Pure, but for Memory::kAsked.
#pragma once

#include <cstdint>

#include "plan/resources.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx {

// Whether a check asks OpenCL if memory is as large as the images that it holds.
enum class Memory : std::uint8_t { kUnseen, kAsked };

// Parts of validate(): a frame, whose outputs may be null; a focus, where `region` is the plan's focus_plan(), null
// where it has none.
Status validate_frame(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs* outputs,
                      Memory memory);
Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus,
                      Memory memory);
// Checks the layout, and the memory, of any image that kernels read or write; `field` names it.
Status validate_layout(const ResolvePlan& plan, const char* field, const ImageView& image);

// Each returns its argument unchanged where the conventions are the library's. The pitch of a buffer whose rows are
// turned is negative, in two's complement, and its offset that of the highest row: layout_of() and kernels take both.
FrameInputs native_inputs(const ResolveSettings& settings, FrameInputs inputs);
FocusInputs native_focus(const ResolveSettings& settings, FocusInputs focus);
FrameOutputs native_outputs(const ResolveSettings& settings, FrameOutputs outputs);

// Returns by how much of the viewport, +y down, the jitters alone have moved a still surface from the previous frame to
// this one, both as native_inputs() gives them.
Vec2 jitter_motion(const FrameInputs& inputs, const FrameInputs& previous);

// What a pass has to do with the texels of an input.
enum class Conversion : std::uint8_t {
  kNone,
  kDepth,
  kVelocity,  // take the jitter out
  kRows,      // of an image, turn them
};
Conversion conversion_of(const InputImage& input, const ResolveSettings& settings);

}  // namespace quincunx
