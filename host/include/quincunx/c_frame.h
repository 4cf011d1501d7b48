/* SPDX-License-Identifier: MIT */
/* One frame's images, what goes with them and what is told of it, for quincunx.h. The fields are those of image.h and
 * frame.h; docs/inputs.md states the conventions at length. */
#ifndef QUINCUNX_C_FRAME_H
#define QUINCUNX_C_FRAME_H

#include <stddef.h>
#include <stdint.h>

/* Rows run top-down, x to the right. The memory is the caller's. */
typedef struct quincunx_image {
  size_t struct_size; /* sizeof(quincunx_image) */
  int32_t place;      /* QUINCUNX_BUFFER, QUINCUNX_IMAGE2D (both as settings.storage says) or QUINCUNX_HOST */
  int32_t format;     /* QUINCUNX_RGBA16F, ... as the plan has it */
  int32_t width;      /* pixels, of what is allocated */
  int32_t height;
  size_t offset; /* bytes from the start of a buffer to the first texel, a multiple of 16; else 0 */
  /* Bytes from one row to the next; 0: tightly packed. Of a buffer a multiple of a texel's bytes; of an image2d 0. */
  size_t pitch;
  void* memory; /* a cl_mem, or the address of the first texel in host memory */
} quincunx_image;

/* Memory objects stay unchanged until the frame's work is done and, where quincunx_needs has keeps_previous_frame,
 * until that of the next frame is: the service copies nothing. So give frames n and n - 1 different ones. Host memory
 * is copied and free for reuse when the call returns. */
typedef struct quincunx_inputs {
  size_t struct_size; /* sizeof(quincunx_inputs) */
  /* RGBA16F or RGBA32F: linear light, premultiplied. RGBA8: exposed, tone mapped and sRGB encoded. */
  const quincunx_image* colour;
  /* Read only where quincunx_needs says so; else NULL will do. */
  const quincunx_image* depth;    /* R32F, as settings.depth_convention says */
  const quincunx_image* velocity; /* RG16F or RG32F, as settings.velocity_* say */
  const quincunx_image* reactive; /* R8: 0 trust history, 255 ignore it */
  int32_t render_width;           /* pixels of the viewport: the top left part of each image */
  int32_t render_height;
  float jitter_x; /* render pixels: the sample lies at the pixel's centre + jitter; in [-1, 1] */
  float jitter_y;
  float velocity_scale_x; /* makes velocity what the settings say; both 0: both 1 */
  float velocity_scale_y;
  /* Column-major: this frame's (ndc.x, ndc.y, depth, 1) to the previous frame's clip coordinates, both without jitter;
   * all as settings.clip_space says. All 0: a camera that stands still. */
  float clip_to_previous_clip[16];
  float exposure;       /* multiplies linear colour of the presented picture; 0: 1 */
  int32_t reset;        /* not 0: a cut; nothing of the previous frames may be used */
  int32_t parity;       /* of a checkerboard: pixels with (x + y) % 2 == parity are shaded; 0 or 1 */
  int32_t padding;      /* 0 */
  uint64_t frame_index; /* the caller's number, echoed in the report */
  float near_plane;     /* distances of depth's planes, where settings.depth_convention needs them */
  float far_plane;
} quincunx_inputs;

/* The finished picture. At least one, of the output's size; NULL leaves it out. Host memory beyond a row's texels stays
 * as it is. */
typedef struct quincunx_outputs {
  size_t struct_size;           /* sizeof(quincunx_outputs) */
  const quincunx_image* linear; /* RGBA32F or RGBA16F, linear light; as settings.linear_format says */
  const quincunx_image*
      presented; /* RGBA8: exposed, tone mapped, sRGB encoded; where settings.present is set */
} quincunx_outputs;

enum { QUINCUNX_MAX_PASSES = 72 };

typedef struct quincunx_pass_report {
  const char* kernel; /* "resolve_quincunx"; static */
  double ms;          /* device time; -1: not known (yet) */
  uint64_t bytes;     /* read and written, each texel counted once */
} quincunx_pass_report;

typedef struct quincunx_report {
  size_t struct_size;           /* sizeof(quincunx_report) */
  quincunx_pass_report* passes; /* in: room for pass_capacity of them, or NULL */
  int32_t pass_capacity;        /* in; QUINCUNX_MAX_PASSES holds all */
  int32_t pass_count;           /* how many passes ran, which may be more than there is room for */
  uint64_t frame_index;
  int64_t
      non_finite_pixels; /* output pixels that met NaN or infinity in their footprint; -1: not known yet */
  int32_t render_width;  /* pixels of the viewport */
  int32_t render_height;
  float ratio_x; /* render / output */
  float ratio_y;
  int32_t used_previous; /* 1: history contributed */
  int32_t padding;
} quincunx_report;

#endif
