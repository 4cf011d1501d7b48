// SPDX-License-Identifier: MIT
// How texels are stored: the options, the types of kernel arguments, indices.
//
// Options, each with its default:
//   SOURCE_STORAGE   BUFFER (default) | IMAGE         of colour, velocity, depth and reactive
//   SOURCE_FORMAT    HALF (default) | FLOAT | SRGB8   of colour in a buffer; SRGB8 of colour in an image, too
//   VELOCITY_FORMAT  HALF (default) | FLOAT           of velocity in a buffer
//   OUTPUT_FORMAT    FLOAT (default) | HALF           of the resolved picture, always a buffer
// An image is read without a sampler; its format is the image's own. SRGB8 is RGBA8 whose colour is sRGB encoded: every
// load gives linear light.
#pragma once

#include "lanes.h"
#include "params.h"

// Not zero, so that a misspelt option is an error.
#define BUFFER 1
#define IMAGE 2
#define HALF 3
#define FLOAT 4
#define SRGB8 5

#ifndef SOURCE_STORAGE
#define SOURCE_STORAGE BUFFER
#endif
#ifndef SOURCE_FORMAT
#define SOURCE_FORMAT HALF
#endif
#ifndef VELOCITY_FORMAT
#define VELOCITY_FORMAT HALF
#endif
#ifndef OUTPUT_FORMAT
#define OUTPUT_FORMAT FLOAT
#endif
#if SOURCE_STORAGE != BUFFER && SOURCE_STORAGE != IMAGE
#error "SOURCE_STORAGE must be BUFFER or IMAGE"
#endif
#if SOURCE_FORMAT != HALF && SOURCE_FORMAT != FLOAT && SOURCE_FORMAT != SRGB8
#error "SOURCE_FORMAT must be HALF, FLOAT or SRGB8"
#endif
#if VELOCITY_FORMAT != HALF && VELOCITY_FORMAT != FLOAT
#error "VELOCITY_FORMAT must be HALF or FLOAT"
#endif
#if OUTPUT_FORMAT != HALF && OUTPUT_FORMAT != FLOAT
#error "OUTPUT_FORMAT must be HALF or FLOAT"
#endif

// Mesa 25.0 (rusticl) loses an image that is the argument of a function that branches: reads crash its compiler, writes
// vanish. OpenCL C allows such functions (1.2, 6.9 b). With this attribute clang, which runs first, inlines them. PoCL
// has a macro of its own.
#if (SOURCE_STORAGE == IMAGE || (defined(OUTPUT_STORAGE) && OUTPUT_STORAGE == IMAGE)) && !defined(inline)
#define inline inline __attribute__((always_inline))
#endif

#if SOURCE_STORAGE == IMAGE
#define COLOUR_TEXELS read_only image2d_t
#define VELOCITY_TEXELS read_only image2d_t
#define DEPTH_TEXELS read_only image2d_t
#define REACTIVE_TEXELS read_only image2d_t
#define STORED_VELOCITY write_only image2d_t
#else
#if SOURCE_FORMAT == HALF
#define COLOUR_TEXELS __global const half*
#elif SOURCE_FORMAT == SRGB8
#define COLOUR_TEXELS __global const uchar*
#else
#define COLOUR_TEXELS __global const float*
#endif
#if VELOCITY_FORMAT == HALF
#define VELOCITY_TEXELS __global const half*
#define STORED_VELOCITY __global half*
#else
#define VELOCITY_TEXELS __global const float*
#define STORED_VELOCITY __global float*
#endif
#define DEPTH_TEXELS __global const float*
#define REACTIVE_TEXELS __global const uchar*
#endif

// The float nearest to an 8-bit code / 255: the first product is exact and 65536 times the second. A sum, since 1 minus
// a product may be contracted: fma(-255, 1 / 255, 1) is -5.9e-8 where 0 is meant (an NVIDIA H200, November 2026).
#define FRACTION_OF_CODE(code) ((code) * (257.0f / 65536.0f) + (code) * (1.0f / (255.0f * 65536.0f)))

// Hints for a CPU that memory is used soon; any address will do. The processor itself stops at the end of a page of
// memory. PoCL's prefetch() does nothing, and a GPU hides latency by other means.
#if LANES == 8
#define WILL_READ(address) __builtin_prefetch(address)
#define WILL_WRITE(address) __builtin_prefetch(address, 1)
#else
#define WILL_READ(address) ((void)(address))
#define WILL_WRITE(address) ((void)(address))
#endif

// Returns the index of texel (0, y).
static inline int row_index(TexelLayout layout, int y) {
  return layout.offset + y * layout.pitch;
}

static inline int texel_index(TexelLayout layout, int x, int y) {
  return row_index(layout, y) + x;
}
