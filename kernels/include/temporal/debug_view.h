// SPDX-License-Identifier: MIT
// Debug views: what resolve_temporal knows of each pixel, as colours in place of the picture.
//
// Option: VIEW  PICTURE (default): no view
//               CONFIDENCE  grey: confidence over the most there is
//               REJECTION   red: 1 - trust, green: rejection by a motion edge, blue: rejection by temporal_light
//               PHASE       red x, green y: where between texels history lies; blue: 1 in a rigid tile, whose phase it
//                           is, 0 where history was resampled
#pragma once

#include "temporal/relight.h"

#define PICTURE 1
#define CONFIDENCE 2
#define REJECTION 3
#define PHASE 4
#ifndef VIEW
#define VIEW PICTURE
#endif
#if VIEW != PICTURE && VIEW != CONFIDENCE && VIEW != REJECTION && VIEW != PHASE
#error "VIEW must be PICTURE, CONFIDENCE, REJECTION or PHASE"
#endif

#if VIEW != PICTURE
// Of eight pixels of a row.
typedef struct View {
  float8 red, green, blue;
} View;

#if VIEW == CONFIDENCE
static inline View view_confidence(EightTexels updated) {
  const float8 part = confidences(updated) * (1.0f / MOST_CONFIDENCE);
  const View view = {part, part, part};
  return view;
}
#elif VIEW == REJECTION
static inline View view_rejection(const EightReprojections* motion, EdgeLight left, EdgeLight right) {
  const View view = {1.0f - motion->trust, edge_rejection(motion->motion_edge), ramp(left.rejection, right.rejection)};
  return view;
}
#else
static inline View view_phase(TileReprojection tile, const FetchedHistory* history) {
  View view;
  view.red = tile.is_rigid ? (float8)(tile.phase_x + 0.5f) : history->fraction_x;
  view.green = tile.is_rigid ? (float8)(tile.phase_y + 0.5f) : history->fraction_y;
  view.blue = (float8)(tile.is_rigid ? 1.0f : 0.0f);
  return view;
}
#endif

// Of the pixels from (x, y) on, those before `end`.
static inline void store_view(OUTPUT_TEXELS output, TexelLayout layout, int x, int y, int end, View view) {
  float red[8], green[8], blue[8];
  vstore8(view.red, 0, red);
  vstore8(view.green, 0, green);
  vstore8(view.blue, 0, blue);
  for (int i = 0; i < min(end - x, 8); ++i)
    store_output(output, layout, x + i, y, (float4)(red[i], green[i], blue[i], 1.0f));
}
#endif
