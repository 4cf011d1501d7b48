// SPDX-License-Identifier: MIT
// temporal_refine: sharpens the picture of a history, and smooths it along its edges. The result is not fed back.
//   t      a channel in tone space, c / (1 + max(red, green, blue, 0))
//   mean   of the 3x3 pixels
//   D_n, D_t  second derivatives of t across and along the edge that luma of tone has around the pixel
//   K      how much of an edge it is, 0 to 1: the coherence of luma's gradients
//   t <- clamp(t + a (t - mean) + K (b D_t + c D_n), range of the 3x3 pixels)
//   a, b, c  by the pixel's confidence and its number of layers (temporal/constants.h): the lower the confidence, the
//            smoother along edges
//   A pixel of which no channel moves keeps its colour bit by bit.
//
//   params   in   extents, layouts
//   source   in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer. NaN counts as 0, what is larger
//                 than 65504 as that
//   history  in   the layer of this frame: of its texels the confidence alone, negative of pixels of two layers
//   output   out  as source, alpha unchanged; another buffer
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of source; OUTPUT_FORMAT is the same
//          HISTORY_FORMAT as in temporal/history.h
// Beyond the picture its outermost pixels repeat.
// Source: the structure tensor after Bigun and Granlund, "Optimal Orientation Detection of Linear Symmetry", 1987.
// Reference: tests/reference/temporal_refine.cpp
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "temporal/tone_rows.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

// Found by least squares against truth, and by search, on the development scenes (docs/temporal.md).

typedef struct Strengths {
  LaneFloat sharpening;  // factor of the difference from the mean
  LaneFloat along;       // factor of the second derivative along an edge
  LaneFloat across;      // factor of that across it
} Strengths;

// As history stores them. Beyond the row's end its last texel repeats.
static inline LaneFloat confidences_at(HistoryLayer layer, int x, int y) {
#if LANES == 1
  return load_confidence(layer, y * layer.width + x);
#else
  const int index = y * layer.width + x, last = (y + 1) * layer.width - 1;
  if (index + 7 <= last) return load_confidences8(layer, index);
  return (float8)(load_confidence(layer, index), load_confidence(layer, min(index + 1, last)),
                  load_confidence(layer, min(index + 2, last)), load_confidence(layer, min(index + 3, last)),
                  load_confidence(layer, min(index + 4, last)), load_confidence(layer, min(index + 5, last)),
                  load_confidence(layer, min(index + 6, last)), load_confidence(layer, min(index + 7, last)));
#endif
}

// Returns the strengths for the pixels from (x, y) on.
static inline Strengths strengths_at(HistoryLayer layer, int x, int y) {
  const LaneFloat stored = confidences_at(layer, x, y), known = fabs(stored), zero = (LaneFloat)(0.0f);
  const LaneMask layered = as_lane_int(stored) < 0;
  const LaneFloat sharpening = SHARPENING + SHARPENING_NEW / (known + SHARPENING_NEW_CONFIDENCE);
  const LaneFloat along = EDGE_SMOOTHING + EDGE_SMOOTHING_NEW / (known + EDGE_SMOOTHING_NEW_CONFIDENCE);
  const Strengths strengths = {select(sharpening, zero, layered),
                               select(along, (LaneFloat)(EDGE_SMOOTHING_LAYERED), layered),
                               select(zero, (LaneFloat)(EDGE_SHARPENING_LAYERED), layered)};
  return strengths;
}

// Edges at the pixels: K cos 2a, K sin 2a and K, with a the direction across the edge.
typedef struct Edges {
  LaneFloat cosine, sine, coherence;
} Edges;

// The sum over 3x3 texels, weighted (1 2 1) by (1 2 1) / 16.
static inline LaneFloat around_pixels(float16 above, float16 same, float16 below) {
  const float16 column = above + 2.0f * same + below;
  return (on_the_left(column) + 2.0f * at_pixels(column) + on_the_right(column)) * 0.0625f;
}

static inline float16 slope_x(float16 luma) {
  return 0.5f * (to_the_right(luma) - to_the_left(luma));
}

// Returns the edges in the five rows of luma around the pixels.
static inline Edges edges_of(const ToneRow* rows) {
  const float16 x0 = slope_x(rows[1].luma), x1 = slope_x(rows[2].luma), x2 = slope_x(rows[3].luma);
  const float16 y0 = 0.5f * (rows[2].luma - rows[0].luma), y1 = 0.5f * (rows[3].luma - rows[1].luma);
  const float16 y2 = 0.5f * (rows[4].luma - rows[2].luma);
  const LaneFloat xx = around_pixels(x0 * x0, x1 * x1, x2 * x2);
  const LaneFloat yy = around_pixels(y0 * y0, y1 * y1, y2 * y2);
  const LaneFloat xy = around_pixels(x0 * y0, x1 * y1, x2 * y2);
  const LaneFloat scale = 1.0f / (xx + yy + EDGE_GRADIENT_FLOOR);
  const LaneFloat cosine = (xx - yy) * scale, sine = 2.0f * xy * scale;
  const Edges edges = {cosine, sine, sqrt(cosine * cosine + sine * sine)};
  return edges;
}

// One channel of the pixels.
static inline LaneFloat refined(float16 above, float16 same, float16 below, Edges edges, Strengths by) {
  const float16 beside = above + below, apart = below - above, column = beside + same;
  const float16 low = min(min(above, below), same), high = max(max(above, below), same);
  const LaneFloat own = at_pixels(same);
  const LaneFloat mean = (on_the_left(column) + at_pixels(column) + on_the_right(column)) * (1.0f / 9.0f);
  const LaneFloat xx = on_the_left(same) + on_the_right(same) - 2.0f * own;
  const LaneFloat yy = at_pixels(beside) - 2.0f * own;
  const LaneFloat xy = 0.25f * (on_the_right(apart) - on_the_left(apart));
  // K (D_n + D_t) and K (D_n - D_t).
  const LaneFloat sum = edges.coherence * (xx + yy);
  const LaneFloat difference = edges.cosine * (xx - yy) + 2.0f * edges.sine * xy;
  const LaneFloat moved = own + by.sharpening * (own - mean) + 0.5f * (by.along + by.across) * sum -
                          0.5f * (by.along - by.across) * difference;
  const LaneFloat least = min(min(on_the_left(low), on_the_right(low)), at_pixels(low));
  const LaneFloat most = max(max(on_the_left(high), on_the_right(high)), at_pixels(high));
  return min(max(moved, least), most);
}

// Refines the pixels from (x, y) on, with the five rows around theirs.
static inline void refine_row(const ToneRow* rows, LightRow light, Strengths by, RESOLVED_TEXELS source,
                              OUTPUT_TEXELS output, const RefineParams* params, float inverse, int x, int y) {
  const Edges edges = edges_of(rows);
  const LaneFloat red = refined(rows[1].red, rows[2].red, rows[3].red, edges, by);
  const LaneFloat green = refined(rows[1].green, rows[2].green, rows[3].green, edges, by);
  const LaneFloat blue = refined(rows[1].blue, rows[2].blue, rows[3].blue, edges, by);
  store_tone(output, source, params, x, y, light, row_of_ones(), rows[2], red, green, blue, inverse);
}

__kernel void temporal_refine(const RefineParams params, RESOLVED_TEXELS source, HISTORY_TEXELS history,
                              OUTPUT_TEXELS output, __global const Exposure* exposure) {
  const int top = get_global_id(1) * kRefineBlock;
  if (top >= params.height) return;

  const HistoryLayer layer = {history, params.width, params.height};
  const int stride = (int)get_global_size(0) * kLanes;
  const int bottom = min(top + kRefineBlock, params.height);
  const float factor = exposure->factor;
  for (int x = get_global_id(0) * kLanes; x < params.width; x += stride) {
    ToneRow rows[5];
    LightRow own = light_row(source, &params, factor, x, top), next = light_row(source, &params, factor, x, top + 1);
    rows[1] = tone_of(light_row(source, &params, factor, x, top - 2));
    rows[2] = tone_of(light_row(source, &params, factor, x, top - 1));
    rows[3] = tone_of(own);
    rows[4] = tone_of(next);
    for (int y = top; y < bottom; ++y) {
      const LightRow after = light_row(source, &params, factor, x, y + 2);
      for (int i = 0; i < 4; ++i)
        rows[i] = rows[i + 1];
      rows[4] = tone_of(after);
      refine_row(rows, own, strengths_at(layer, x, y), source, output, &params, exposure->inverse, x, y);
      own = next;
      next = after;
    }
  }
}
