// SPDX-License-Identifier: MIT
// Structs that host and the kernels that make or mend velocities share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// Velocity derived from depth at texel (i, j): the sample lies at ndc (i * step_x + start_x, j * step_y + start_y).
typedef struct CameraVelocity {
  float step_x, step_y, start_x, start_y;
  float to_previous[16];  // column-major, ndc of this frame to homogeneous clip of the previous one
} CameraVelocity;
QUINCUNX_CHECK_SIZE(CameraVelocity, 80);

typedef struct VelocityParams {
  int width;  // the viewport, in texels
  int height;
  TexelLayout depth;
  TexelLayout velocity;
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  CameraVelocity camera;
} VelocityParams;
QUINCUNX_CHECK_SIZE(VelocityParams, 28 + 80);

typedef struct UndilateParams {
  VelocityParams frame;
  TexelLayout dilated;
  float to_drawn_x, to_drawn_y;  // from uv to the units of the drawn velocity
  int has_camera;                // the camera's motion is known
} UndilateParams;
QUINCUNX_CHECK_SIZE(UndilateParams, 108 + 8 + 8 + 4);

#ifdef __cplusplus
}  // namespace quincunx
#endif
