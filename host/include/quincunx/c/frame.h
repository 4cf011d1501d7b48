/* SPDX-License-Identifier: MIT */
/* One frame's images, its other inputs and its report, for quincunx.h. The fields are those of image.h and
 * frame.h; docs/inputs.md states the conventions at length. The comment behind an image begins with its formats, which
 * programs in other languages may read there. */
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

struct quincunx_inputs;

/* Particles that were drawn into a viewport of their own; with settings.particle_target_*. */
typedef struct quincunx_particles {
  size_t struct_size;             /* sizeof(quincunx_particles) */
  const quincunx_image* colour;   /* RGBA16F, RGBA32F or RGBA8, over transparent black; alpha: coverage */
  const quincunx_image* depth;    /* R32F: the frame's depth resampled, of a surface that the pixel shows */
  const quincunx_image* reactive; /* R8 */
  int32_t render_width;           /* pixels of their viewport */
  int32_t render_height;
} quincunx_particles;

/* Whole pixels of the picture. */
typedef struct quincunx_rectangle {
  int32_t x, y, width, height;
} quincunx_rectangle;

/* A part of the picture that is drawn a second time, at a larger scale, as in focus.h; with settings.focus_*. */
typedef struct quincunx_focus {
  size_t struct_size; /* sizeof(quincunx_focus) */
  /* The frame of a camera that looks at just the region; without focus, particles, fade and sync. */
  const struct quincunx_inputs* frame;
  int32_t x, y;                         /* the output pixel at the region's upper left corner */
  const quincunx_rectangle* rectangles; /* where it shows, at most four; none: in the whole region */
  int32_t rectangle_count;
  float feather;              /* output pixels over which it sets in; 0: 16 */
  const quincunx_image* mask; /* R8, the region's extent; where settings.focus_mask is set */
} quincunx_focus;

/* A cross-fade from another method's picture of this frame; where settings.fades is set. */
typedef struct quincunx_fade {
  size_t struct_size;         /* sizeof(quincunx_fade) */
  const quincunx_image* from; /* RGBA32F or RGBA16F, as outputs.linear, in other memory */
  float weight;               /* of this frame's own picture, in [0, 1]; the rest is that of `from` */
  int32_t padding;            /* 0 */
} quincunx_fade;

/* Memory of another API, to be imported: external.h. */
typedef struct quincunx_external_memory {
  size_t struct_size; /* sizeof(quincunx_external_memory) */
  int32_t handle;     /* QUINCUNX_OPAQUE_FD, QUINCUNX_DMA_BUF or QUINCUNX_MAPPED */
  int32_t fd;         /* stays the caller's */
  void* mapped;       /* of QUINCUNX_MAPPED, at least 128 bytes aligned */
  size_t bytes;       /* at most as large as it was allocated */
  uint8_t device[16]; /* the UUID of the device that it was allocated on; all 0: not checked */
} quincunx_external_memory;

struct quincunx_semaphore;

/* The order of a frame's work among that of other queues of the device's context, and of other APIs. */
typedef struct quincunx_sync {
  size_t struct_size;    /* sizeof(quincunx_sync) */
  void* const* wait_for; /* cl_event: the frame's work begins when all are complete */
  int32_t wait_count;
  int32_t padding; /* 0 */
  /* If not NULL, receives a cl_event that is complete when the frame's work is, and that the caller releases; NULL if
   * the frame was refused or failed. */
  void** done;
  /* The frame's work begins when all of the former are signalled; at its end it signals all of the latter. */
  struct quincunx_semaphore* const* wait_semaphores;
  struct quincunx_semaphore* const* signal_semaphores;
  int32_t wait_semaphore_count;
  int32_t signal_semaphore_count;
} quincunx_sync;

/* Memory objects stay unchanged until the frame's work is done and, where quincunx_needs has keeps_previous_frame,
 * until that of the next frame is: the service copies nothing. So give frames n and n - 1 different ones. Host memory
 * is copied and free for reuse when the call returns. */
typedef struct quincunx_inputs {
  size_t struct_size;           /* sizeof(quincunx_inputs) */
  const quincunx_image* colour; /* RGBA16F or RGBA32F: linear light, premultiplied; RGBA8: as presented */
  /* Read only where quincunx_needs says so; else NULL will do. */
  const quincunx_image* depth;    /* R32F, as settings.depth_convention says */
  const quincunx_image* velocity; /* RG16F or RG32F, as settings.velocity_* say */
  const quincunx_image* reactive; /* R8: 0 trust history, 255 ignore it */
  int32_t render_width;           /* pixels of the viewport: the top left part of each image */
  int32_t render_height;
  float jitter_x; /* render pixels: the sample lies at the pixel's centre + jitter; in [-1, 1] */
  float jitter_y;
  float velocity_scale_x; /* factors that give velocity the unit of the settings; both 0: both 1 */
  float velocity_scale_y;
  /* Column-major: this frame's (ndc.x, ndc.y, depth, 1) to the previous frame's clip coordinates, both without jitter;
   * all as settings.clip_space says. All 0: a camera that stands still. */
  float clip_to_previous_clip[16];
  float exposure;       /* factor of linear colour before the tone map; 0: 1, and methods measure the light */
  int32_t reset;        /* not 0: a cut; nothing of the previous frames may be used */
  int32_t parity;       /* of a checkerboard: pixels with (x + y) % 2 == parity are shaded; 0 or 1 */
  int32_t padding;      /* 0 */
  uint64_t frame_index; /* the caller's number, echoed in the report */
  float near_plane;     /* distances of depth's planes, where settings.depth_convention needs them */
  float far_plane;
  int32_t
      output_width; /* the picture's size in this frame, from settings.min_output_* on; both 0: the output's */
  int32_t output_height;
  const quincunx_image* exposure_image; /* R32F, 1x1: a second factor of exposure; NULL: none */
  const quincunx_particles* particles;  /* NULL: none, as of what follows */
  const quincunx_focus* focus;
  const quincunx_fade* fade;
  const quincunx_sync* sync;
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

/* Motion and change in a frame, as shares of the picture's area in [0, 1]: content_statistics.h. */
typedef struct quincunx_content {
  size_t struct_size; /* sizeof(quincunx_content) */
  double moving;      /* that moves by a quarter of an output pixel or more */
  double speed_px;    /* mean speed of that share, output pixels a frame */
  double apart;       /* in which surfaces move apart from each other */
  double thin;        /* in which things thinner than four pixels move before something else */
  double light;       /* whose colour changes and has no velocity */
  double zoom;        /* that moves and grows or shrinks */
  int32_t cut;        /* 1: the first frame of a shot */
  int32_t judged;     /* 1: `light` includes moving light; 0: only reactive values */
} quincunx_content;

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
  int32_t output_width; /* pixels of the picture in this frame */
  int32_t output_height;
  int32_t focused;       /* 1: a focus was laid over the picture */
  int32_t content_known; /* 1: `content` was written; 0: settings.measures_content is 0, or not known yet */
  quincunx_content* content; /* in: where to write it, with its struct_size, or NULL */
  int32_t* in_focus;         /* in: room for pass_capacity, or NULL; out: 1 for passes of the focus */
  /* With settings.checks_motion, the verdict of the frames up to this one on velocity: "velocity.y seems to point the
   * other way", or that it points the right way; static. NULL: none, as when nothing moves. motion_check.h. */
  const char* motion;
  double motion_margin_db; /* advantage of that over the opposite sign */
} quincunx_report;

#endif
