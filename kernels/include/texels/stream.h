// SPDX-License-Identifier: MIT
// Stores past the caches: lines of memory that are written whole need not be read first. For a picture that is larger
// than the caches, and that is read when all of it is there.
#pragma once

#include "texels/resolved.h"

// At an address that is a multiple of 16 bytes.
#if defined(__x86_64__) && defined(__clang__)
#define STREAM(value, address) __builtin_nontemporal_store(value, address)
#else
#define STREAM(value, address) (*(address) = (value))
#endif

// Four texels of an output, from (x, y) on. Finite values only; halves saturate, and are stored as ever.
static inline void stream_output4(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, float16 value) {
  const int index = texel_index(layout, x, y);
#if OUTPUT_FORMAT == HALF
  store_half_texels4(texels, index, clamp(value, -65504.0f, 65504.0f));
#else
  if (((size_t)texels & 15) != 0) {  // as memory of the caller's may be
    vstore16(value, 0, texels + 4 * index);
    return;
  }
  __global float4* to = (__global float4*)texels + index;
  STREAM(value.s0123, to);
  STREAM(value.s4567, to + 1);
  STREAM(value.s89ab, to + 2);
  STREAM(value.scdef, to + 3);
#endif
}
