// SPDX-License-Identifier: MIT
// far_match: compares two motions of infinitely far samples that were drawn without any: that of far_fit, and none. The
// previous frame's colours at both places are forecasts of this frame's. Takes one of each 2x2 samples, unless either
// place lies outside of the previous frame or behind something there.
//   params             in   viewports, layouts, places
//   depth0, 1          in   R32F, viewports of frames n and n-1
//   drawn              in   RG16F or RG32F, viewport, in the caller's units
//   colour0, 1         in   RGBA16F or RGBA32F, viewports
//   motion             in   FarModel
//   match              out  FarMatch, to which each cell adds its errors
//   exposure           in   Exposure of frame n: light is compared as exposed light
// Options: SOURCE_STORAGE, SOURCE_FORMAT, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/far_motion.cpp
#include "bits.h"
#include "motion/camera_velocity.h"
#include "motion/velocity_params.h"
#include "picture_params.h"
#include "texel.h"

static inline float luma_of(float4 colour) {
  return max(0.25f * (colour.x + 2.0f * colour.y + colour.z), 0.0f);
}

static inline float luma_at(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
  return luma_of(sanitise4(load_colour(texels, layout, x, y)));
}

// A place among the samples of the previous frame.
typedef struct Place {
  float2 at;
  bool is_evidence;
} Place;

static inline Place previous_place(const FarMatchParams* params, DEPTH_TEXELS depth, int x, int y, float2 velocity) {
  const float2 samples = (float2)(params->to_previous_x, params->to_previous_y);
  Place place;
  place.at = (float2)((float)x * params->step_x + params->start_x, (float)y * params->step_y + params->start_y) -
             velocity * samples;
  place.is_evidence = place.at.x >= 0.0f && place.at.y >= 0.0f && place.at.x <= (float)(params->previous_width - 1) &&
                      place.at.y <= (float)(params->previous_height - 1);
  if (!place.is_evidence) return place;
  const int column = (int)(place.at.x + 0.5f), row = (int)(place.at.y + 0.5f);
  place.is_evidence = fabs(load_depth4(depth, params->depth1, (int4)(column), row).x) <= FARTHEST_DEPTH;
  return place;
}

// Bilinear.
static inline float previous_luma(const FarMatchParams* params, COLOUR_TEXELS texels, float2 at) {
  const int x = (int)at.x, y = (int)at.y;
  const int right = min(x + 1, params->previous_width - 1), below = min(y + 1, params->previous_height - 1);
  const float fx = at.x - (float)x, fy = at.y - (float)y;
  const TexelLayout layout = params->colour1;
  const float upper = mix(luma_at(texels, layout, x, y), luma_at(texels, layout, right, y), fx);
  const float lower = mix(luma_at(texels, layout, x, below), luma_at(texels, layout, right, below), fx);
  return mix(upper, lower, fy);
}

// Brightness as the eye has it, not light.
static inline float difference_of(float a, float b, float one) {
  return fabs(a - b) / (one + a + b);
}

__kernel void far_match(const FarMatchParams params, DEPTH_TEXELS depth0, DEPTH_TEXELS depth1, VELOCITY_TEXELS drawn,
                        COLOUR_TEXELS colour0, COLOUR_TEXELS colour1, __global const FarModel* motion,
                        __global FarMatch* match, __global const Exposure* exposure) {
  const int cell_x = get_global_id(0), cell_y = get_global_id(1);
  if (cell_x >= params.cells_x || cell_y >= params.cells_y) return;

  const FarModel found = *motion;
  const float one = exposure->inverse;  // of exposed light
  float still = 0.0f, moved = 0.0f;
  const int end_x = min((cell_x + 1) * kFarCell, params.width), end_y = min((cell_y + 1) * kFarCell, params.height);
  for (int y = cell_y * kFarCell; y < end_y; y += 2) {
    for (int x = cell_x * kFarCell; x < end_x; x += 2) {
      const float z = load_depth4(depth0, params.depth0, (int4)(x), y).x;
      if (!is_far_and_still(z, load_velocity4(drawn, params.drawn, (int4)(x), y).s01)) continue;
      const Place stays = previous_place(&params, depth1, x, y, (float2)(0.0f));
      const Place moves = previous_place(&params, depth1, x, y, far_velocity_at(&found, &params.places, x, y));
      if (!stays.is_evidence || !moves.is_evidence) continue;
      const float now = luma_at(colour0, params.colour0, x, y);
      still += difference_of(now, previous_luma(&params, colour1, stays.at), one);
      moved += difference_of(now, previous_luma(&params, colour1, moves.at), one);
    }
  }
  atomic_add(&match->still, (int)(still * params.units));
  atomic_add(&match->moved, (int)(moved * params.units));
}
