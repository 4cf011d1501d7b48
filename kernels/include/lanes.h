// SPDX-License-Identifier: MIT
// The pixels that a work-item makes at once, each in a lane: eight of a row on a CPU, in vectors, and one elsewhere,
// where a lane is a plain float or int. Kernels are written for lanes, whatever their number.
//
// Option: LANES  1 (default) | 8   the host says it for a device (host/src/device/program_cache.h)
//
// A CPU keeps eight pixels in vector registers, if the code is unrolled over lanes and cases. A GPU's work-item has
// registers for a fifth of the values of eight pixels.
#pragma once

#ifndef LANES
#define LANES 1
#endif
#if LANES != 1 && LANES != 8
#error "LANES must be 1 or 8"
#endif
enum { kLanes = LANES };

// A comparison gives -1 in a vector, 1 alone: so a mask is only what comparisons and mask_of() give. `&`, `|` and
// select() take it, and mask_not() turns it; clang warns of ~.
#if LANES == 8
typedef float8 LaneFloat;
typedef int8 LaneInt;
typedef uint8 LaneUint;
typedef ulong8 LaneUlong;
typedef int8 LaneMask;
#define as_lane_float(lanes) as_float8(lanes)
#define as_lane_int(lanes) as_int8(lanes)
#define as_lane_uint(lanes) as_uint8(lanes)
#define to_lane_float(lanes) convert_float8(lanes)
#define to_lane_int(lanes) convert_int8(lanes)
#define mask_of(condition) ((LaneMask)((condition) ? -1 : 0))
#define mask_not(mask) (~(mask))
#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#define LANE(lanes, i) ((lanes).i)  // lane s0 to s7
#define NEXT_LANES(lanes) ((lanes).s12345670)
#define LOAD_LANES(address) vload8(0, address)
#define STORE_LANES(lanes, address) vstore8(lanes, 0, address)
#define UNROLL(count) __attribute__((opencl_unroll_hint(count)))  // stands before a loop of `count` rounds
#define UNROLL_LANE(count)                                        // the same where there is one lane
#define EACH_LANE(call) call, call, call, call, call, call, call, call  // compiles faster than an unrolled loop
#else
typedef float LaneFloat;
typedef int LaneInt;
typedef uint LaneUint;
typedef ulong LaneUlong;
typedef bool LaneMask;
#define as_lane_float(lanes) as_float(lanes)
#define as_lane_int(lanes) as_int(lanes)
#define as_lane_uint(lanes) as_uint(lanes)
#define to_lane_float(lanes) convert_float(lanes)
#define to_lane_int(lanes) convert_int(lanes)
#define mask_of(condition) ((LaneMask)(condition))
#define mask_not(mask) (!(mask))
#define LANE_NUMBERS 0
#define LANE(lanes, i) (lanes)
#define NEXT_LANES(lanes) (lanes)
#define LOAD_LANES(address) (*(address))
#define STORE_LANES(lanes, address) (*(address) = (lanes))
#define UNROLL(count) __attribute__((opencl_unroll_hint(1)))
#define UNROLL_LANE(count) __attribute__((opencl_unroll_hint(count)))
#define EACH_LANE(call) call
#endif
#define UNROLL_ALWAYS(count) __attribute__((opencl_unroll_hint(count)))

// Loops over lanes take the first, and go on with NEXT_LANES, where the second is the first and the first the last: an
// array would lie in memory, and Mesa unrolls every loop that has one.
#define FIRST_LANE(lanes) LANE(lanes, s0)

// The pixels of a row that a work-item makes: those from `first` on, from `first` + `step` on, and so on, before `end`.
// With eight lanes it makes a block of them at once, and then the next one. With one the items of a group take turns,
// pixel by pixel, so that those side by side load and store neighbours.
typedef struct ItemColumns {
  int first, end, step;
} ItemColumns;

// `wanted`: how many an item makes of a row of `width`, at least; `block`: at once, with eight lanes.
static inline ItemColumns columns_of_item(int wanted, int width, int block) {
#if LANES == 8
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

// How many pixels from x on are there; with eight lanes more than a block may be.
static inline int pixels_from(ItemColumns columns, int x) {
  return kLanes > 1 ? columns.end - x : 1;
}

// Whether one of eight values is not 0.
static inline bool any_of_eight(int8 values) {
  const long4 longs = as_long4(values);
  const long2 pairs = longs.lo | longs.hi;
  return (pairs.x | pairs.y) != 0;
}

#if LANES == 8
static inline bool any_lane(LaneMask mask) {
  return any_of_eight(mask);
}

static inline int smallest_lane(LaneInt lanes) {
  const int4 four = min(lanes.lo, lanes.hi);
  const int2 two = min(four.lo, four.hi);
  return min(two.x, two.y);
}

static inline int largest_lane(LaneInt lanes) {
  const int4 four = max(lanes.lo, lanes.hi);
  const int2 two = max(four.lo, four.hi);
  return max(two.x, two.y);
}
#else
#define any_lane(mask) (mask)
#define smallest_lane(lanes) (lanes)
#define largest_lane(lanes) (lanes)
#endif

static inline bool all_lanes(LaneMask mask) {
  return !any_lane(mask_not(mask));
}

// Rounds towards minus infinity.
static inline LaneInt floor_lanes(LaneFloat lanes) {
  const LaneInt whole = to_lane_int(lanes);
  return select(whole, whole - 1, to_lane_float(whole) > lanes);
}

// Each lane's element of an array.
static inline LaneFloat gather(__global const float* elements, LaneInt index) {
#if LANES == 8
  return (LaneFloat)(elements[index.s0], elements[index.s1], elements[index.s2], elements[index.s3],
                     elements[index.s4], elements[index.s5], elements[index.s6], elements[index.s7]);
#else
  return elements[index];
#endif
}

typedef struct LaneFloat2 {
  LaneFloat x, y;
} LaneFloat2;

typedef struct LaneFloat4 {
  LaneFloat x, y, z, w;
} LaneFloat4;

// The same of fours.
static inline LaneFloat4 gather4(__global const float* fours, LaneInt index) {
#if LANES == 8
  const float4 f0 = vload4(index.s0, fours), f1 = vload4(index.s1, fours), f2 = vload4(index.s2, fours);
  const float4 f3 = vload4(index.s3, fours), f4 = vload4(index.s4, fours), f5 = vload4(index.s5, fours);
  const float4 f6 = vload4(index.s6, fours), f7 = vload4(index.s7, fours);
  const LaneFloat4 gathered = {(LaneFloat)(f0.x, f1.x, f2.x, f3.x, f4.x, f5.x, f6.x, f7.x),
                               (LaneFloat)(f0.y, f1.y, f2.y, f3.y, f4.y, f5.y, f6.y, f7.y),
                               (LaneFloat)(f0.z, f1.z, f2.z, f3.z, f4.z, f5.z, f6.z, f7.z),
                               (LaneFloat)(f0.w, f1.w, f2.w, f3.w, f4.w, f5.w, f6.w, f7.w)};
#else
  const float4 four = vload4(index, fours);
  const LaneFloat4 gathered = {four.x, four.y, four.z, four.w};
#endif
  return gathered;
}

// ---- A texel in each lane: four channels, of which the last may be something else than alpha.

// Each of four values four times, for the channels of four texels.
#define OF_FOUR(values) ((values).s0000111122223333)

#if LANES == 8
typedef struct LaneTexels {
  float16 left, right;  // four and four; not an array, which PoCL keeps in memory
} LaneTexels;

static inline LaneTexels no_texels(void) {
  const LaneTexels none = {(float16)(0.0f), (float16)(0.0f)};
  return none;
}

static inline float4 first_texel(LaneTexels texels) {
  return texels.left.s0123;
}

// Returns the texels without the first, and `texel` as the last.
static inline LaneTexels push_texel(LaneTexels texels, float4 texel) {
  const LaneTexels pushed = {(float16)(texels.left.s456789ab, texels.left.scdef, texels.right.s0123),
                             (float16)(texels.right.s456789ab, texels.right.scdef, texel)};
  return pushed;
}

static inline LaneFloat reds(LaneTexels texels) {
  return (LaneFloat)(texels.left.s048c, texels.right.s048c);
}

static inline LaneFloat greens(LaneTexels texels) {
  return (LaneFloat)(texels.left.s159d, texels.right.s159d);
}

static inline LaneFloat blues(LaneTexels texels) {
  return (LaneFloat)(texels.left.s26ae, texels.right.s26ae);
}

static inline LaneFloat last_channels(LaneTexels texels) {
  return (LaneFloat)(texels.left.s37bf, texels.right.s37bf);
}

static inline LaneTexels with_last(LaneTexels texels, LaneFloat last) {
  texels.left.s37bf = last.lo;
  texels.right.s37bf = last.hi;
  return texels;
}

static inline LaneTexels times(LaneTexels texels, LaneFloat by) {
  const LaneTexels products = {texels.left * OF_FOUR(by.lo), texels.right * OF_FOUR(by.hi)};
  return products;
}

static inline LaneTexels over(LaneTexels texels, LaneFloat by) {
  const LaneTexels quotients = {texels.left / OF_FOUR(by.lo), texels.right / OF_FOUR(by.hi)};
  return quotients;
}

static inline LaneTexels add_texels(LaneTexels sum, LaneTexels texels) {
  const LaneTexels more = {sum.left + texels.left, sum.right + texels.right};
  return more;
}

static inline LaneTexels add_times(LaneTexels sum, LaneTexels texels, LaneFloat by) {
  const LaneTexels more = {sum.left + texels.left * OF_FOUR(by.lo),
                           sum.right + texels.right * OF_FOUR(by.hi)};
  return more;
}

// Moves texels to others, by `part` of the way.
static inline LaneTexels move_to(LaneTexels texels, LaneTexels to, LaneFloat part) {
  const LaneTexels moved = {texels.left + (to.left - texels.left) * OF_FOUR(part.lo),
                            texels.right + (to.right - texels.right) * OF_FOUR(part.hi)};
  return moved;
}

// Takes `chosen` in the lanes of the mask.
static inline LaneTexels select_texels(LaneTexels otherwise, LaneTexels chosen, LaneMask mask) {
  const LaneTexels taken = {as_float16(select(as_int16(otherwise.left), as_int16(chosen.left), OF_FOUR(mask.lo))),
                            as_float16(select(as_int16(otherwise.right), as_int16(chosen.right), OF_FOUR(mask.hi)))};
  return taken;
}

// The bits of all texels, or-ed.
static inline int4 any_bits(LaneTexels texels) {
  const int16 both = as_int16(texels.left) | as_int16(texels.right);
  const int8 pairs = both.lo | both.hi;
  return pairs.lo | pairs.hi;
}

static inline float16 channels_of_four(float4 red, float4 green, float4 blue, float4 last) {
  return (float16)(red.x, green.x, blue.x, last.x, red.y, green.y, blue.y, last.y, red.z, green.z, blue.z, last.z,
                   red.w, green.w, blue.w, last.w);
}

static inline LaneTexels texels_of(LaneFloat red, LaneFloat green, LaneFloat blue, LaneFloat last) {
  const LaneTexels texels = {channels_of_four(red.lo, green.lo, blue.lo, last.lo),
                             channels_of_four(red.hi, green.hi, blue.hi, last.hi)};
  return texels;
}
#else
typedef float4 LaneTexels;
#define no_texels() ((float4)(0.0f))
#define first_texel(texels) (texels)
#define push_texel(texels, texel) (texel)
#define reds(texels) ((texels).x)
#define greens(texels) ((texels).y)
#define blues(texels) ((texels).z)
#define last_channels(texels) ((texels).w)
#define with_last(texels, last) ((float4)((texels).xyz, last))
#define times(texels, by) ((texels) * (by))
#define over(texels, by) ((texels) / (by))
#define add_texels(sum, texels) ((sum) + (texels))
#define add_times(sum, texels, by) ((sum) + (texels) * (by))
#define select_texels(otherwise, chosen, mask) ((mask) ? (chosen) : (otherwise))
#define any_bits(texels) as_int4(texels)
#define texels_of(red, green, blue, last) ((float4)(red, green, blue, last))

static inline LaneTexels move_to(LaneTexels texels, LaneTexels to, LaneFloat part) {
  return texels + (to - texels) * part;
}
#endif
