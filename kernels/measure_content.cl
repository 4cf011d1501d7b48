// SPDX-License-Identifier: MIT
// measure_content: sums statistics of a frame, over 8 x 8 samples of each tile of the picture.
//   params    in      viewport, layouts, tiles, from velocity to output pixels
//   velocity  in      RG16F or RG32F, viewport, in the caller's units; NaN counts as 0, +-Inf as +-65504
//   depth     in      R32F, viewport, reversed and infinite
//   reactive  in      R8, viewport; read with REACTIVE=1 only
//   judged    in      TileLight of each tile of this frame; read where params.judged_width is not 0
//   sums      in/out  ContentSums, to which each tile adds
// A surface is behind another one where its depth is less than .9 of that one's. Two samples move apart where one is
// behind the other and their velocities differ by so much. A tile counts, with all its samples,
//   apart  where two neighbouring samples move apart by an output pixel or more
//   thin   where a sample has, 3 output pixels to both sides of it on an axis, what is behind it, and moves apart from
//          one of these by .25 output pixels or more
//   light  where a sample is reactive by a tenth or more, or temporal_light confirmed a change of light in its tile in
//          this frame: `confirmation` is 1. Over more frames many an edge is confirmed once
// and with its moving samples, those of .25 pixels or more,
//   zoom   where velocity grows, or shrinks, by .01 a pixel or more on both axes, in the mean over neighbouring samples
//          neither of which is behind the other
// Options: REACTIVE 0 (default) | 1; SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/measure_content.cpp
#ifndef REACTIVE
#define REACTIVE 0
#endif
#include "bits.h"
#include "picture_params.h"
#include "temporal/tile.h"
#include "texel.h"
#if REACTIVE != 0 && REACTIVE != 1
#error "REACTIVE must be 0 or 1"
#endif

#define MOVING 0.25f         // output pixels: ContentStatistics::kMovingPx
#define APART 1.0f           // output pixels: less is what a camera's own motion does at every edge
#define FASTEST 255.0f       // output pixels: so that the sum over all tiles fits
#define SPEED_UNITS 16.0f    // steps of the sum in an output pixel
#define BEHIND 0.9f          // fraction of a surface's depth
#define LEAST_REACTIVE 0.1f
#define GROWS 0.01f          // fraction of the distance, a frame

typedef struct Sample {
  float2 velocity;  // output pixels
  float depth;
} Sample;

typedef struct Growth {
  float2 sum;  // total difference of velocity along each axis
  int2 pairs;
} Growth;

static inline Sample sample_at(const ContentParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, int x,
                               int y) {
  const float2 units = load_velocity(velocity, params->velocity, x, y);
  const float4 settled = sanitise4((float4)(units.x * params->pixels_x, units.y * params->pixels_y, 0.0f, 0.0f));
  const Sample sample = {settled.xy, load_depth(depth, params->depth, x, y)};
  return sample;
}

static inline bool is_behind(Sample sample, Sample other) {
  return sample.depth < BEHIND * other.depth;
}

static inline bool moves_by(float2 velocity, float least) {
  return velocity.x * velocity.x + velocity.y * velocity.y >= least * least;
}

static inline bool moves_apart(Sample a, Sample b) {
  return (is_behind(a, b) || is_behind(b, a)) && moves_by(a.velocity - b.velocity, APART);
}

static inline bool is_thin(Sample sample, Sample one, Sample other) {
  return is_behind(one, sample) && is_behind(other, sample) &&
         (moves_by(sample.velocity - one.velocity, MOVING) || moves_by(sample.velocity - other.velocity, MOVING));
}

// The sample's column or row; `index` counts the samples of all tiles.
static inline int place_of(int index, int samples, int size) {
  return (2 * index + 1) * size / (2 * samples);
}

static inline uint add_pair(Growth* growth, Sample before, Sample sample, int axis) {
  if (!is_behind(before, sample) && !is_behind(sample, before)) {
    if (axis == 0) {
      growth->sum.x += sample.velocity.x - before.velocity.x;
      ++growth->pairs.x;
    } else {
      growth->sum.y += sample.velocity.y - before.velocity.y;
      ++growth->pairs.y;
    }
  }
  return moves_apart(before, sample) ? 1 : 0;
}

static inline bool grows(Growth growth, float step_x, float step_y) {
  const float x = growth.sum.x / (step_x * (float)max(growth.pairs.x, 1));
  const float y = growth.sum.y / (step_y * (float)max(growth.pairs.y, 1));
  return (x >= GROWS && y >= GROWS) || (x <= -GROWS && y <= -GROWS);
}

// Returns whether the judge has found that light moves, or another change without velocity, at an output pixel.
static inline bool is_confirmed(const ContentParams* params, __global const TileLight* judged, int x, int y) {
  const int tiles_x = (params->judged_width + kTemporalTile - 1) / kTemporalTile;
  return judged[y / kTemporalTile * tiles_x + x / kTemporalTile].confirmation >= 1.0f;
}

static inline void add_to(volatile __global uint* sum, uint count) {
  if (count > 0) atomic_add(sum, count);
}

__kernel void measure_content(const ContentParams params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                              REACTIVE_TEXELS reactive, __global const TileLight* judged,
                              volatile __global ContentSums* sums) {
  const int tile_x = get_global_id(0), tile_y = get_global_id(1);
  if (tile_x >= params.tiles_x || tile_y >= params.tiles_y) return;

  const int last_x = params.width - 1, last_y = params.height - 1;
  const int all_x = params.tiles_x * kContentSamples, all_y = params.tiles_y * kContentSamples;
  uint moving = 0, apart = 0, thin = 0, light = 0;
  float speed = 0.0f;
  Growth growth = {(float2)(0.0f), (int2)(0)};
  for (int j = 0; j < kContentSamples; ++j) {
    const int y = place_of(tile_y * kContentSamples + j, all_y, params.height);
    const int above_y = place_of(max(tile_y * kContentSamples + j - 1, 0), all_y, params.height);
    Sample left;
    for (int i = 0; i < kContentSamples; ++i) {
      const int x = place_of(tile_x * kContentSamples + i, all_x, params.width);
      const Sample here = sample_at(&params, velocity, depth, x, y);
      if (moves_by(here.velocity, MOVING)) {
        ++moving;
        speed += min(sqrt(here.velocity.x * here.velocity.x + here.velocity.y * here.velocity.y), FASTEST);
      }
      if (i > 0) apart |= add_pair(&growth, left, here, 0);
      if (j > 0) apart |= add_pair(&growth, sample_at(&params, velocity, depth, x, above_y), here, 1);
      left = here;
      const int near_x = x - params.reach_x, far_x = x + params.reach_x;
      if (near_x >= 0 && far_x <= last_x)
        thin |= is_thin(here, sample_at(&params, velocity, depth, near_x, y),
                        sample_at(&params, velocity, depth, far_x, y)) ? 1 : 0;
      const int near_y = y - params.reach_y, far_y = y + params.reach_y;
      if (near_y >= 0 && far_y <= last_y)
        thin |= is_thin(here, sample_at(&params, velocity, depth, x, near_y),
                        sample_at(&params, velocity, depth, x, far_y)) ? 1 : 0;
#if REACTIVE
      light |= load_reactive4(reactive, params.reactive, (int4)(x), y).x >= LEAST_REACTIVE ? 1 : 0;
#endif
      if (params.judged_width > 0) {
        const int output_x = place_of(tile_x * kContentSamples + i, all_x, params.judged_width);
        const int output_y = place_of(tile_y * kContentSamples + j, all_y, params.judged_height);
        light |= is_confirmed(&params, judged, output_x, output_y) ? 1 : 0;
      }
    }
  }
  const uint all = kContentSamples * kContentSamples;
  add_to(&sums->moving, moving);
  add_to(&sums->speed, (uint)(speed * SPEED_UNITS + 0.5f));
  add_to(&sums->apart, apart * all);
  add_to(&sums->thin, thin * all);
  add_to(&sums->light, light * all);
  add_to(&sums->judged, params.judged_width > 0 ? all : 0);
  if (grows(growth, params.step_x, params.step_y)) add_to(&sums->zoom, moving);
}
