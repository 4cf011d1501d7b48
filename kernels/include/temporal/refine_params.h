// SPDX-License-Identifier: MIT
// The struct that host and temporal_refine share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

enum { kRefineBlock = 8 };  // pixels on each side of the square that a work-item makes at a time

typedef struct RefineParams {
  int width;  // of the picture
  int height;
  TexelLayout source;
  TexelLayout output;
} RefineParams;
QUINCUNX_CHECK_SIZE(RefineParams, 8 + 2 * 8);

#ifdef __cplusplus
}  // namespace quincunx
#endif
