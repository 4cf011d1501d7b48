// SPDX-License-Identifier: MIT
// Arithmetic that several kernels share.
#pragma once

#include "bits.h"

// a * b + c rounded the same way wherever it stands: once where the device fuses fast, twice elsewhere. Without it a
// compiler may fuse one copy of a sum and not another, and two ways to the same pixel differ in the last bit.
#if defined(FP_FAST_FMAF) || defined(__FMA__) || defined(__aarch64__)  // PoCL says it by its processor only
#define MULTIPLY_ADD(a, b, c) fma(a, b, c)
#else
#pragma OPENCL FP_CONTRACT OFF
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#endif

// Rounds towards minus infinity what an int can hold. PoCL's floor() of one or two floats takes branches.
static inline int2 floor2(float2 value) {
  const int2 whole = convert_int2(value);
  return whole + (convert_float2(whole) > value);
}

// (1 - t / 8)^8: close to exp(-t), without its cost, and 0 from t = 8 on.
#define DEFINE_BELL(name, type)                      \
  static inline type name(type t) {                  \
    const type rest = max(1.0f - 0.125f * t, 0.0f);  \
    const type square = rest * rest;                 \
    const type fourth = square * square;             \
    return fourth * fourth;                          \
  }
DEFINE_BELL(bell, LaneFloat)
DEFINE_BELL(bell8, float8)

// Where output pixels of a row lie between the samples of a viewport, on one axis: between samples `texel` and
// texel + 1, `fraction` of the way.
typedef struct Positions {
  LaneInt texel;
  LaneFloat fraction;
} Positions;

// Loads those from `first` on of a table of `count` texels, then as many fractions.
static inline Positions load_positions(__global const int* table, int count, int first) {
  const Positions at = {LOAD_LANES(table + first), as_lane_float(LOAD_LANES(table + count + first))};
  return at;
}

// Shifted by less than 2^24 samples, anywhere.
static inline Positions shifted_positions(Positions at, LaneFloat by) {
  const LaneFloat sum = at.fraction + by;
  const LaneInt step = floor_lanes(sum);
  const Positions shifted = {at.texel + step, sum - to_lane_float(step)};
  return shifted;
}

// Clamped to an axis of last + 1 samples. Then texel + 1 exists, too, unless last is 0.
static inline Positions held_positions(Positions at, int last) {
  Positions held;
  held.texel = clamp(at.texel, (LaneInt)(0), (LaneInt)(max(last - 1, 0)));
  held.fraction = select(at.fraction, (LaneFloat)(0.0f), at.texel < 0);
  held.fraction = select(held.fraction, (LaneFloat)(last > 0 ? 1.0f : 0.0f), at.texel >= last);
  return held;
}

static inline Positions moved_positions(Positions at, LaneFloat by, int last) {
  return held_positions(shifted_positions(at, by), last);
}

// The samples nearest to positions; of two equally near ones the upper/left.
static inline LaneInt nearest_samples(Positions at) {
  return select(at.texel, at.texel + 1, at.fraction > 0.5f);
}
