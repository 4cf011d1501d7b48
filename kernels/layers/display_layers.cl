// SPDX-License-Identifier: MIT
// display_layers: lays the near layer over the picture that temporal_display has made of the far one:
// near + (1 - coverage) far, the near layer resampled at the pixel's centre where it has a phase. Where nothing is
// known of the far layer the near one's colour stands in for it. Pixels of one layer stay what they are.
//
//   params        in      as in temporal_display
//   now           in      this frame's viewport and places of its samples
//   depth         in      R32F, viewport
//   tiles         in      TileReprojection of each tile
//   layers        in      LayerTile of each tile
//   history       in      the far layer
//   near_history  in      the near layer
//   states        in      LayerState of each texel of a layered tile
//   output        in/out  RGBA32F or RGBA16F, output extent
// Options: VIEW  PICTURE (default) | LAYERS, COVERAGE, NEAR: what layers there are, in every pixel: red where there are
//                two, green the near one's coverage, blue the far one's confidence; that coverage; the near one alone
//          SOURCE_STORAGE, OUTPUT_FORMAT, HISTORY_FORMAT as of temporal_display
// Reference: tests/reference/display_layers.cpp
#define ALPHA 0
#include "layers/display_rows.h"

#define PICTURE 1
#define LAYERS 2
#define COVERAGE 3
#define NEAR 4
#ifndef VIEW
#define VIEW PICTURE
#endif
#if VIEW != PICTURE && VIEW != LAYERS && VIEW != COVERAGE && VIEW != NEAR
#error "VIEW must be PICTURE, LAYERS, COVERAGE or NEAR"
#endif

static inline float4 load_output(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y) {
#if OUTPUT_FORMAT == HALF
  return vload_half4(texel_index(layout, x, y), texels);
#else
  return vload4(texel_index(layout, x, y), texels);
#endif
}

#if VIEW == PICTURE
#define UNKNOWN_FAR 0.15f     // confidence of the far layer below which the near one's colour stands in for it
#define LEAST_COVERAGE 0.02f  // from which the near layer has a colour

// `confidence`: of the far layer.
static inline float4 compose(float4 far, float4 near, float confidence) {
  const float coverage = clamp(near.w, 0.0f, 1.0f);
  const float unknown = clamp(1.0f - confidence / UNKNOWN_FAR, 0.0f, 1.0f);
  if (unknown > 0.0f && coverage > LEAST_COVERAGE) far += (near / near.w - far) * unknown;
  return (float4)((near + (1.0f - coverage) * far).xyz, coverage + (1.0f - coverage) * far.w);
}
#endif

// One pixel as the option has it, `shown` being the picture so far. `near` is 0 where there is one layer.
static inline float4 view_of(float4 shown, float4 near, float confidence) {
#if VIEW == LAYERS
  return (float4)(as_int(confidence) < 0 ? 1.0f : 0.0f, near.w, fabs(confidence) * (1.0f / MOST_CONFIDENCE), 1.0f);
#elif VIEW == COVERAGE
  return (float4)(near.w, near.w, near.w, 1.0f);
#elif VIEW == NEAR
  return (float4)(near.xyz, 1.0f);
#else
  return as_int(confidence) < 0 ? compose(shown, near, fabs(confidence)) : shown;
#endif
}

__kernel void display_layers(const TemporalDisplayParams params, const LayerPastParams now, DEPTH_TEXELS depth,
                             __global const TileReprojection* tiles, __global const LayerTile* layers,
                             HISTORY_TEXELS history, HISTORY_TEXELS near_history, __global const half* states,
                             OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.output_width || y >= params.output_height) return;

  const int end = min(first + params.columns_per_item, params.output_width);
  const PastLayers known = {{history, params.output_width, params.output_height},
                            {history, params.output_width, params.output_height},  // no alpha is read
                            {near_history, params.output_width, params.output_height},
                            states,
                            tiles,
                            layers,
                            params.tiles_x,
                            (params.output_height + kTemporalTile - 1) / kTemporalTile,
                            now.width,
                            now.height,
                            (float2)(now.spacing_x, now.spacing_y),
                            (float2)(now.start_x, now.start_y)};
  for (int x = first; x < end; x += kTemporalTile) {
    const LayerTile layer = layers[y / kTemporalTile * params.tiles_x + x / kTemporalTile];
    if (VIEW == PICTURE && !layer.is_split) continue;
    const TexelWindow left = window_at(&known, x, y, 1), right = window_at(&known, x + 4, y, 1);
    const EightTexels own = {load_row(known.far, left, 0), load_row(known.far, right, 0)};
    const float8 confidence = confidences(own);
    const bool any_split = layer.is_split && any_lane(as_int8(confidence) < 0);
    if (VIEW == PICTURE && !any_split) continue;
    const Display display = display_of(layer.phase_x, layer.phase_y);
    EightTexels near = {(float16)(0.0f), (float16)(0.0f)};
    if (any_split) near = show_near(&known, depth, now.depth0, layer.between, display, x, y);
    float4 near_texel[8];
    float far_confidence[8];
    vstore16(near.left, 0, (float*)near_texel);
    vstore16(near.right, 1, (float*)near_texel);
    vstore8(confidence, 0, far_confidence);
    for (int i = 0; i < min(end - x, kTemporalTile); ++i) {
      const bool split = as_int(far_confidence[i]) < 0;
      if (VIEW == PICTURE && !split) continue;
      const float4 far = load_output(output, params.output, x + i, y);
      const float4 shown = view_of(far, split ? near_texel[i] : (float4)(0.0f), far_confidence[i]);
      store_output(output, params.output, x + i, y, shown);
    }
  }
}
