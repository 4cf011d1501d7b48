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

// How many rows a work-item of resolve_temporal and temporal_display makes: those of a tile where it makes whole rows,
// because what they share is found once, else 1.
int rows_per_item(const WorkShape& shape);

// `picture`: where it goes.
TemporalDisplayParams temporal_display_params(const PassFrame& frame, const WorkShape& shape,
                                              Resource picture);

}  // namespace quincunx
