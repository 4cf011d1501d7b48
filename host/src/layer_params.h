// SPDX-License-Identifier: MIT
// What the passes of the second layer of history share.
#pragma once

#include "layers/layer.h"
#include "pass.h"

namespace quincunx {

constexpr std::size_t kLayerStateBytes = 4 * sizeof(cl_half);

// Of layer_records, turn_records, advect_records and layer_split; items along rows of `extent`.
LayerParams layer_params(const PassFrame& frame, const WorkShape& shape, Extent extent);

// Of resolve_layers and display_layers: where the samples lie of the frame that made the history, and the depths that
// are read. The second is no depth where a kernel reads one only.
LayerPastParams layer_past_params(const FrameInputs& frame, Extent output, TexelLayout depth0,
                                  TexelLayout depth1);

}  // namespace quincunx
