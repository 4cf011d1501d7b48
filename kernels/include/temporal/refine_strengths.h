// SPDX-License-Identifier: MIT
// How far temporal_refine moves eight pixels of a row, by what is known of them.
//
// Option: HISTORY_FORMAT as in temporal/history.h
#pragma once

#include "temporal/history.h"

// Found by least squares against truth, and by search, on the development scenes (docs/temporal.md).
#define SHARPENING 0.05f        // of one layer where all is known; pixels of two are not sharpened on all sides,
#define SHARPENING_YOUNG 0.35f  // and so much more, divided by the confidence and SHARPENING_YOUTH
#define SHARPENING_YOUTH 0.6f
#define ALONG 0.03f             // of one layer along an edge where all is known,
#define ALONG_YOUNG 0.5f        // and so much more, divided by the confidence and ALONG_YOUTH
#define ALONG_YOUTH 0.15f
#define ALONG_LAYERED 0.2f      // of two layers: along an edge
#define ACROSS_LAYERED -0.12f   // and across it

typedef struct EightStrengths {
  float8 sharpening;  // of the difference from the mean
  float8 along;       // of the second derivative along an edge
  float8 across;      // of that across it
} EightStrengths;

// As history stores them. Beyond the row's end its last texel repeats.
static inline float8 confidences_at(HistoryLayer layer, int x, int y) {
  const int index = y * layer.width + x, last = (y + 1) * layer.width - 1;
  if (index + 7 <= last) return confidences(load_history8(layer, index));
  return (float8)(load_confidence(layer, index), load_confidence(layer, min(index + 1, last)),
                  load_confidence(layer, min(index + 2, last)), load_confidence(layer, min(index + 3, last)),
                  load_confidence(layer, min(index + 4, last)), load_confidence(layer, min(index + 5, last)),
                  load_confidence(layer, min(index + 6, last)), load_confidence(layer, min(index + 7, last)));
}

// Of the pixels from (x, y) on.
static inline EightStrengths strengths_at(HistoryLayer layer, int x, int y) {
  const float8 stored = confidences_at(layer, x, y), known = fabs(stored), zero = (float8)(0.0f);
  const int8 layered = as_int8(stored) >> 31;
  const float8 sharpening = SHARPENING + SHARPENING_YOUNG / (known + SHARPENING_YOUTH);
  const float8 along = ALONG + ALONG_YOUNG / (known + ALONG_YOUTH);
  const EightStrengths strengths = {select(sharpening, zero, layered),
                                    select(along, (float8)(ALONG_LAYERED), layered),
                                    select(zero, (float8)(ACROSS_LAYERED), layered)};
  return strengths;
}
