// SPDX-License-Identifier: MIT
// scale_filter: each output pixel is a weighted mean of the samples around its centre, by a separable filter of any
// width: every separable filter of the table in host/control/src/method.cpp, and the tent that bilinear becomes above
// scale 1.
//   params      in   extents, layouts, taps of each axis
//   spans       in   FilterSpan of each output column, then row; behind them the weights, taps of each column, then
//                    row. The filter, the jitter and the widening above scale 1 are in them
//   source      in   RGBA16F or RGBA32F, viewport of params.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.counter] grows by the pixels with a NaN or infinite sample of non-zero weight
// Options: TAPS   4 (default) taps on both axes | 0 as many as params says
//          CLAMP  0 (default) | 1: to the range of the samples next to the centre, so that negative lobes do not ring
//          SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// With LANES=8 rows first, for the columns that a run of output pixels reads; then columns: each sample is weighed once
// a row. With LANES=1 each pixel by itself: there are no registers for a run.
// The table names the source of each filter.   Reference: tests/reference/scale_filter.cpp
#include "arithmetic.h"
#include "bits.h"
#include "resolve_params.h"
#include "texel.h"

#ifndef TAPS
#define TAPS 4
#endif
#ifndef CLAMP
#define CLAMP 0
#endif
#if TAPS != 0 && TAPS != 4
#error "TAPS must be 4 or 0"
#endif
#if CLAMP != 0 && CLAMP != 1
#error "CLAMP must be 0 or 1"
#endif
#if TAPS == 4
#define TAPS_X 4
#define TAPS_Y 4
#define INNER_X 2
#define INNER_Y 2
#else
#define TAPS_X params->taps_x
#define TAPS_Y params->taps_y
#define INNER_X params->inner_x
#define INNER_Y params->inner_y
#endif

#if LANES == 8
// Columns of a run of output pixels, each the weighted mean of its rows and, for CLAMP, the range of its inner rows
// and, in the end, of the INNER_X columns from there on.
typedef struct Columns {
  float4 mean[kFilterColumns];
#if CLAMP
  float4 low[kFilterColumns + 4];
  float4 high[kFilterColumns + 4];
#endif
} Columns;

static inline float16 four_texels(COLOUR_TEXELS source, TexelLayout layout, int x, int y) {
  return load_colour4(source, colour_row(source, layout, y), x);
}

// The four columns from texel x on. min() and max() leave open what NaN gives, in one instruction: the mean tells of
// it.
static inline void filter_four_columns(const FilterParams* params, COLOUR_TEXELS source, FilterSpan row,
                                       __global const float* weights, int x, Columns* columns, int i) {
  const TexelLayout layout = params->source;
#if TAPS == 4
  // Written out: PoCL does not unroll.
  float16 mean = four_texels(source, layout, x, row.base) * weights[0];
  mean = MULTIPLY_ADD(four_texels(source, layout, x, row.base + 1), (float16)(weights[1]), mean);
  mean = MULTIPLY_ADD(four_texels(source, layout, x, row.base + 2), (float16)(weights[2]), mean);
  mean = MULTIPLY_ADD(four_texels(source, layout, x, row.base + 3), (float16)(weights[3]), mean);
#else
  float16 mean = 0.0f;
  for (int k = 0; k < TAPS_Y; ++k)
    mean = MULTIPLY_ADD(four_texels(source, layout, x, row.base + k), (float16)(weights[k]), mean);
#endif
  vstore16(mean, 0, (__private float*)(columns->mean + i));
#if CLAMP
  const float16 upper = four_texels(source, layout, x, row.inner);
  const float16 lower = four_texels(source, layout, x, row.inner + 1);
  float16 low = min(upper, lower);
  float16 high = max(upper, lower);
  for (int k = 2; k < INNER_Y; ++k) {
    const float16 texels = four_texels(source, layout, x, row.inner + k);
    low = min(low, texels);
    high = max(high, texels);
  }
  vstore16(low, 0, (__private float*)(columns->low + i));
  vstore16(high, 0, (__private float*)(columns->high + i));
#endif
}

// Columns from `base` on, `count` >= 4 of them, of the rows that `row` spans. The last four may overlap those before.
static inline void filter_rows(const FilterParams* params, COLOUR_TEXELS source, FilterSpan row,
                               __global const float* weights, int base, int count, Columns* columns) {
  for (int i = 0; i < count; i += 4) {
    const int at = min(i, count - 4);
    filter_four_columns(params, source, row, weights, base + at, columns, at);
  }
#if CLAMP
  // Each pass widens the range of a column by the one to its right.
  for (int k = 1; k < INNER_X; ++k) {
    for (int i = 0; i < count; i += 4) {
      __private float* low = (__private float*)(columns->low + i);
      __private float* high = (__private float*)(columns->high + i);
      vstore16(min(vload16(0, low), vload16(0, low + 4)), 0, low);
      vstore16(max(vload16(0, high), vload16(0, high + 4)), 0, high);
    }
  }
#endif
}

// One pixel from filtered columns that start at `base`. Collects the largest magnitude before the clamp, which NaN and
// Inf reach through any weight: 0 * Inf is NaN.
static inline float4 filter_columns(const FilterParams* params, const Columns* columns, int base, FilterSpan span,
                                    __global const float* weights, int4* largest) {
  const float4* taps = columns->mean + (span.base - base);
#if TAPS == 4
  float4 mean = taps[0] * weights[0];
  mean = MULTIPLY_ADD(taps[1], (float4)(weights[1]), mean);
  mean = MULTIPLY_ADD(taps[2], (float4)(weights[2]), mean);
  mean = MULTIPLY_ADD(taps[3], (float4)(weights[3]), mean);
#else
  float4 mean = 0.0f;
  for (int k = 0; k < TAPS_X; ++k)
    mean = MULTIPLY_ADD(taps[k], (float4)(weights[k]), mean);
#endif
  *largest = larger_magnitude(*largest, mean);
#if CLAMP
  mean = min(max(mean, columns->low[span.inner - base]), columns->high[span.inner - base]);
#endif
  return mean;
}
#endif

// One pixel of any viewport. `careful`, a constant, chooses the way: the slow one is for any values. NaN counts as 0 in
// it, +-Inf as +-65504, and either sets *met if it has a weight. The fast one, with LANES=1 alone, sets it by a mean
// that is not finite. Both sum in the order of the functions above: a pixel comes out the same to the last bit
// whichever way it went.
__attribute__((always_inline)) static inline float4 filter_pixel(
    bool careful, const FilterParams* params, COLOUR_TEXELS source, FilterSpan column, FilterSpan row,
    __global const float* column_weights, __global const float* row_weights, bool* met) {
  const int right = params->source_width - 1;
  const int below = params->source_height - 1;
  *met = false;
  float4 mean = 0.0f;
  for (int i = 0; i < TAPS_X; ++i) {
    float4 column_mean = 0.0f;
    UNROLL_ALWAYS(4)  // so that loads do not wait for each other
    for (int j = 0; j < TAPS_Y; ++j) {
      if (careful && (column_weights[i] == 0.0f || row_weights[j] == 0.0f)) continue;
      float4 texel = load_colour(source, params->source, min(column.base + i, right), min(row.base + j, below));
      if (careful) {
        *met = *met || any_non_finite4(texel);
        texel = sanitise4(texel);
      }
      column_mean = MULTIPLY_ADD(texel, (float4)(row_weights[j]), column_mean);
    }
    mean = MULTIPLY_ADD(column_mean, (float4)(column_weights[i]), mean);
  }
  if (!careful) *met = any_non_finite4(mean);
#if CLAMP
  float4 low = FLT_MAX;
  float4 high = -FLT_MAX;
  for (int j = 0; j < INNER_Y; ++j) {
    for (int i = 0; i < INNER_X; ++i) {
      float4 value = load_colour(source, params->source, min(column.inner + i, right), min(row.inner + j, below));
      if (careful) value = sanitise4(value);
      low = min(low, value);
      high = max(high, value);
    }
  }
  mean = clamp(mean, low, high);
#endif
  return mean;
}

__kernel void scale_filter(const FilterParams filter, __global const FilterSpan* spans, COLOUR_TEXELS source,
                           OUTPUT_TEXELS output, __global uint* non_finite) {
  const FilterParams* params = &filter;
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params->columns_per_item, params->output_width, 1);
  if (item.first >= item.end || y >= params->output_height) return;

  const FilterSpan row = spans[params->row_axis + y];
  __global const float* column_weights = (__global const float*)(spans + params->row_axis + params->output_height);
  __global const float* row_weights = column_weights + params->row_axis * TAPS_X + y * TAPS_Y;
#if LANES == 8
  int4 largest = params->run > 0 ? 0 : NON_FINITE_BITS;
  Columns columns;
  for (int start = item.first; start < item.end && params->run > 0; start += params->run) {
    const int stop = min(start + params->run, item.end);
    const int base = min(spans[start].base, params->source_width - 4);
    const int count = max(spans[stop - 1].base + TAPS_X - base, 4);
    filter_rows(params, source, row, row_weights, base, count, &columns);
    for (int x = start; x < stop; ++x) {
      store_output(output, params->output, x, y,
                   filter_columns(params, &columns, base, spans[x], column_weights + x * TAPS_X, &largest));
    }
  }
  if (!any_reached_infinity(largest)) return;
#endif

  // All of it or, with LANES=8, all of it once more on the slow path, which is rare.
  uint met_count = 0;
  for (int x = item.first; x < item.end; x += item.step) {
    bool met;
    float4 colour =
        filter_pixel(kLanes > 1, params, source, spans[x], row, column_weights + x * TAPS_X, row_weights, &met);
    if (kLanes == 1 && met)
      colour = filter_pixel(true, params, source, spans[x], row, column_weights + x * TAPS_X, row_weights, &met);
    store_output(output, params->output, x, y, colour);
    met_count += met;
  }
  if (met_count) atomic_add(non_finite + params->counter, met_count);
}
