// SPDX-License-Identifier: MIT
// Structs that host and the kernels that make, mend or follow velocities share, as in params.h.
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

typedef struct ConvertParams {
  int width;  // the viewport, in texels
  int height;
  TexelLayout given;  // of an image: its rows
  TexelLayout made;
  int columns_per_item;
  int is_linear;             // depth is a distance; else it lies between planes,
  int is_reversed;           // 1 at the near one
  float near_plane;          // of a distance
  float near_by_far;         // the near plane's distance over the far one's; 0: that is infinite
  float jitter_x, jitter_y;  // by how much the jitters alone move a still surface, in the units of the velocity
} ConvertParams;
QUINCUNX_CHECK_SIZE(ConvertParams, 8 + 16 + 28);

typedef struct UndilateParams {
  VelocityParams frame;
  TexelLayout dilated;
  float to_drawn_x, to_drawn_y;  // from uv to the units of the drawn velocity
  int has_camera;                // the camera's motion is known
} UndilateParams;
QUINCUNX_CHECK_SIZE(UndilateParams, 108 + 8 + 8 + 4);

// ---- The velocity of what is infinitely far away.

// How the camera moves its picture, as in motion/camera_velocity.h.
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
  float pixels;                      // height of the output, in pixels
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
  float units;                         // number of FarMatch's units in a difference of 1
} FarMatchParams;
QUINCUNX_CHECK_SIZE(FarMatchParams, 24 + 40 + 16 + 28);

typedef struct FarVelocityParams {
  VelocityParams frame;
  TexelLayout drawn;
  FarPlaces places;
  float to_drawn_x, to_drawn_y;  // from uv, or heights of the picture, to the units of the drawn velocity
} FarVelocityParams;
QUINCUNX_CHECK_SIZE(FarVelocityParams, 108 + 8 + 16 + 8);

// ---- reproject.

// Reprojection of one sample of this frame: the surface that it shows was at the sample's own place + (x, y) in the
// previous frame. Written by reproject.
typedef struct Reprojection {
  float x, y;   // pixels of the previous frame's viewport, within +-65504
  float trust;  // in [0, 1]: of what the previous frame holds there; NaN: the sample's velocity or depth is not finite
  // The motion edge at the sample: the largest difference of velocity to its eight neighbours, output pixels a frame.
  // If that of the previous frame at the place above was larger, it stands here as a negative number. 0 without
  // MOTION_EDGE. -0 from layer_split on: the sample has two layers (layers/layer.h).
  float motion_edge;
} Reprojection;
QUINCUNX_CHECK_SIZE(Reprojection, 16);

typedef struct ReprojectParams {
  int width;  // the viewport of this frame
  int height;
  int previous_width;
  int previous_height;
  TexelLayout velocity0;
  TexelLayout velocity1;
  TexelLayout depth0;
  TexelLayout depth1;
  TexelLayout reactive0;
  TexelLayout reactive1;
  TexelLayout reprojection;
  TexelLayout previous_reprojection;
  int columns_per_item;  // pixels that a work-item makes, at least
  // The texel coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands
  // still: (i * step_x + start_x, j * step_y + start_y).
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from velocity0 to pixels of the previous frame, backwards in time
  float edge_x, edge_y;  // the left and the upper edge of the previous frame, as texel coordinates
  // From the units of the velocity source to sqrt(K) render pixels, per frame.
  float speed0_x, speed0_y;
  float speed1_x, speed1_y;
  float motion_edge_x, motion_edge_y;  // from velocity0 to output pixels
  // The distance, over that in this frame, that what sample (i, j) shows had in the previous frame if it stands still
  // and has the depth d: i * distance_x + j * distance_y + d * distance_depth + distance_start.
  float distance_x, distance_y, distance_depth, distance_start;
} ReprojectParams;
QUINCUNX_CHECK_SIZE(ReprojectParams, 16 + 64 + 4 + 72);

#ifdef __cplusplus
}  // namespace quincunx
#endif
