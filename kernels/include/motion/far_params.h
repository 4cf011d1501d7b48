// SPDX-License-Identifier: MIT
// Structs that host and the kernels for the velocity of what is infinitely far away share, as in params.h.
#pragma once

#include "motion/velocity_params.h"
#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// How the camera moves its picture, as in motion/far_motion.h.
enum { kFarTerms = 9, kFarProducts = 45, kFarCell = 32 };  // parameters, products of two of their terms, samples
typedef struct FarModel {
  float p[kFarTerms];
  int is_known;        // 0: nothing around tells
  float still, moved;  // FarMatch of all frames before, each counting .9 of the one after it
} FarModel;
QUINCUNX_CHECK_SIZE(FarModel, 48);

// Sums over a cell's samples: of the products of two terms, the lower triangle row by row, and of terms and velocities.
typedef struct FarSums {
  float products[kFarProducts];
  float velocities[kFarTerms];
} FarSums;
QUINCUNX_CHECK_SIZE(FarSums, 216);

// How wrong two forecasts of what is infinitely far away are: that it stands still, and that it moves as a FarModel.
typedef struct FarMatch {
  int still, moved;
} FarMatch;
QUINCUNX_CHECK_SIZE(FarMatch, 8);

// Sample (i, j) lies at (i * step_x + start_x, j * step_y + start_y): heights of the picture from its middle.
typedef struct FarPlaces {
  float step_x, step_y, start_x, start_y;
} FarPlaces;
QUINCUNX_CHECK_SIZE(FarPlaces, 16);

typedef struct FarSumsParams {
  int width;  // the viewport, in texels
  int height;
  int cells_x;
  int cells_y;
  TexelLayout depth;
  TexelLayout drawn;
  FarPlaces places;
  float from_drawn_x, from_drawn_y;  // from the units of the drawn velocity to heights of the picture
  float pixels;                      // of the output's height
} FarSumsParams;
QUINCUNX_CHECK_SIZE(FarSumsParams, 16 + 16 + 16 + 12);

typedef struct FarMatchParams {
  int width;  // the viewports, in texels
  int height;
  int previous_width;
  int previous_height;
  int cells_x;
  int cells_y;
  TexelLayout depth0, depth1;
  TexelLayout drawn;
  TexelLayout colour0, colour1;
  FarPlaces places;
  // Sample (i, j) lies at (i * step_x + start_x, j * step_y + start_y) among those of the previous frame.
  float step_x, step_y, start_x, start_y;
  float to_previous_x, to_previous_y;  // from heights of the picture to samples of the previous frame
  float units;                         // of FarMatch, to a difference of 1
} FarMatchParams;
QUINCUNX_CHECK_SIZE(FarMatchParams, 24 + 40 + 16 + 28);

typedef struct FarVelocityParams {
  VelocityParams frame;
  TexelLayout drawn;
  FarPlaces places;
  float to_drawn_x, to_drawn_y;  // from uv, or heights of the picture, to the units of the drawn velocity
} FarVelocityParams;
QUINCUNX_CHECK_SIZE(FarVelocityParams, 108 + 8 + 16 + 8);

#ifdef __cplusplus
}  // namespace quincunx
#endif
