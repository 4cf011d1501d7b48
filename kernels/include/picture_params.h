// SPDX-License-Identifier: MIT
// Structs that host and the kernels that work on a finished picture share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

enum { kPresentBlock = 16 };  // pixels that present, whose pixels are small, makes at once

typedef struct SharpenParams {
  int width;
  int height;
  TexelLayout source;
  TexelLayout output;
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  float sharpness;       // in [0, 1]
} SharpenParams;
QUINCUNX_CHECK_SIZE(SharpenParams, 32);

// A rectangle of a focus, in pixels of its region, whose weight rises from 0 at an edge to 1 within 1 / rate pixels.
typedef struct FocusRectangle {
  float left, top, right, bottom;
  float rate;
} FocusRectangle;
QUINCUNX_CHECK_SIZE(FocusRectangle, 20);

enum { kMostFocusRectangles = 4 };

typedef struct FocusParams {
  int left, top;         // of the part that is laid over, in pixels of the region
  int width, height;     // of that part
  TexelLayout focus;     // of the region
  TexelLayout mask;      // of the region
  TexelLayout output;    // of the picture, from the region's first pixel on
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  int rectangle_count;   // at least 1
  FocusRectangle rectangles[kMostFocusRectangles];
} FocusParams;
QUINCUNX_CHECK_SIZE(FocusParams, 128);

typedef struct CrossFadeParams {
  int width;
  int height;
  TexelLayout other;
  TexelLayout output;
  int columns_per_item;
  float weight;  // of the picture, in [0, 1]
} CrossFadeParams;
QUINCUNX_CHECK_SIZE(CrossFadeParams, 32);

typedef struct PresentParams {
  int width;
  int height;
  TexelLayout source;
  TexelLayout output;
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kPresentBlock
  float exposure;
} PresentParams;
QUINCUNX_CHECK_SIZE(PresentParams, 36);

typedef struct ClearParams {
  int width;
  int height;
  int columns_per_item;  // pixels that a work-item clears
  TexelLayout output;
  unsigned bits[4];  // one texel as a buffer holds it, in the lowest bytes
  float value[4];    // the same for an image
} ClearParams;
QUINCUNX_CHECK_SIZE(ClearParams, 52);

#ifdef __cplusplus
}  // namespace quincunx
#endif
