// SPDX-License-Identifier: MIT
// How far fetched history is to be believed: eight output pixels of one row and one tile at a time.
#pragma once

#include "motion/motion_edge.h"
#include "temporal/fetch_history.h"

// A reseeded texel has this confidence, and one of less is reseeded: a Gaussian of this frame's samples is nearer to
// truth then. It was found in the laboratory of docs/temporal.md, as RESAMPLED_CONFIDENCE was.
#define LEAST_CONFIDENCE 0.15f
#define RESAMPLED_CONFIDENCE 8.0f  // at most, of what was resampled: it blurs with each frame
#define RESAMPLING_COST 0.2f       // q in W / (1 + q W) half-way between texels; +.05 dB over .3 (docs/temporal.md)
#define RESAMPLED_FROM 0.01f       // of 1: less than this share of the way to half-way between texels is no resampling
#define EDGE_COST 4.0f             // the same q at a whole motion edge. Over 2: -.02 dB, and pixels with a ghost above
                                   // 2/255 on a texture fall from .052 to .033 % (docs/temporal.md)

// What is known of history.
typedef struct Evidence {
  float8 confidence;  // within [0, MOST_CONFIDENCE]
  float8 rejection;   // within [0, 1]: how far history is to be brought into the range of this frame's samples
} Evidence;

// The most confidence for a trust in [0, 1]: all of it for 1, 0 for 0.
static inline float8 most_confidence(float8 trust) {
  return trust / (1.0f + 1.0f / MOST_CONFIDENCE - trust);
}

// Of history that is taken whole.
static inline Evidence full_evidence(const FetchedHistory* history) {
  const Evidence evidence = {history->confidence, (float8)(0.0f)};
  return evidence;
}

// Limits confidence by what resampling, disocclusion, reactive values and motion edges leave of it.
static inline Evidence limit_confidence(const FetchedHistory* history, const EightReprojections* motion) {
  const float8 fraction_x = history->fraction_x, fraction_y = history->fraction_y;
  const float8 known = history->confidence;
  const float8 between = min(4.0f * (fraction_x * (1.0f - fraction_x) + fraction_y * (1.0f - fraction_y)), 1.0f);
  float8 w = known / (1.0f + RESAMPLING_COST * between * known);
  w = select(w, min(w, RESAMPLED_CONFIDENCE), between > RESAMPLED_FROM);
  const float8 trust = motion->trust;
  w = min(w, most_confidence(trust));
  w = w / (1.0f + EDGE_COST * smooth_step(motion->motion_edge, EDGE_COSTS_FROM, EDGE_COSTS_ALL) * w);
  const Evidence evidence = {w, max(1.0f - trust, edge_rejection(motion->motion_edge))};
  return evidence;
}
