// SPDX-License-Identifier: MIT
// The pixels that a work-item makes at once: eight of a row on a CPU, one elsewhere.
//
// Option: LANES  1 (default) | 8   the host says it for a device (host/src/device/program_cache.h)
//
// Kernels hold eight pixels of a row in the lanes of vectors. A CPU keeps the eight pixels in vector registers, if the
// code is unrolled over lanes and cases. Elsewhere a work-item has one pixel at a time, in the first lane, and the
// compiler drops the others, as nothing reads them. A GPU's work-item has registers for a fifth of the values of eight
// pixels, and a compiler that makes code of its own for every lane needs minutes.
#pragma once

#ifndef LANES
#define LANES 1
#endif
#if LANES != 1 && LANES != 8
#error "LANES must be 1 or 8"
#endif
enum { kLanes = LANES };  // those that count

#if LANES == 8
#define ON_CPU 1
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
