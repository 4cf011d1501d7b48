// SPDX-License-Identifier: MIT
// Startling samples: so much brighter than history, or so negative, that they may be faults of the renderer. Several
// side by side are held back for a frame: a fault of one frame then never reaches history, and what stays, or comes
// back soon, is late by one frame.
#pragma once

#include "temporal/frame_samples.h"

#define STARTLING_MULTIPLE 5.0f  // of history's brightest channel and the floor
#define STARTLING_FLOOR 0.25f    // light: between two dark values every ratio may occur
#define NEGATIVE_FLOOR 0.1f      // light: colours of a wider gamut are that negative

// From which on a sample is startling, and below which it is.
typedef struct StartlingRange {
  float most, least;
} StartlingRange;

static inline float largest_magnitude(float4 colour) {
  return max(max(fabs(colour.x), fabs(colour.y)), fabs(colour.z));
}

static inline StartlingRange startling_range(float4 history) {
  const float light = largest_magnitude(history);
  const StartlingRange range = {STARTLING_MULTIPLE * (light + STARTLING_FLOOR), -(light + NEGATIVE_FLOOR)};
  return range;
}

// Of a valid sample.
static inline bool is_startling(float4 sample, StartlingRange range) {
  return max(max(sample.x, sample.y), sample.z) > range.most || min(min(sample.x, sample.y), sample.z) < range.least;
}
