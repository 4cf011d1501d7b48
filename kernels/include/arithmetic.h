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

// (1 - t / 8)^8: close to exp(-t), without its cost, and 0 from t = 8 on.
static inline float8 bell(float8 t) {
  const float8 rest = max(1.0f - 0.125f * t, 0.0f);
  const float8 square = rest * rest;
  const float8 fourth = square * square;
  return fourth * fourth;
}

// Where eight output pixels of a row lie between the samples of a viewport, on one axis: between samples `texel` and
// texel + 1, `fraction` of the way.
typedef struct Positions {
  int8 texel;
  float8 fraction;
} Positions;

// Loads those from `first` on of a table of `count` texels, then as many fractions.
static inline Positions load_positions(__global const int* table, int count, int first) {
#if ON_CPU
  const Positions at = {vload8(0, table + first), as_float8(vload8(0, table + count + first))};
#else
  const Positions at = {(int8)(table[first]), (float8)(as_float(table[count + first]))};
#endif
  return at;
}

// Shifted by less than 2^24 samples, anywhere.
static inline Positions shifted_positions(Positions at, float8 by) {
  const float8 sum = at.fraction + by;
  int8 step = convert_int8(sum);
  step += convert_float8(step) > sum;  // towards minus infinity
  const Positions shifted = {at.texel + step, sum - convert_float8(step)};
  return shifted;
}

// Clamped to an axis of last + 1 samples. Then texel + 1 exists, too, unless last is 0.
static inline Positions held_positions(Positions at, int last) {
  Positions held;
  held.texel = clamp(at.texel, (int8)(0), (int8)(max(last - 1, 0)));
  held.fraction = select(at.fraction, (float8)(0.0f), at.texel < 0);
  held.fraction = select(held.fraction, (float8)(last > 0 ? 1.0f : 0.0f), at.texel >= last);
  return held;
}

static inline Positions moved_positions(Positions at, float8 by, int last) {
  return held_positions(shifted_positions(at, by), last);
}

// The samples nearest to positions; of two equally near ones the upper/left.
static inline int8 nearest_samples(Positions at) {
  return at.texel - (at.fraction > 0.5f);
}
