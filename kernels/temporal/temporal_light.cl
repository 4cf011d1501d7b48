// SPDX-License-Identifier: MIT
// temporal_light: whether the light has changed in each tile, from the evidence in it and in the eight tiles around it.
//   relative   sum of brightenings / sum of light: the change of light
//   coherence  |sum of brightenings| / sum of their magnitudes: how far tiles agree
//   gain       the relighting gain: a coherent change that persists for two frames gives 1 + relative; aliased texture
//              changes its sign before that. Where the whole picture changes one way the gain is given at once. Where
//              surfaces move apart a change of light cannot be told from one of surface: the gain is 1, or the whole
//              picture's
//   rejection  the largest of three, clamped to [0, 1]:
//     by error   history foretells the samples much worse than their neighbours do, and not because light has changed
//     by cut     over the whole picture history foretells worse than the neighbours: it is another picture
//     by change  the tile's own samples agree that it is brighter or darker now, by more than its aliasing has shown in
//                flicker and in the neighbours' error, as in the first frames of a moving highlight
//   holds back samples that are far brighter than history, or negative, side by side, and the first of late
//              (temporal/startling.h): gain is 1 and rejection 0 then
//   calm       a tile that stands still, around which no suspicion was confirmed lately: there rejection by error and
//              by change wait for a second frame, because in a still picture each place of the jitter can look like a
//              change of its own
//
//   tiles_x, tiles_y  in   how many tiles there are
//   tiles             in   TileReprojection of each tile: motion edges, and whether it stands still
//   evidence          in   TileEvidence of each tile
//   total             in   TotalLight: of all tiles
//   previous          in   TileLight of each tile, of the previous frame
//   light             out  TileLight of each tile
// Options: none
// Reference: tests/reference/temporal_light.cpp
#include "temporal/light_change.h"

// Thresholds. They were found by search on the development scenes; what a measurement showed is in docs/temporal.md.
//
// Rejection by error.
#define ERROR_RATIO 1.6f          // of history's error to the neighbours', from which on it rejects
#define ERROR_FLOOR 0.002f        // luma, of each sample: less is no error
#define INCOHERENT 0.5f           // of the error: a larger part that is brightening may be a change of light
// Rejection by cut. The ratio is 1.66 or more then. Textures finer than the samples may have as much as long as history
// is new, and up to 1.44 later. So it is soft: what is rejected is new again.
#define CUT_RATIO 1.25f           // of history's error to the neighbours', from which on it rejects
#define CUT_RANGE 0.35f           // by how much more of the neighbours' error it rejects wholly
#define CUT_FLOOR 0.03f           // of the light: less is no error
#define CUT_MEMORY 0.9f           // from one frame to the next: where each seems another picture there is no cut
// Rejection by change.
#define SIGN_TEST 1.1f            // least majority, in squared standard deviations of a fair coin
#define LEAST_CHANGE 0.15f        // of the tile's light
#define NEIGHBOUR_SHARE 0.8f      // of the neighbours' error that is usual
#define FLICKER_SHARE 12.0f       // of flicker that is usual: an aliased tile is more often near its mean than far
#define CHANGE_FLOOR 0.01f        // luma: usual anyway
#define CHANGE_RANGE 0.5f         // by how much more of what is usual it rejects wholly
#define FLICKER_MEMORY 0.9f       // of flicker, from one frame to the next. Without flicker -.08 dB, still -.8

// Calm tiles. Without them about twenty tiles of a still picture are rejected in each frame.
#define CONFIRMING_COST 0.3f      // of a suspicion that two frames share
#define SURE_ALONE 4.0f           // from which on a suspicion of one frame rejects
#define UNREST_MEMORY 0.97f       // from one frame to the next
#define CALM 0.3f                 // most unrest: 40 frames after the last confirmed suspicion

// Startling samples (temporal/startling.h).
#define STARTLED_MEMORY 0.9f      // from one frame to the next
#define FORGOTTEN 0.15f           // most: 18 frames after the last ones

// How far the mean brightening alternates: the smaller of two frames' whose signs differ.
static inline float alternation(float now, float before) {
  return now * before < 0.0f ? min(fabs(now), fabs(before)) : 0.0f;
}

static inline float suspicion_by_error(const TileEvidence* sum) {
  const float allowed = ERROR_RATIO * sum->neighbour_error + ERROR_FLOOR * max(sum->count, 1.0f);
  const bool incoherent = fabs(sum->brightening) < INCOHERENT * sum->history_error;
  return incoherent ? max((sum->history_error - allowed) / allowed, 0.0f) : 0.0f;
}

static inline float rejection_by_cut(const TotalLight* total) {
  const float error = (float)total->history_error, usual = (float)total->neighbour_error;
  if (!(error > CUT_FLOOR * (float)total->light)) return 0.0f;
  return (error - CUT_RATIO * usual) / (CUT_RANGE * usual + 1.0f);
}

static inline float suspicion_by_change(const TileEvidence* tile, float mean_brightening, float flicker,
                                        float neighbour_error) {
  // A test of signs, corrected as for few samples: three must all agree.
  const float majority = fabs(tile->brighter) - 1.0f;
  const bool is_agreed = majority > 0.0f && majority * majority >= SIGN_TEST * tile->count;
  if (!is_agreed || fabs(tile->brightening) <= LEAST_CHANGE * tile->light) return 0.0f;
  const float usual = NEIGHBOUR_SHARE * neighbour_error + FLICKER_SHARE * flicker + CHANGE_FLOOR;
  return max((fabs(mean_brightening) - usual) / (CHANGE_RANGE * usual), 0.0f);
}

// What is left of a suspicion in a calm tile. Positive if confirmed.
static inline float confirm(float suspected, float before) {
  return max(min(suspected, before) - CONFIRMING_COST, suspected - SURE_ALONE);
}

// That of tile (x, y).
static inline TileLight light_of(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                                 __global const TileEvidence* evidence, __global const TotalLight* total,
                                 __global const TileLight* previous, int x, int y) {
  const int i = y * tiles_x + x;
  const TileEvidence own = evidence[i];
  const TileLight before = previous[i];
  const TotalLight whole = *total;
  const EvidenceAround around = sum_evidence(tiles, evidence, previous, tiles_x, tiles_y, x, y);
  const LightChange change = change_of(&around);
  TileLight tile;

  // Relighting gain.
  const bool changes = is_change_of_light(&change, &around);
  tile.persistence = PERSISTENCE_MEMORY * before.persistence +
                     (changes ? (1.0f - PERSISTENCE_MEMORY) * change.direction : 0.0f);
  float gain = changes && tile.persistence * change.direction > PERSISTENT ? 1.0f + change.relative : 1.0f;
  const bool is_widespread = (float)whole.changed > LEAST_SPREAD * (float)(tiles_x * tiles_y);
  const bool relit = is_widespread && is_relit(&whole);
  if (relit && change.is_agreed && change.relative * (float)whole.brightening > 0.0f)
    gain = gain_of_whole(&change, &around, &whole);
  tile.gain = clamp(gain, 1.0f / MOST_GAIN, MOST_GAIN);

  // Flicker.
  tile.mean_brightening = own.brightening / max(own.count, 1.0f);
  tile.flicker = FLICKER_MEMORY * before.flicker +
                 (1.0f - FLICKER_MEMORY) * alternation(tile.mean_brightening, before.mean_brightening);

  // Suspicions.
  const float mean_error = around.sum.neighbour_error / max(around.sum.count, 1.0f);
  const float error = suspicion_by_error(&around.sum);
  const float changed =
      tile.gain == 1.0f ? suspicion_by_change(&own, tile.mean_brightening, tile.flicker, mean_error) : 0.0f;
  tile.suspected_error = error;
  tile.suspected_change = copysign(changed, tile.mean_brightening);
  const float changed_before =
      before.suspected_change * tile.mean_brightening > 0.0f ? fabs(before.suspected_change) : 0.0f;
  const float sure_error = confirm(error, before.suspected_error);
  const float sure_change = confirm(changed, changed_before);
  tile.unrest = max(sure_error, sure_change) > 0.0f ? 1.0f : UNREST_MEMORY * before.unrest;

  // Rejection.
  const bool calm = stands_still(tiles[i]) && around.unrest < CALM;
  const float by_error = calm ? sure_error : error;
  const float by_change = calm ? sure_change : changed;
  const float by_cut = is_widespread && !relit ? rejection_by_cut(&whole) : 0.0f;
  tile.rejection = clamp(max(max(by_error, by_change), by_cut), 0.0f, 1.0f);
  const float cut = clamp(by_cut, 0.0f, 1.0f);
  tile.cut = max(cut, CUT_MEMORY * before.cut);
  tile.new_cut = max(cut - before.cut, 0.0f);

  // Startling samples. Those of a picture that is another one, or in another light, are no faults.
  tile.startled = around.sum.startling > 0.0f ? 1.0f : STARTLED_MEMORY * before.startled;
  tile.holds_back = around.sum.startling > 0.0f && around.startled < FORGOTTEN && !relit && !(by_cut > 0.0f);
  if (tile.holds_back) {
    tile.rejection = 0.0f;
    tile.gain = 1.0f;
  }
  return tile;
}

__kernel void temporal_light(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                             __global const TileEvidence* evidence, __global const TotalLight* total,
                             __global const TileLight* previous, __global TileLight* light) {
  const int y = get_global_id(1);
  if (y >= tiles_y) return;
  for (int x = get_global_id(0); x < tiles_x; x += (int)get_global_size(0))
    light[y * tiles_x + x] = light_of(tiles_x, tiles_y, tiles, evidence, total, previous, x, y);
}
