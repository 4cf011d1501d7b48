// SPDX-License-Identifier: MIT
// Values as bits: tests for non-finite ones, and random ones.
// Non-finite and large values are told by their bits: right even where a user's build options let a compiler drop
// isnan() and isinf().
#pragma once

#include "lanes.h"

// The magnitude from which a value may count as infinite, as bits: 2^127. Half the largest float, so that a weighted
// mean of smaller values never overflows.
#define NON_FINITE_BITS 0x7f000000
#define FINITE_HALF_MAX 65504.0f  // the largest half, which stands for infinity, too

// All bits set in the lanes that are NaN or infinite.
static inline int4 non_finite_lanes(float4 value) {
  return (as_int4(value) & 0x7fffffff) >= NON_FINITE_BITS;
}

static inline LaneInt magnitude_bits(LaneFloat value) {
  return as_lane_int(value) & 0x7fffffff;
}

static inline bool any_non_finite4(float4 value) {
  return any(non_finite_lanes(value));
}

// NaN becomes 0, +-Inf +-65504; everything else stays.
static inline float4 sanitise4(float4 value) {
  const int4 bits = as_int4(value);
  const int4 magnitude = bits & 0x7fffffff;
  const int4 stand_in = as_int4((float4)(FINITE_HALF_MAX)) | (bits & (int)0x80000000);
  const int4 replaced = select(stand_in, (int4)(0), magnitude > 0x7f800000);
  return as_float4(select(bits, replaced, magnitude >= NON_FINITE_BITS));
}

// Bit i of lanes.si.
static inline uint lane_bits(int4 lanes) {
  const int4 bits = lanes & (int4)(1, 2, 4, 8);
  return (uint)(bits.s0 | bits.s1 | bits.s2 | bits.s3);
}

// The larger magnitude of each lane, as bits: collects whether any of many values was not finite.
static inline int4 larger_magnitude(int4 largest, float4 value) {
  return max(largest, as_int4(value) & 0x7fffffff);
}

static inline bool any_reached_infinity(int4 largest) {
  const long2 hits = as_long2(largest >= NON_FINITE_BITS);
  return (hits.x | hits.y) != 0;
}

// Whether one of many floats whose bits were or-ed is 2 or more in magnitude, infinite or NaN: all of those, and no
// other, have the highest bit of the exponent.
static inline bool any_at_least_two(int4 bits) {
  const long2 halves = as_long2(bits & 0x40000000);
  return (halves.x | halves.y) != 0;
}

// How many of four bits belong to the first `count` pixels.
static inline uint count_bits(uint bits, int count) {
  return popcount(bits & ((1u << min(count, 4)) - 1u));
}

// Random values that belong to a pixel of the output: the same on every device and in every run.
// Source: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020: the permuted congruential generator in one
// step.
#define DEFINE_HASH(name, type)                                                 \
  static inline type name(type value) {                                         \
    const type state = value * 747796405u + 2891336453u;                        \
    const type word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;   \
    return (word >> 22) ^ word;                                                 \
  }
DEFINE_HASH(hash_of, uint)
DEFINE_HASH(hash_of4, uint4)
DEFINE_HASH(hash_lanes, LaneUint)

// Where the sequence of a row begins; pixel x takes hash_of(hash_of_row() + x).
static inline uint hash_of_row(uint y, uint seed) {
  return hash_of(y + hash_of(seed));
}
