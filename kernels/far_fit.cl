// SPDX-License-Identifier: MIT
// far_fit: fits the camera's motion to the surroundings, by least squares over all cells. Each parameter is regularised
// a little, so that one without evidence is 0.
//   cells     in   their number
//   sums      in   FarSums of each cell, from far_surroundings
//   previous  in   FarModel of the frame before; all zero where there is none
//   match     in   FarMatch of the frame before
//   motion    out  FarModel
// One work-group: an item sums some of the terms over all cells, so that the order of additions never changes, and the
// first one solves.
#include "motion/velocity_params.h"

#define LEAST_PIVOT 1e-7f  // relative to the diagonal, about 1: a smaller pivot is rounding alone

#define KEPT_MATCH 0.9f    // weight of the previous frames' evidence

// Damping: the part of a parameter's sum of squared terms that is added to it. Terms of higher order tell the least.
__constant const float kHold[kFarTerms] = {1e-6f, 1e-3f, 1e-6f, 1e-3f, 1e-4f, 1e-4f, 1e-4f, 1e-4f, 1e-4f};

// Returns the index of a product in the lower triangle, column <= row.
static inline int product_index(int row, int column) {
  return row * (row + 1) / 2 + column;
}

enum { kFarSums = kFarProducts + kFarTerms };  // floats of FarSums

// Cholesky's lower triangle, in place.
static inline void decompose(__local float* m) {
  for (int i = 0; i < kFarTerms; ++i) {
    for (int j = 0; j <= i; ++j) {
      float rest = m[product_index(i, j)];
      for (int k = 0; k < j; ++k) rest -= m[product_index(i, k)] * m[product_index(j, k)];
      m[product_index(i, j)] = i == j ? sqrt(max(rest, LEAST_PIVOT)) : rest / m[product_index(j, j)];
    }
  }
}

// In place, from the right side of the equations to the solution.
static inline void substitute(__local const float* lower, __local float* v) {
  for (int i = 0; i < kFarTerms; ++i) {
    for (int k = 0; k < i; ++k) v[i] -= lower[product_index(i, k)] * v[k];
    v[i] /= lower[product_index(i, i)];
  }
  for (int i = kFarTerms - 1; i >= 0; --i) {
    for (int k = i + 1; k < kFarTerms; ++k) v[i] -= lower[product_index(k, i)] * v[k];
    v[i] /= lower[product_index(i, i)];
  }
}

__kernel void far_fit(const int cells, __global const FarSums* sums, __global const FarModel* previous,
                      __global const FarMatch* match, __global FarModel* motion) {
  __local FarSums total;
  __local float* of_total = (__local float*)&total;
  for (int i = get_local_id(0); i < kFarSums; i += (int)get_local_size(0)) {
    __global const float* term = (__global const float*)sums + i;
    float sum = term[0];
    for (int cell = 1; cell < cells; ++cell) sum += term[cell * kFarSums];
    of_total[i] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (get_local_id(0) != 0) return;

  float scale[kFarTerms];
  for (int i = 0; i < kFarTerms; ++i) {
    const float square = total.products[product_index(i, i)];
    scale[i] = square > 0.0f ? 1.0f / sqrt(square) : 0.0f;
    total.velocities[i] *= scale[i];
  }
  for (int i = 0; i < kFarTerms; ++i) {
    for (int j = 0; j < i; ++j) total.products[product_index(i, j)] *= scale[i] * scale[j];
    total.products[product_index(i, i)] = 1.0f + kHold[i];
  }
  decompose(total.products);
  substitute(total.products, total.velocities);
  FarModel found;
  for (int i = 0; i < kFarTerms; ++i) found.p[i] = total.velocities[i] * scale[i];
  found.is_known = scale[0] > 0.0f;
  found.still = KEPT_MATCH * previous->still + (float)match->still;
  found.moved = KEPT_MATCH * previous->moved + (float)match->moved;
  *motion = found;
}
