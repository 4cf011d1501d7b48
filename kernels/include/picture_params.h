// SPDX-License-Identifier: MIT
// Structs that host and the kernels before and after a resolve share, as in params.h: those of a finished picture, of
// measure_content, of check_motion and of overlay_particles.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

enum { kPresentBlock = 16 };  // pixels that present, whose pixels are small, makes at once

typedef struct SharpenParams {
  int width;
  int height;
  TexelLayout source;
  TexelLayout output;
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  float sharpness;       // in [0, 1]
} SharpenParams;
QUINCUNX_CHECK_SIZE(SharpenParams, 32);

// A rectangle of a focus, in pixels of its region, whose weight rises from 0 at an edge to 1 within 1 / rate pixels.
typedef struct FocusRectangle {
  float left, top, right, bottom;
  float rate;
} FocusRectangle;
QUINCUNX_CHECK_SIZE(FocusRectangle, 20);

enum { kMostFocusRectangles = 4 };

typedef struct FocusParams {
  int left, top;         // corner of the part that is laid over, in pixels of the region
  int width, height;     // size of that part
  TexelLayout focus;     // layout of the region
  TexelLayout mask;      // layout of its mask
  TexelLayout output;    // layout of the picture, from the region's first pixel on
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  int rectangle_count;   // at least 1
  FocusRectangle rectangles[kMostFocusRectangles];
} FocusParams;
QUINCUNX_CHECK_SIZE(FocusParams, 128);

typedef struct CrossFadeParams {
  int width;
  int height;
  TexelLayout other;
  TexelLayout output;
  int columns_per_item;
  float weight;  // the picture's, in [0, 1]
} CrossFadeParams;
QUINCUNX_CHECK_SIZE(CrossFadeParams, 32);

// ---- exposure.
// What exposed light is to scene light. Exact inverses where both are powers of two.
typedef struct Exposure {
  float factor;   // times scene light: exposed light
  float inverse;  // times exposed light: scene light
  float change;   // times exposed light of the previous frame: that of this one; a power of two, 1 in a first frame
  float wanted;   // what the factor would be in a first frame
} Exposure;
QUINCUNX_CHECK_SIZE(Exposure, 16);

// Blocks of the viewport, and at most so many texels of each on each axis.
enum { kExposureColumns = 32, kExposureRows = 16, kExposureTexels = 8 };

typedef struct ExposureParams {
  int width;  // the viewport
  int height;
  int texels_x;  // of a block
  int texels_y;
  TexelLayout colour;
  float given;  // the caller's factor; 0: there is none
  int follows;  // 0: every frame counts as the first
} ExposureParams;
QUINCUNX_CHECK_SIZE(ExposureParams, 32);

typedef struct PresentParams {
  int width;
  int height;
  TexelLayout source;
  TexelLayout output;
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes, at least
  float exposure;
} PresentParams;
QUINCUNX_CHECK_SIZE(PresentParams, 36);

typedef struct ClearParams {
  int width;
  int height;
  int columns_per_item;  // pixels that a work-item clears
  TexelLayout output;
  unsigned bits[4];  // one texel as a buffer holds it, in the lowest bytes
  float value[4];    // the same for an image
} ClearParams;
QUINCUNX_CHECK_SIZE(ClearParams, 52);

// ---- measure_content.
// A tile of the picture is about kContentTile^2 output pixels, of which kContentSamples^2 are asked what they show.
enum { kContentTile = 32, kContentSamples = 8 };

// Numbers of samples, over the whole picture; `speed` in 1/16 output pixels, summed over the moving ones.
typedef struct ContentSums {
  unsigned moving;
  unsigned speed;
  unsigned apart;
  unsigned thin;
  unsigned light;
  unsigned zoom;
  unsigned judged;
} ContentSums;
QUINCUNX_CHECK_SIZE(ContentSums, 28);

typedef struct ContentParams {
  int width;  // the viewport, in texels
  int height;
  int tiles_x;
  int tiles_y;
  TexelLayout velocity;
  TexelLayout depth;
  TexelLayout reactive;
  int reach_x;  // texels to either side of what is thin
  int reach_y;
  float pixels_x;  // output pixels in a unit of velocity
  float pixels_y;
  float step_x;  // output pixels between two samples
  float step_y;
  int judged_width;  // output pixels, whose light has been judged; 0: nobody has looked
  int judged_height;
} ContentParams;
QUINCUNX_CHECK_SIZE(ContentParams, 72);

// ---- check_motion.
// Every kMotionStep-th sample of every such row is asked, kMotionSamples^2 by a work-item. Velocity is read in
// kMotionReadings ways: as it is, with x turned, with y turned, with both.
enum { kMotionStep = 8, kMotionSamples = 4, kMotionReadings = 4, kMotionUnits = 255 };

// Numbers of samples that move along an axis, and their errors, of a sample at most kMotionUnits, so that those of
// 32768^2 fit.
typedef struct MotionAxisSums {
  unsigned samples;
  unsigned errors[kMotionReadings];
} MotionAxisSums;
QUINCUNX_CHECK_SIZE(MotionAxisSums, 20);

typedef struct MotionSums {
  MotionAxisSums x, y;
} MotionSums;
QUINCUNX_CHECK_SIZE(MotionSums, 40);

typedef struct MotionCheckParams {
  int width;  // the viewports, in texels
  int height;
  int previous_width;
  int previous_height;
  int items_x;
  int items_y;
  TexelLayout velocity;
  TexelLayout colour0, colour1;
  // Sample (i, j) lies at (i * step_x + start_x, j * step_y + start_y) among those of the previous frame.
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from velocity to samples of the previous frame, backwards in time
} MotionCheckParams;
QUINCUNX_CHECK_SIZE(MotionCheckParams, 72);

// ---- overlay_particles.
// Runs of this many neighbouring pixels of a row are copied at once where no particle is.
enum { kParticleBlock = 8 };

typedef struct OverlayParams {
  int width;  // the viewport of the frame
  int height;
  int particle_width;  // that of the particles
  int particle_height;
  int columns_per_item;  // a multiple of kParticleBlock
  TexelLayout bare_colour, bare_reactive, depth;
  TexelLayout particle_colour, particle_reactive, particle_depth;
  TexelLayout colour, reactive;
} OverlayParams;
QUINCUNX_CHECK_SIZE(OverlayParams, 20 + 8 * 8);

#ifdef __cplusplus
}  // namespace quincunx
#endif
