/* SPDX-License-Identifier: MIT */
/* The scene's needs and the settings of the resolve, for quincunx.h. The fields are those of SceneNeeds and
 * ResolveSettings in resolve_plan.h and method.h, which say more of each. */
#ifndef QUINCUNX_C_SETTINGS_H
#define QUINCUNX_C_SETTINGS_H

#include <stddef.h>
#include <stdint.h>

/* Numbers of the fields that choose; an enum is named as its field. They never change their meaning. */

/* How the picture is made from the frames. */
enum quincunx_method {
  QUINCUNX_POINT = 0,
  QUINCUNX_BILINEAR = 1,
  QUINCUNX_B_SPLINE = 2,
  QUINCUNX_CATMULL_ROM = 3,
  QUINCUNX_MITCHELL = 4,
  QUINCUNX_LANCZOS2 = 5,
  QUINCUNX_LANCZOS3 = 6,
  QUINCUNX_NOISE = 7,
  QUINCUNX_NOISE_OFFSET = 8,
  QUINCUNX_TWO_FRAMES = 9, /* "quincunx": this frame and the previous one */
  QUINCUNX_TEMPORAL = 10   /* all frames so far; needs quincunx_jitter() */
};
/* How the previous frame counts. */
enum quincunx_two_frame_form { QUINCUNX_MEAN = 0, QUINCUNX_BY_VELOCITY = 1, QUINCUNX_REPROJECTED = 2 };
enum quincunx_sampling { QUINCUNX_SAMPLE_POINT = 0, QUINCUNX_SAMPLE_BILINEAR = 1 };
enum quincunx_temporal_preset { QUINCUNX_FAST = 0, QUINCUNX_BALANCED = 1, QUINCUNX_QUALITY = 2 };
enum quincunx_sky_motion { QUINCUNX_AS_DRAWN = 0, QUINCUNX_BY_CAMERA = 1, QUINCUNX_BY_EVIDENCE = 2 };
enum quincunx_drawn_velocity { QUINCUNX_OWN_VELOCITY = 0, QUINCUNX_DILATED_VELOCITY = 1 };
enum quincunx_tone_map { QUINCUNX_CLAMP = 0, QUINCUNX_REINHARD = 1, QUINCUNX_ACES = 2 };
enum quincunx_shading { QUINCUNX_FULL = 0, QUINCUNX_CHECKERBOARD = 1 };
enum quincunx_targets { QUINCUNX_VIEWPORT = 0, QUINCUNX_PLACED = 1 };
enum quincunx_place { QUINCUNX_BUFFER = 0, QUINCUNX_IMAGE2D = 1, QUINCUNX_HOST = 2 }; /* storage, too */
enum quincunx_depth_convention {
  QUINCUNX_REVERSED_INFINITE = 0, /* near / distance: 1 at the near plane, 0 at infinity */
  QUINCUNX_REVERSED = 1,          /* 1 at the near plane, 0 at the far plane */
  QUINCUNX_INFINITE = 2,          /* 0 at the near plane, 1 at infinity */
  QUINCUNX_FORWARD = 3,           /* 0 at the near plane, 1 at the far plane */
  QUINCUNX_LINEAR = 4             /* the distance along the view axis */
};
enum quincunx_clip_space { QUINCUNX_DIRECT3D = 0, QUINCUNX_OPENGL = 1, QUINCUNX_VULKAN = 2 };
enum quincunx_velocity_unit { QUINCUNX_UV = 0, QUINCUNX_PIXELS = 1, QUINCUNX_NDC = 2 };
enum quincunx_origin { QUINCUNX_TOP = 0, QUINCUNX_BOTTOM = 1 };
/* What the picture shows. */
enum quincunx_temporal_view {
  QUINCUNX_VIEW_PICTURE = 0,
  QUINCUNX_VIEW_CONFIDENCE = 1,
  QUINCUNX_VIEW_REJECTION = 2,
  QUINCUNX_VIEW_PHASE = 3,
  QUINCUNX_VIEW_LAYERS = 4,
  QUINCUNX_VIEW_COVERAGE = 5,
  QUINCUNX_VIEW_NEAR = 6,
  QUINCUNX_VIEW_FAR = 7
};
/* Channels, bits of each, F: floating point; colours are linear light with premultiplied alpha. */
enum quincunx_format {
  QUINCUNX_R8 = 1,
  QUINCUNX_R32F = 2,
  QUINCUNX_RG16F = 3,
  QUINCUNX_RG32F = 4,
  QUINCUNX_RGBA8 = 5, /* sRGB encoded */
  QUINCUNX_RGBA16F = 6,
  QUINCUNX_RGBA32F = 7
};

typedef struct quincunx_settings {
  size_t struct_size; /* sizeof(quincunx_settings) */
  /* Everything that the scene may do: 0 no, else yes. */
  int32_t moving_objects; /* anything but the camera moves; default 1 */
  int32_t camera_motion;  /* default 1 */
  int32_t transparents;   /* drawn without velocity, with reactive values; default 1 */
  int32_t background;     /* something covers every pixel; default 1 */

  int32_t method; /* default QUINCUNX_TEMPORAL */
  /* Pixels. */
  int32_t output_width, output_height; /* of the picture; no default */
  int32_t target_width, target_height; /* of the inputs: at least the largest viewport; no default */
  int32_t colour_format;               /* of the input: RGBA8, RGBA16F (default) or RGBA32F */
  int32_t velocity_format;             /* of the input: RG16F (default) or RG32F */
  int32_t linear_format;               /* of the linear picture: RGBA16F or RGBA32F (default) */
  int32_t storage;                     /* of memory objects: QUINCUNX_BUFFER (default) or QUINCUNX_IMAGE2D */
  int32_t targets;                     /* default QUINCUNX_VIEWPORT */
  int32_t shading;                     /* default QUINCUNX_FULL */
  int32_t present;                     /* make the presented picture, too; default 1 */
  int32_t clear;                       /* quincunx_clear() will be called; default 0 */
  int32_t tone_map;                    /* of the presented picture; default QUINCUNX_ACES */
  int32_t dither;                      /* of the presented picture; default 1 */
  int32_t clamp_ringing;               /* of filters that ring; default 1 */
  int32_t noise_moves;                 /* of the noise methods: another pattern every frame; default 1 */
  int32_t sky_motion;                  /* of far samples without velocity; default QUINCUNX_AS_DRAWN */
  int32_t two_frame_form;              /* default QUINCUNX_BY_VELOCITY */
  int32_t sampling;                    /* of two frames; default QUINCUNX_SAMPLE_BILINEAR */
  int32_t temporal_preset;             /* default QUINCUNX_BALANCED */
  int32_t temporal_view;               /* default QUINCUNX_VIEW_PICTURE */
  int32_t history_format;              /* of QUINCUNX_TEMPORAL: RGBA16F (default) or RGBA32F */
  int32_t blur_samples;                /* of motion blur: 4, 8 (default), 16, 32 or 64 */
  float shutter;                       /* part of a frame's time, in [0, 2]; default 0: no motion blur */
  float sharpness;                     /* in [0, 1]; default 0 */
  float grain;                         /* of QUINCUNX_NOISE, in [0, 1]; default 0.25 */
  float velocity_weight;               /* of QUINCUNX_BY_VELOCITY; default 1 */
  float residual_weight;               /* of QUINCUNX_REPROJECTED; default 0 */
  int32_t drawn_velocity;              /* default QUINCUNX_OWN_VELOCITY */
  /* Meaning of the inputs, as conventions.h has it. */
  int32_t depth_convention;    /* default QUINCUNX_REVERSED_INFINITE */
  int32_t clip_space;          /* of clip_to_previous_clip; default QUINCUNX_DIRECT3D */
  int32_t velocity_unit;       /* default QUINCUNX_UV */
  int32_t velocity_backward;   /* previous position - this one; default 0 */
  int32_t velocity_up;         /* +y up; default 0 */
  int32_t velocity_jittered;   /* the jitter is in it; default 0 */
  int32_t origin;              /* first row of all images; default QUINCUNX_TOP */
  int32_t conventions_padding; /* 0 */
  /* Pixels; both 0, the default: none. */
  int32_t min_output_width, min_output_height; /* a dynamic output: the smallest one of a frame */
  int32_t particle_target_width,
      particle_target_height;                      /* of inputs.particles, whose viewport is their own */
  int32_t focus_width, focus_height;               /* the focus's region, in output pixels */
  int32_t focus_target_width, focus_target_height; /* of its inputs; both 0: as the region */
  int32_t focus_mask;                              /* focus.mask is given; default 0 */
  int32_t measures_content;                        /* report.content is wanted; default 0 */
  int32_t fades;                                   /* inputs.fade may be given; default 0 */
  float temporal_noise;   /* variance of a sample, in parts of its square: 1 / samples a pixel; default 0 */
  int32_t checks_motion;  /* for debugging: report.motion is wanted; default 0 */
  int32_t checks_padding; /* 0 */
} quincunx_settings;

/* The needs of a plan, for those who provide the images: 0 no, 1 yes. */
typedef struct quincunx_needs {
  size_t struct_size;     /* sizeof(quincunx_needs) */
  int32_t reads_depth;    /* inputs.depth is needed */
  int32_t reads_velocity; /* inputs.velocity is needed */
  int32_t reads_reactive; /* inputs.reactive is needed */
  int32_t reads_camera;   /* inputs.clip_to_previous_clip is needed */
  int32_t
      keeps_previous_frame;  /* memory objects of a frame must stay until the work of the next one is done */
  int32_t presented_storage; /* of outputs.presented: QUINCUNX_BUFFER or QUINCUNX_IMAGE2D */
  int32_t accumulates;       /* all frames since the last reset count */
  int32_t padding;           /* 0 */
  uint64_t frame_bytes;      /* of the inputs of one frame, at most */
} quincunx_needs;

#endif
