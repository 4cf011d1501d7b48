// SPDX-License-Identifier: MIT
// temporal_tiles: how history is taken over in each tile of kTemporalTile^2 output pixels, and whether it is to be believed.
// Rigid is a tile whose samples, and the next ones around it, move alike within .05 output pixels.
//   brightening      sum k (s - h), over its samples s and the history h there, as luma
//   brighter         how many samples are brighter than history by k (s - h) > .01, less those that are darker
//   light            sum k h
//   history_error    sum k |s - h|
//   neighbour_error  sum k |s - n|, n being the mean of the four neighbours
//   k = 1 / (1 + s + h)
//
//   params    in   viewport, layouts, scales
//   colour    in   RGBA16F or RGBA32F, viewport
//   moves     in   MOTION 1: Move of each sample; those that are not trusted do not count
//   history   in   of the previous frame
//   previous  in   TemporalTile of each tile, of the previous frame
//   tiles     out  the same of this frame; temporal_light adds the rest
//   total     out  grows by each tile's part
// Options: MOTION  1 (default) | 0
//          SOURCE_STORAGE, SOURCE_FORMAT as in texel.h, HISTORY_FORMAT as in history.h
// Reference: tests/reference/temporal_tiles.cpp
#include "texel.h"

#include "frame_samples.h"
#include "history.h"
#include "motion_contrast.h"
#include "motion_options.h"

#define KNOWN 0.1f      // confidence from which a texel of history counts: one begun anew in the last frame, too
#define TRUSTED 0.9f    // and the trust of a sample
#define RIGID 0.05f     // output pixels
#define STILL 1e-4f     // what velocity's rounding leaves
#define NOISE 0.01f     // of brightness, that says nothing

// The tile that holds output position (x, y), which may lie outside.
static inline int tile_index(const TemporalTileParams* params, float x, float y) {
  const int tile_x = clamp((int)x / kTemporalTile, 0, params->tiles_x - 1);
  const int tile_y = clamp((int)y / kTemporalTile, 0, params->tiles_y - 1);
  return tile_y * params->tiles_x + tile_x;
}

static inline float luma(float4 colour) {
  return max(0.25f * (colour.x + colour.z) + 0.5f * colour.y, 0.0f);
}

enum { kJudgedAhead = 4 * kTemporalTile, kMovesAhead = 8, kColourAhead = 16 };  // texels

// What the sample (x, y) says of history.
static inline void judge_sample(TemporalTile* tile, COLOUR_TEXELS colour, __global const float* moves,
                                HISTORY_TEXELS history, __global const TemporalTile* previous,
                                const TemporalTileParams* params, int x, int y) {
  float at_x = (float)x * params->spacing_x + params->start_x;
  float at_y = (float)y * params->spacing_y + params->start_y;
#if MOTION
  const float4 move = vload4(texel_index(params->moves, x, y), moves);
  if (!(move.z > TRUSTED)) return;
  if (!tile->rigid) {
    at_x += move.x * params->move_x;
    at_y += move.y * params->move_y;
    const int source = tile_index(params, at_x, at_y);
    at_x -= previous[source].offset_x;
    at_y -= previous[source].offset_y;
  }
#endif
  if (tile->rigid) {
    at_x -= tile->offset_x + (float)tile->step_x;
    at_y -= tile->offset_y + (float)tile->step_y;
  }
  if (!(at_x >= 0.0f && at_y >= 0.0f && at_x < (float)params->output_width && at_y < (float)params->output_height)) return;
  const int index = (int)at_y * params->output_width + (int)at_x;
  WILL_READ(history + 4 * (index + kJudgedAhead));
  const float4 before = load_history(history, index);
  const float4 sample = sample_at(colour, &params->frame, x, y);
  if (before.w < KNOWN || !is_valid(sample)) return;
  const float4 around = 0.25f * (sample_at(colour, &params->frame, x - 1, y) + sample_at(colour, &params->frame, x + 1, y) +
                                 sample_at(colour, &params->frame, x, y - 1) + sample_at(colour, &params->frame, x, y + 1));
  const float own = luma(sample), known = luma(before);
  const float scale = 1.0f / (1.0f + own + known);
  const float change = (own - known) * scale;
  tile->brightening += change;
  tile->light += known * scale;
  tile->history_error += fabs(change);
  tile->neighbour_error += is_valid(around) ? fabs(own - luma(around)) * scale : 0.0f;
  tile->brighter += (change > NOISE ? 1.0f : 0.0f) - (change < -NOISE ? 1.0f : 0.0f);
  tile->count += 1.0f;
}

#if MOTION
static inline float16 four_times(float4 value) {
  return (float16)(value, value, value, value);
}

// Of moves; lanes of `unknown` are not 0 where one is NaN.
typedef struct MoveRange {
  float4 least, most;
  int4 unknown;
} MoveRange;

// Of the samples from `first` to `last`.
static inline MoveRange range_of_moves(__global const float* moves, TexelLayout layout, int2 first, int2 last) {
  float16 least = (float16)(65536.0f), most = (float16)(-65536.0f);
  int16 unknown = (int16)(0);
  const bool wide = last.x >= first.x + 3;
  for (int y = first.y; y <= last.y; ++y) {
    __global const float* row = moves + 4 * row_index(layout, y);
    WILL_READ(row + 4 * (last.x + kMovesAhead));
    WILL_READ(row + 4 * (last.x + kMovesAhead + 4));
    for (int x = first.x; x <= last.x; x += wide ? 4 : 1) {
      const float16 four = wide ? vload16(0, row + 4 * min(x, last.x - 3)) : four_times(vload4(x, row));
      least = min(least, four);
      most = max(most, four);
      unknown |= four != four;
    }
  }
  const float8 least8 = min(least.lo, least.hi), most8 = max(most.lo, most.hi);
  const int8 unknown8 = unknown.lo | unknown.hi;
  const MoveRange range = {min(least8.lo, least8.hi), max(most8.lo, most8.hi), unknown8.lo | unknown8.hi};
  return range;
}

// Takes history over whole if all of the samples from `first` to `last` move alike.
static inline void follow(TemporalTile* tile, __global const float* moves, __global const TemporalTile* previous,
                          const TemporalTileParams* params, int2 first, int2 last, float middle_x, float middle_y) {
  const MoveRange found = range_of_moves(moves, params->moves, first, last);
  const float2 least = found.least.xy, most = found.most.xy;
  const bool known = found.unknown.z == 0 && found.least.z >= 0.0f;
  const float contrast = max(found.most.w, -found.least.w);
  const bool plain = found.least.z == 1.0f && contrast <= EDGE_COSTS_FROM;
  tile->torn = contrast > EDGE_BEGINS ? 1 : 0;
  const float2 scale = (float2)(params->move_x, params->move_y);
  const float2 range = (most - least) * scale;
  const float2 mean = 0.5f * (most + least) * scale;
  const float2 move = select(mean, (float2)(0.0f), fabs(mean) < (float2)(STILL));
  const float2 source = (float2)(middle_x, middle_y) + move;
  if (!known || !(range.x <= RIGID && range.y <= RIGID)) return;
  // What comes in from beyond the edges is laid out as the tiles there are.
  const int from = tile_index(params, source.x, source.y);
  tile->source_x = previous[from].offset_x;
  tile->source_y = previous[from].offset_y;
  const float2 place = (float2)(tile->source_x, tile->source_y) - move;
  const float2 step = floor(place + 0.5f);
  tile->offset_x = place.x - step.x;
  tile->offset_y = place.y - step.y;
  tile->step_x = (int)step.x;
  tile->step_y = (int)step.y;
  tile->rigid = 1;
  tile->plain = plain ? 1 : 0;
}
#endif

__kernel void temporal_tiles(const TemporalTileParams params, COLOUR_TEXELS colour, __global const float* moves,
                             HISTORY_TEXELS history, __global const TemporalTile* previous, __global TemporalTile* tiles,
                             __global TotalLight* total) {
  const int tile_x = get_global_id(0), tile_y = get_global_id(1);
  if (tile_x >= params.tiles_x || tile_y >= params.tiles_y) return;

  TemporalTile tile = {.gain = 1.0f};
  const float2 corner = (float2)((float)(tile_x * kTemporalTile), (float)(tile_y * kTemporalTile));
  const int2 limit = (int2)(params.frame.width - 1, params.frame.height - 1);
  const float2 spacing = (float2)(params.spacing_x, params.spacing_y), start = (float2)(params.start_x, params.start_y);
  const int2 first = clamp(convert_int2(ceil((corner - start) / spacing)), (int2)(0), limit);
  const int2 last = clamp(convert_int2(ceil((corner + (float)kTemporalTile - start) / spacing)) - 1, first, limit);
#if MOTION
  const int2 around_first = max(first - 1, (int2)(0)), around_last = min(last + 1, limit);
  const float half_side = 0.5f * (float)kTemporalTile;
  follow(&tile, moves, previous, &params, around_first, around_last, corner.x + half_side, corner.y + half_side);
#else
  tile.rigid = 1;
  tile.plain = 1;
#endif
  for (int y = first.y - 1; y <= last.y + 1; ++y)
    will_read_colour(colour, params.frame.colour, last.x + kColourAhead, y);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x + (-first.x - params.judged_apart / 2 * y & params.judged_apart - 1); x <= last.x; x += params.judged_apart)
      judge_sample(&tile, colour, moves, history, previous, &params, x, y);
  }
  // So that no total leaves an int.
  const float most = min((float)kLightUnits, 0x1p30f / ((float)params.tiles_x * (float)params.tiles_y));
  const float units = most / max(tile.count, 1.0f);
  atomic_add(&total->brightening, convert_int(tile.brightening * units));
  atomic_add(&total->change, convert_int(fabs(tile.brightening) * units));
  atomic_add(&total->light, convert_int(tile.light * units));
  atomic_add(&total->history_error, convert_int(tile.history_error * units));
  atomic_add(&total->neighbour_error, convert_int(tile.neighbour_error * units));
  tiles[tile_y * params.tiles_x + tile_x] = tile;
}
