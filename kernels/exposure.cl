// SPDX-License-Identifier: MIT
// exposure: finds the factor that makes exposed light of the frame's light, in which a usual scene has a mean of
// EXPOSED_MEAN. Rules with constants of light (history, sharpening) suit that, whatever the unit of light.
//   wanted    the caller's factor, where there is one; else EXPOSED_MEAN / mean. The mean is that of luma
//             over 32x16 blocks of up to 8x8 texels (4x4 after a frame with a factor), each at most 256 times the
//             geometric mean of all: lamps and fireflies do not make all else dark. Black, negative, infinite and
//             NaN texels do not count
//   factor    in a first frame the wanted one; else the previous one, times a power of two if that is more than 2^.75
//             from the wanted one, in two frames in the same direction. So history is rescaled without rounding, and
//             seldom: a flash, or an exposure that jumps for a frame, leaves no trace. Without light the factor stays;
//             in a first frame without light it is 1
//
//   params    in   viewport, layout, texels of a block, the caller's number
//   colour    in   RGBA16F, RGBA32F or, with SOURCE_FORMAT SRGB8, RGBA8, viewport, linear, premultiplied
//   image     in   a float that multiplies the caller's number, if it is positive and finite
//   previous  in   Exposure of the previous frame, if params.follows; all zero where there is none
//   exposure  out  Exposure
// One work-group. Where all light is a power of two times another frame's, so is the factor, exactly.
// Options: SOURCE_STORAGE, SOURCE_FORMAT as in texel.h
// Reference: tests/reference/exposure.cpp
#include "bits.h"
#include "picture_params.h"
#include "texel.h"

#define EXPOSED_MEAN 0.16f       // of exposed light: built-in scenes have .13 to .47, and do best at .1 to .3 [S]
#define BLOCK_MEAN_MAX 0x1p8f    // of the geometric mean
#define STEADY_MAX 1.6817928f    // 2^.75: factor by which what is wanted may differ from what there is
#define EXPOSURE_MAX 0x1p60f     // factor, either way: neither it nor a quotient of two leaves the normal floats [N]
#define LUMA_MAX 0x1p110f        // so that no sum is infinite [N]
#define LEAST_NORMAL 0x00800000  // as bits

// What is known of texels that count.
typedef struct Light {
  float sum;  // of luma
  int logs;   // of luma, as bits of floats are: 16 an octave
  int count;
} Light;

static inline Light light_of_block(const ExposureParams* params, COLOUR_TEXELS colour, int columns, int rows,
                                   int block) {
  const int left = block % kExposureColumns * columns, top = block / kExposureColumns * rows;
  Light light = {0.0f, 0, 0};
  for (int j = 0; j < rows; ++j) {
    const int y = (2 * (top + j) + 1) * params->height / (2 * kExposureRows * rows);
    for (int i = 0; i < columns; ++i) {
      const int x = (2 * (left + i) + 1) * params->width / (2 * kExposureColumns * columns);
      const float4 c = load_colour(colour, params->colour, x, y);
      const float luma = 0.25f * (c.x + c.z) + 0.5f * c.y;
      if (as_int(luma) < LEAST_NORMAL || as_int(luma) >= NON_FINITE_BITS) continue;
      light.sum += min(luma, LUMA_MAX);
      light.logs += as_int(luma) >> 13;
      light.count += 1;
    }
  }
  light.logs >>= 6;
  return light;
}

// Both limits are normal floats.
static inline float power_of_two(int exponent) {
  return as_float((clamp(exponent, -126, 127) + 127) << 23);
}

static inline int exponent_of(float value) {
  return (as_int(value) >> 23) - 127;
}

// Returns -1 or 1 where that much less or more is wanted than there is, else 0.
static inline int side_of(float ratio) {
  return ratio > STEADY_MAX ? 1 : ratio * STEADY_MAX < 1.0f ? -1 : 0;
}

// Returns the factor that follows that of the previous frame.
static inline float following(Exposure previous, float wanted) {
  const float ratio = wanted / previous.factor;
  const int side = side_of(ratio);
  if (side == 0 || side != side_of(previous.wanted / previous.factor)) return previous.factor;
  const int below = exponent_of(ratio);
  return previous.factor * power_of_two(ratio * power_of_two(-below) > M_SQRT2_F ? below + 1 : below);
}

__kernel void exposure(const ExposureParams params, COLOUR_TEXELS colour, __global const float* image,
                       __global const Exposure* previous, __global Exposure* exposure) {
  __local Light blocks[kExposureRows * kExposureColumns];
  __local Light rows[kExposureRows];
  const float factor = *image;
  const float by_image = factor > 0.0f && factor <= FLT_MAX ? factor : 0.0f;
  const float given = by_image == 0.0f ? params.given : by_image * (params.given > 0.0f ? params.given : 1.0f);
  const bool is_given = given > 0.0f;
  Exposure before = {0.0f, 0.0f, 0.0f, 0.0f};
  if (params.follows) before = *previous;
  const int part = before.factor > 0.0f ? 2 : 1;  // only a change of more than 2^.75 matters then
  const int columns = max(params.texels_x / part, 1), lines = max(params.texels_y / part, 1);
  const int first = get_local_id(0), step = get_local_size(0);
  for (int i = first; !is_given && i < kExposureRows * kExposureColumns; i += step)
    blocks[i] = light_of_block(&params, colour, columns, lines, i);
  barrier(CLK_LOCAL_MEM_FENCE);

  // The geometric mean. Sums are 0 where a factor is given: LLVM 19 aborts where loops over rows depend on that.
  for (int row = first; row < kExposureRows; row += step) {
    Light light = {0.0f, 0, 0};
    for (int i = row * kExposureColumns; !is_given && i < (row + 1) * kExposureColumns; ++i) {
      light.logs += blocks[i].logs;
      light.count += blocks[i].count;
    }
    rows[row] = light;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  int logs = 0, count = 0;
  for (int row = 0; row < kExposureRows; ++row) {
    logs += rows[row].logs;
    count += rows[row].count;
  }
  const float middle = as_float(count > 0 ? (logs / count) << 19 : LEAST_NORMAL);

  // The mean of blocks.
  for (int row = first; row < kExposureRows; row += step) {
    float sum = 0.0f;
    for (int i = row * kExposureColumns; !is_given && i < (row + 1) * kExposureColumns; ++i)
      sum += min(blocks[i].sum, BLOCK_MEAN_MAX * middle * (float)blocks[i].count);
    rows[row].sum = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (first != 0) return;
  float sum = 0.0f;
  for (int row = 0; row < kExposureRows; ++row) sum += rows[row].sum;

  float wanted = 0.0f;
  if (is_given || count > 0)
    wanted = clamp(is_given ? given : EXPOSED_MEAN * (float)count / sum, 1.0f / EXPOSURE_MAX,
                   EXPOSURE_MAX);
  Exposure found = {1.0f, 1.0f, 1.0f, wanted > 0.0f ? wanted : 1.0f};
  if (before.factor > 0.0f) {
    found.factor = wanted > 0.0f ? following(before, wanted) : before.factor;
    found.change = found.factor / before.factor;
    if (wanted == 0.0f) found.wanted = before.factor;
  } else if (wanted > 0.0f) {
    found.factor = wanted;
  }
  found.inverse = 1.0f / found.factor;
  *exposure = found;
}
