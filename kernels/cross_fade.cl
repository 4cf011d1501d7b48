// SPDX-License-Identifier: MIT
// cross_fade: mixes the picture with another one.
//   params  in      extents, layouts, weight of the picture in [0, 1]
//   other   in      RGBA32F or RGBA16F, the picture's extent, linear, premultiplied; a buffer
//   output  in/out  as other, other memory: the picture. out = other + weight * (picture - other)
// NaN counts as 0 and +-Inf as +-65504. Equal pictures are copied.
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of other; OUTPUT_FORMAT is the same
// Reference: tests/reference/cross_fade.cpp
#include "bits.h"
#include "picture_params.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

__kernel void cross_fade(const CrossFadeParams params, RESOLVED_TEXELS other, OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  for (int x = first; x < end; ++x) {
    const float4 from = sanitise4(load_resolved(other, params.other, x, y));
    const float4 to = sanitise4(load_resolved((RESOLVED_TEXELS)output, params.output, x, y));
    store_output(output, params.output, x, y, from + params.weight * (to - from));
  }
}
