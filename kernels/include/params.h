// SPDX-License-Identifier: MIT
// Structs that host and kernels share. 4-byte scalars only, so that both sides lay them out alike on every device.
// Here are those that many kernels need; the files *_params.h have those of one kernel or of a few.
#pragma once

#ifdef CONTRACT_EVERYWHERE  // for tests: as compilers of GPUs may, also over statements and functions
#pragma clang fp contract(fast)
#endif

#ifdef __cplusplus
namespace quincunx {
#define QUINCUNX_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#else
#define QUINCUNX_CHECK_SIZE(type, bytes)
#endif

// Most kernels make this many neighbouring pixels of a row at once.
enum { kBlock = 4 };

// Where the texels of a buffer lie: texel (x, y) has the index offset + y * pitch + x. Both in texels; both zero for
// an image.
typedef struct TexelLayout {
  int offset;
  int pitch;
} TexelLayout;
QUINCUNX_CHECK_SIZE(TexelLayout, 8);

// Taps of one output column (or row) on its axis. The two taps base and base + 1 lie inside the viewport: what a clamp
// at the edge would do is folded into the weights. A viewport of one texel has base 0 and weights 1, 0, and its second
// tap must not be read.
typedef struct AxisTap {
  int base;
  int nearest;    // the texel whose sample lies nearest to the pixel centre; of two equally near the upper/left one
  float weight0;  // weight of base; weight0 + weight1 == 1 exactly
  float weight1;  // weight of base + 1
} AxisTap;
QUINCUNX_CHECK_SIZE(AxisTap, 16);

// The sources of one frame: the viewport and their layouts.
typedef struct SourceFrame {
  int width;  // the viewport, in texels
  int height;
  TexelLayout colour;
  TexelLayout velocity;
  TexelLayout reactive;
} SourceFrame;
QUINCUNX_CHECK_SIZE(SourceFrame, 32);

#ifdef __cplusplus
}  // namespace quincunx
#endif
