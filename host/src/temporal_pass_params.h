// SPDX-License-Identifier: MIT
// What several kernels of the temporal upscaler share.
#pragma once

#include "pass.h"
#include "temporal/temporal_params.h"

namespace quincunx {

// Which samples of a frame are shaded: TemporalParams::parity.
int shaded_parity(const PlanFacts& facts, const FrameInputs& frame);

// Without reactive values and a view.
TemporalParams temporal_params(const PassFrame& frame, const WorkShape& shape, const PlanFacts& facts);

// `picture`: where it goes.
TemporalDisplayParams temporal_display_params(const PassFrame& frame, const WorkShape& shape,
                                              Resource picture);

}  // namespace quincunx
