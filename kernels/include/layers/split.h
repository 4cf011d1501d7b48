// SPDX-License-Identifier: MIT
// The layers at a sample.
#pragma once

#include "layers/layer.h"

static inline bool is_split(LayerSplit split) {
  return split.near_depth > 0.0f;
}

// A depth half-way between its layers.
static inline float between_of(LayerSplit split) {
  return 0.5f * (split.near_depth + split.far_depth);
}
