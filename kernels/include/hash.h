// SPDX-License-Identifier: MIT
// Random values that belong to a pixel of the output: the same on every device and in every run.
// Source: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020: the permuted congruential generator in one
// step.
#pragma once

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
