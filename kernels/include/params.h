// SPDX-License-Identifier: MIT
// Structs that host and kernels share. 4-byte scalars only, so that both sides lay them out alike on every device.
// Those of the temporal upscaler are in temporal/tile.h and temporal/temporal_params.h.
#pragma once

#ifdef __cplusplus
namespace quincunx {
#define QUINCUNX_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#else
#define QUINCUNX_CHECK_SIZE(type, bytes)
#endif

// Most kernels make this many neighbouring pixels of a row at once; resolve_reprojected, whose weights are many, eight;
// present, whose pixels are small, sixteen.
enum { kBlock = 4, kReprojectedBlock = 8, kPresentBlock = 16 };

// Where the texels of a buffer lie: texel (x, y) has the index offset + y * pitch + x. Both in texels; both zero for
// an image.
typedef struct TexelLayout {
  int offset;
  int pitch;
} TexelLayout;
QUINCUNX_CHECK_SIZE(TexelLayout, 8);

// What one output column (or row) reads of its axis. The two taps base and base + 1 lie inside the viewport: what a
// clamp at the edge would do is folded into the weights. A viewport of one texel has base 0 and weights 1, 0, and its
// second tap must not be read.
typedef struct AxisTap {
  int base;
  int nearest;    // the texel whose sample lies nearest to the pixel centre; of two equally near the upper/left one
  float weight0;  // of base; weight0 + weight1 == 1 exactly
  float weight1;  // of base + 1
} AxisTap;
QUINCUNX_CHECK_SIZE(AxisTap, 16);

// The sources of one frame: the viewport and their layouts.
typedef struct SourceFrame {
  int width;  // the viewport, in texels
  int height;
  TexelLayout colour;
  TexelLayout velocity;
  TexelLayout reactive;
} SourceFrame;
QUINCUNX_CHECK_SIZE(SourceFrame, 32);

typedef struct ScaleParams {
  int output_width;
  int output_height;
  int source_width;  // the viewport, in texels
  int source_height;
  TexelLayout source;
  TexelLayout output;
  int row_axis;          // index of the first row in the axis table
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
} ScaleParams;
QUINCUNX_CHECK_SIZE(ScaleParams, 44);

typedef struct NoiseParams {
  ScaleParams scale;
  unsigned seed;
  float amplitude;  // of scale_noise, in [0, 1]
  // Of scale_noise_offset, in 1/256 texels, [256, 250 * 256]: how far apart the places lie that a pixel may look at.
  int reach_x;
  int reach_y;
} NoiseParams;
QUINCUNX_CHECK_SIZE(NoiseParams, 60);

// What one output column (or row) reads of its axis through a filter of N taps: texels base to base + N - 1, which lie
// inside the viewport; in one of fewer than N, those beyond it have weight 0 and must not be read. Texels inner to
// inner + M - 1 are the M samples next to the centre, which bound the result where ringing is clamped.
typedef struct FilterSpan {
  int base;
  int inner;
} FilterSpan;
QUINCUNX_CHECK_SIZE(FilterSpan, 8);

// scale_filter makes a run of output pixels from at most this many filtered columns.
enum { kFilterColumns = 64 };

typedef struct FilterParams {
  int output_width;
  int output_height;
  int source_width;  // the viewport, in texels
  int source_height;
  TexelLayout source;
  TexelLayout output;
  int row_axis;  // index of the first row's span; the weights begin behind the last row's
  int taps_x;    // N of each column
  int taps_y;    // N of each row
  int inner_x;   // M of each column
  int inner_y;   // M of each row
  int run;       // output pixels whose columns fit into kFilterColumns; 0: the viewport is narrower than the taps
  int counter;   // index into non_finite
  int columns_per_item;
} FilterParams;
QUINCUNX_CHECK_SIZE(FilterParams, 64);

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

typedef struct UndilateParams {
  VelocityParams frame;
  TexelLayout dilated;
  float to_drawn_x, to_drawn_y;  // from uv to the units of the drawn velocity
  int has_camera;                // the camera's motion is known
} UndilateParams;
QUINCUNX_CHECK_SIZE(UndilateParams, 108 + 8 + 8 + 4);

typedef struct ResolveParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one
  TexelLayout output;
  int row_axis;          // index of the first row in the axis tables
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  // From the units of the velocity source to sqrt(K) render pixels, per frame.
  float velocity0_scale_x, velocity0_scale_y;
  float velocity1_scale_x, velocity1_scale_y;
} ResolveParams;
QUINCUNX_CHECK_SIZE(ResolveParams, 8 + 2 * 32 + 8 + 12 + 16);

// Of one sample of this frame: the surface that it shows was at the sample's own place + (x, y) in the previous frame.
// Written by reproject.
typedef struct Reprojection {
  float x, y;   // pixels of the previous frame's viewport, within +-65504
  float trust;  // in [0, 1]: of what the previous frame holds there; NaN: the sample's velocity or depth is not finite
  // The motion edge at the sample: the largest difference of velocity to its eight neighbours, output pixels a frame.
  // If that of the previous frame at the place above was larger, it stands here as a negative number. 0 without
  // MOTION_EDGE.
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
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
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

typedef struct ReprojectedParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one
  TexelLayout reprojection;
  TexelLayout output;
  int columns;           // in the position tables: texels of the columns, then fractions; then the same of the rows
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kReprojectedBlock
  float falloff0_x, falloff0_y;  // 1 / r^2 of each axis, per frame
  float falloff1_x, falloff1_y;
} ReprojectedParams;
QUINCUNX_CHECK_SIZE(ReprojectedParams, 8 + 2 * 32 + 16 + 12 + 16);

// The motion blur looks at the output in tiles, and measures streaks in fixed point.
enum {
  kTileSide = 32,        // output pixels
  kStreakUnits = 64,     // of an output pixel
  kLongestStreak = 8 * kTileSide * kStreakUnits,  // on either axis; longer ones are cut
};

// The streaks of the surfaces seen in a tile: the longest one and the range of each axis.
typedef struct TileStreaks {
  int longest_x;
  int longest_y;
  int least_x;
  int least_y;
  int most_x;
  int most_y;
} TileStreaks;
QUINCUNX_CHECK_SIZE(TileStreaks, 24);

// How the pixels of a tile are blurred.
enum {
  kTileCopy = 0,     // nothing that reaches it moves by half a pixel
  kTileUniform = 1,  // all that reaches it moves alike: colour alone is read
  kTileMixed = 2,    // depth and velocity decide for each sample
};

typedef struct TileBlur {
  int kind;
  int samples_log2;
  int x;  // the longest streak that reaches the tile
  int y;
} TileBlur;
QUINCUNX_CHECK_SIZE(TileBlur, 16);

typedef struct MotionParams {
  int output_width;
  int output_height;
  int tiles_x;
  int tiles_y;
  TexelLayout source;    // the resolved picture
  TexelLayout velocity;
  TexelLayout depth;
  TexelLayout output;
  int row_axis;          // index of the first row in the axis table
  int columns_per_item;  // pixels that a work-item makes: whole tiles, or a multiple of kBlock within one
  int most_samples_log2;
  float scale_x, scale_y;  // from the velocity target's units to streaks
} MotionParams;
QUINCUNX_CHECK_SIZE(MotionParams, 68);

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
  int left, top;         // of the part that is laid over, in pixels of the region
  int width, height;     // of that part
  TexelLayout focus;     // of the region
  TexelLayout mask;      // of the region
  TexelLayout output;    // of the picture, from the region's first pixel on
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
  float weight;  // of the picture, in [0, 1]
} CrossFadeParams;
QUINCUNX_CHECK_SIZE(CrossFadeParams, 32);

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
} ContentSums;
QUINCUNX_CHECK_SIZE(ContentSums, 24);

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
  float pixels_x;  // of velocity, in output pixels
  float pixels_y;
  float step_x;  // output pixels between two samples
  float step_y;
} ContentParams;
QUINCUNX_CHECK_SIZE(ContentParams, 64);

typedef struct PresentParams {
  int width;
  int height;
  TexelLayout source;
  TexelLayout output;
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kPresentBlock
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

#ifdef __cplusplus
}  // namespace quincunx
#endif
