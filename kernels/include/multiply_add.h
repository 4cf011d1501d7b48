// SPDX-License-Identifier: MIT
// a * b + c rounded the same way wherever it stands: once where the device fuses fast, twice elsewhere. Without it a
// compiler may fuse one copy of a sum and not another, and two ways to the same pixel differ in the last bit.
#pragma once

#if defined(FP_FAST_FMAF) || defined(__FMA__) || defined(__aarch64__)  // PoCL says it by its processor only
#define MULTIPLY_ADD(a, b, c) fma(a, b, c)
#else
#pragma OPENCL FP_CONTRACT OFF
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#endif
