// SPDX-License-Identifier: MIT
// Non-finite values, told by their bits: kernels are built with -cl-finite-math-only, under which a compiler may
// drop isnan() and isinf().
#pragma once

// The magnitude from which a value counts as infinite, as bits: 2^127. Half the largest float, so that a weighted
// mean of finite values never overflows.
#define NON_FINITE_BITS 0x7f000000
#define INFINITY_STAND_IN 65504.0f  // the largest half

static inline bool is_non_finite(float value) {
  return (as_int(value) & 0x7fffffff) >= NON_FINITE_BITS;
}

static inline bool any_non_finite2(float2 value) {
  return any((as_int2(value) & 0x7fffffff) >= NON_FINITE_BITS);
}

static inline bool any_non_finite4(float4 value) {
  return any((as_int4(value) & 0x7fffffff) >= NON_FINITE_BITS);
}

// NaN becomes 0, +-Inf +-65504; everything else stays.
static inline float4 sanitise4(float4 value) {
  const int4 bits = as_int4(value);
  const int4 magnitude = bits & 0x7fffffff;
  const int4 stand_in = as_int4((float4)(INFINITY_STAND_IN)) | (bits & (int)0x80000000);
  const int4 replaced = select(stand_in, (int4)(0), magnitude > 0x7f800000);
  return as_float4(select(bits, replaced, magnitude >= NON_FINITE_BITS));
}
