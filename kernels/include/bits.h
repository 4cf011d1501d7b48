// SPDX-License-Identifier: MIT
// Values as bits: those that are not finite, lanes that are set, random ones.
// Non-finite and large values are told by their bits: right even where a user's build options let a compiler drop
// isnan() and isinf().
#pragma once

// Kernels that make eight pixels of a row at once have them in the lanes of vectors. A CPU has such vectors, and keeps
// them in registers where code is written out for each lane and each case. Elsewhere a work-item has one pixel at a
// time, in the first lane. The compiler leaves the others out, as nothing comes of them: the values of eight pixels are
// five times as many as a GPU's work-item has registers, and a compiler that makes code of its own for every lane needs
// minutes.
#if defined(__x86_64__) || defined(__aarch64__)
#define ON_CPU 1
enum { kLanes = 8 };                                              // those that count
typedef float8 Lanes;
typedef int8 LaneBits;
#define LANES_OF(lanes) (lanes)                                   // of a vector of eight
#define FIRST_LANE(lanes) ((lanes).s0)
#define AS_LANE_BITS(lanes) as_int8(lanes)
#define CONVERT_LANES(lanes) convert_int8(lanes)
#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#define UNROLL(count) __attribute__((opencl_unroll_hint(count)))  // stands before a loop of `count` rounds
#define UNROLL_LANE(count)                                        // the same where only the first lane counts
#define EACH_LANE(call) call, call, call, call, call, call, call, call  // compiles faster than an unrolled loop
#else
#define ON_CPU 0
enum { kLanes = 1 };
typedef float Lanes;
typedef int LaneBits;
#define LANES_OF(lanes) ((lanes).s0)
#define FIRST_LANE(lanes) (lanes)
#define AS_LANE_BITS(lanes) as_int(lanes)
#define CONVERT_LANES(lanes) convert_int(lanes)
#define LANE_NUMBERS ((int8)(0))
#define UNROLL(count) __attribute__((opencl_unroll_hint(1)))
#define UNROLL_LANE(count) __attribute__((opencl_unroll_hint(count)))  // else rounds hand all lanes on to the next
#define EACH_LANE(call) call
#endif
#define UNROLL_ALWAYS(count) __attribute__((opencl_unroll_hint(count)))

// The pixels of a row that a work-item makes: those from `first` on, from `first` + `step` on, and so on, before `end`.
// On a CPU it makes a block of them at once, and then the next one. Elsewhere the items of a group take turns, pixel by
// pixel, so that those side by side load and store neighbours.
typedef struct ItemColumns {
  int first, end, step;
} ItemColumns;

// `wanted`: how many an item makes of a row of `width`, at least; `block`: at once, on a CPU.
static inline ItemColumns columns_of_item(int wanted, int width, int block) {
#if ON_CPU
  const int count = (wanted + block - 1) / block * block;
  const int first = get_global_id(0) * count;
  const ItemColumns columns = {first, min(first + count, width), block};
#else
  const int items = get_local_size(0);
  const int group = get_group_id(0) * items * wanted;
  const ItemColumns columns = {group + (int)get_local_id(0), min(group + items * wanted, width), items};
#endif
  return columns;
}

// How many pixels from x on are there; on a CPU more than a block may be.
static inline int pixels_from(ItemColumns columns, int x) {
  return ON_CPU ? columns.end - x : 1;
}

// The magnitude from which a value may count as infinite, as bits: 2^127. Half the largest float, so that a weighted
// mean of smaller values never overflows.
#define NON_FINITE_BITS 0x7f000000
#define FINITE_HALF_MAX 65504.0f  // the largest half, which stands for infinity, too

// All bits set in the lanes that are NaN or infinite.
static inline int4 non_finite_lanes(float4 value) {
  return (as_int4(value) & 0x7fffffff) >= NON_FINITE_BITS;
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

// Whether one of eight lanes, 0 or -1 each, is -1.
static inline bool any_of_eight(int8 lanes) {
  const long4 longs = as_long4(lanes);
  const long2 pairs = longs.lo | longs.hi;
  return (pairs.x | pairs.y) != 0;
}

// Lanes, the second first and the first last. Loops over lanes take the first and go on so: an array would lie in
// memory, and Mesa unrolls every loop that has one.
#if ON_CPU
#define NEXT_LANES(lanes) ((lanes).s12345670)
#else
#define NEXT_LANES(lanes) (lanes)
#endif

// Whether one of those that count is -1.
static inline bool any_lane(int8 lanes) {
  return ON_CPU ? any_of_eight(lanes) : lanes.s0 != 0;
}

static inline bool all_lanes(int8 lanes) {
  return !any_lane(~lanes);
}

static inline int smallest_lane(int8 lanes) {
  const int4 four = min(lanes.lo, lanes.hi);
  const int2 two = min(four.lo, four.hi);
  return ON_CPU ? min(two.x, two.y) : lanes.s0;
}

static inline int largest_lane(int8 lanes) {
  const int4 four = max(lanes.lo, lanes.hi);
  const int2 two = max(four.lo, four.hi);
  return ON_CPU ? max(two.x, two.y) : lanes.s0;
}

// Random values that belong to a pixel of the output: the same on every device and in every run.
// Source: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020: the permuted congruential generator in one
// step.
static inline uint hash_of(uint value) {
  const uint state = value * 747796405u + 2891336453u;
  const uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

// The same for four values.
static inline uint4 hash_of4(uint4 value) {
  const uint4 state = value * 747796405u + 2891336453u;
  const uint4 word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

// Where the sequence of a row begins; pixel x takes hash_of(hash_of_row() + x).
static inline uint hash_of_row(uint y, uint seed) {
  return hash_of(y + hash_of(seed));
}
