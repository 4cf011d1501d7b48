// SPDX-License-Identifier: MIT
// Non-finite values, told by their bits: kernels are built with -cl-finite-math-only, under which a compiler may
// drop isnan() and isinf().
#pragma once

// The magnitude from which a value counts as infinite, as bits: 2^127. Half the largest float, so that a weighted
// mean of finite values never overflows.
#define NON_FINITE_BITS 0x7f000000
#define INFINITY_STAND_IN 65504.0f  // the largest half

// All bits set in the lanes that are NaN or infinite.
static inline int4 non_finite_lanes(float4 value) {
  return (as_int4(value) & 0x7fffffff) >= NON_FINITE_BITS;
}

static inline bool any_non_finite4(float4 value) {
  const long2 hits = as_long2(non_finite_lanes(value));
  return (hits.x | hits.y) != 0;
}

static inline bool any_non_finite4x4(float4 a, float4 b, float4 c, float4 d) {
  const int4 magnitude = 0x7fffffff;
  const int4 largest = max(max(as_int4(a) & magnitude, as_int4(b) & magnitude),
                           max(as_int4(c) & magnitude, as_int4(d) & magnitude));
  const long2 hits = as_long2(largest >= NON_FINITE_BITS);
  return (hits.x | hits.y) != 0;
}

// NaN becomes 0, +-Inf +-65504; everything else stays.
static inline float4 sanitise4(float4 value) {
  const int4 bits = as_int4(value);
  const int4 magnitude = bits & 0x7fffffff;
  const int4 stand_in = as_int4((float4)(INFINITY_STAND_IN)) | (bits & (int)0x80000000);
  const int4 replaced = select(stand_in, (int4)(0), magnitude > 0x7f800000);
  return as_float4(select(bits, replaced, magnitude >= NON_FINITE_BITS));
}

// Bit i of the lane i.
static inline uint lane_bits(int4 lanes) {
  const int4 bits = lanes & (int4)(1, 2, 4, 8);
  return (uint)(bits.s0 | bits.s1 | bits.s2 | bits.s3);
}

// Adds the pixels of four `bits` that exist: the first `count`.
static inline void count_pixels(__global uint* counter, uint bits, int count) {
  atomic_add(counter, popcount(bits & ((1u << min(count, 4)) - 1u)));
}
