// SPDX-License-Identifier: MIT
// Structs that host and kernels share. 4-byte scalars only, so that both sides lay them out alike on every device.
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
  int reach_x;      // of scale_noise_offset, in 1/256 texels, [256, 250 * 256]: how far apart the places lie that a pixel
  int reach_y;      // may look at
} NoiseParams;
QUINCUNX_CHECK_SIZE(NoiseParams, 60);

// What one output column (or row) reads of its axis through a filter of N taps: texels base to base + N - 1, which lie
// inside the viewport; in one of fewer than N, those beyond it have weight 0 and must not be read. Texels inner to inner
// + M - 1 are the M samples next to the centre, which bound the result where ringing is clamped.
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

// Of one sample: what it shows is at its own place + (x, y) in the previous frame, in pixels of that, within +-65504.
typedef struct Move {
  float x;
  float y;
  float trust;  // in [0, 1]: what the previous frame counts there; NaN: the sample's velocity or depth is not finite
  // The largest difference of velocity to the eight neighbours, output pixels; negative: that of the previous frame there,
  // which is more. 0 where not asked for.
  float contrast;
} Move;
QUINCUNX_CHECK_SIZE(Move, 16);

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
  TexelLayout moves;
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  // The texel coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands still:
  // (i * step_x + start_x, j * step_y + start_y).
  float step_x, step_y, start_x, start_y;
  float move_x, move_y;  // from velocity0 to pixels of the previous frame, on the way back
  float edge_x, edge_y;  // the left and the upper edge of the previous frame, as texel coordinates
  // From the units of the velocity source to sqrt(K) render pixels, per frame.
  float speed0_x, speed0_y;
  float speed1_x, speed1_y;
  float contrast_x, contrast_y;  // from velocity0 to output pixels
} ReprojectParams;
QUINCUNX_CHECK_SIZE(ReprojectParams, 16 + 56 + 4 + 56);

typedef struct ReprojectedParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one
  TexelLayout moves;
  TexelLayout output;
  int columns;           // in the position tables: texels of the columns, then fractions; then the same of the rows
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kReprojectedBlock
  float falloff0_x, falloff0_y;  // 1 / r^2 of each axis, per frame
  float falloff1_x, falloff1_y;
} ReprojectedParams;
QUINCUNX_CHECK_SIZE(ReprojectedParams, 8 + 2 * 32 + 16 + 12 + 16);

// A history texel is the accumulated colour and, in place of alpha, its confidence: the sum of the weights of the samples in it.
typedef struct TemporalParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one: only the viewport and reactive
  TexelLayout moves;
  TexelLayout output;
  int columns;           // in the position table, as in ReprojectedParams
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kReprojectedBlock
  float move_x, move_y;        // from pixels of the previous viewport to output pixels
  float spacing_x, spacing_y;  // output pixels between neighbouring samples
  int tiles_x;                 // of TemporalTile
  int tiles_y;
  int view;                    // kView...
  int half_output;             // of a view: RGBA16F
} TemporalParams;
QUINCUNX_CHECK_SIZE(TemporalParams, 8 + 2 * 32 + 16 + 12 + 16 + 16);

// What resolve_temporal shows: nothing, for the picture follows; or what it knows.
enum { kViewPicture = 0, kViewConfidence = 1, kViewRejection = 2, kViewOffset = 3 };

enum { kTemporalTile = 8 };  // output pixels, as many as resolve_temporal makes at once

// What a tile's pixels share. In a rigid tile all moves alike: its texels are copied, not resampled, and hold the picture at an
// offset from their centres that is carried along.
typedef struct TemporalTile {
  float offset_x, offset_y;  // where its texels' picture lies from their centres, output pixels, within [-.5, .5]
  float source_x, source_y;  // the same of the texels it takes
  int step_x, step_y;        // texel (x, y) takes (x - step_x, y - step_y)
  int rigid;                 // 0: offsets are 0
  int plain;                 // 1: rigid, its moves trust all samples, and there is no edge of motion
  int torn;                  // 1: there is an edge of motion that makes history doubtful, or was one in the previous frame
  // Of its samples: how much brighter they are than history says, history's light, and the errors of history and of the
  // neighbours as forecasts; brightness as the eye has it, not light.
  float brightening, light, history_error, neighbour_error;
  float count;     // of the samples that say so
  float brighter;  // how many of them are brighter by more than noise, less those that are darker
  float persistence;  // of a change of light, in [-1, 1], over frames
  float flicker;      // how far a sample's brightening goes to and fro from frame to frame: aliasing
  float doubt;        // of history, in [0, 1]
  float gain;         // of history's light, to be this frame's
} TemporalTile;
QUINCUNX_CHECK_SIZE(TemporalTile, 76);

// Of all tiles, in units of 1 / kLightUnits of a tile's mean, or larger ones where tiles are very many: whether the light of the whole picture has changed.
typedef struct TotalLight {
  int brightening, change, light;  // sum of signed brightenings, of their magnitudes, and of the light
  int history_error, neighbour_error;
} TotalLight;
QUINCUNX_CHECK_SIZE(TotalLight, 20);
enum { kLightUnits = 2048 };

typedef struct TemporalTileParams {
  SourceFrame frame;
  int output_width;
  int output_height;
  int tiles_x;
  int tiles_y;
  TexelLayout moves;
  // The centre of sample (i, j) in output pixels: (i * spacing_x + start_x, j * spacing_y + start_y).
  float spacing_x, spacing_y;
  float start_x, start_y;
  float move_x, move_y;  // as in TemporalParams
  int judged_apart;      // 2 or 4: of how many samples one is asked
} TemporalTileParams;
QUINCUNX_CHECK_SIZE(TemporalTileParams, 32 + 16 + 8 + 28);

typedef struct TemporalDisplayParams {
  int output_width;
  int output_height;
  SourceFrame frame0;
  TexelLayout output;
  int tiles_x;
  int columns;           // of the position table
  int columns_per_item;  // pixels that a work-item makes: a multiple of kTemporalTile
  int first;             // 1: no frame came before
} TemporalDisplayParams;
QUINCUNX_CHECK_SIZE(TemporalDisplayParams, 8 + 32 + 8 + 16);

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

#undef QUINCUNX_CHECK_SIZE
#ifdef __cplusplus
}  // namespace quincunx
#endif
