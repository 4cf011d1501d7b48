// SPDX-License-Identifier: MIT
// What the passes of the second layer of history share.
#pragma once

#include "layers/layer.h"
#include "pass.h"

namespace quincunx {

constexpr std::size_t kLayerStateBytes = 4 * sizeof(cl_half);

// Of layer_records, advect_records and layer_split; items along rows of `extent`.
LayerParams layer_params(const PassFrame& frame, const Device::Impl& device, Extent extent);

// Where a frame's samples lie.
struct SamplePlaces {
  Ratio spacing;
  Ratio start;
};
SamplePlaces places_of(const FrameInputs& frame, Extent output);

}  // namespace quincunx
