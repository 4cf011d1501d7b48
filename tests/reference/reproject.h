// SPDX-License-Identifier: MIT
// What reproject and resolve_reprojected should give, in double precision.
#pragma once

#include <vector>

#include "picture.h"

namespace quincunx::reference {

// Of one sample: what it shows was at its own place + (x, y), in pixels of the previous frame.
struct Move {
  double x = 0;
  double y = 0;
  double trust = 0;  // NaN: the sample's velocity or depth is not finite
  double speed = 0;  // |sqrt(K) v0| + |sqrt(K) v1|, for error bounds
  double reach = 0;  // largest texel coordinate that went into its place, likewise
  // A rounding may decide which texels are compared, whether they hide the sample, or whose contrast is more.
  bool undecided = false;
  // The largest difference of velocity to the eight neighbours, output pixels; negative: that of the previous
  // frame, which is more.
  double contrast = 0;
};

struct ReprojectOptions {
  bool reactive = false;
  double residual_weight = 0;  // K
  int output_width = 0;        // contrast is wanted, in pixels of this output, and what follows from it
  int output_height = 0;
  std::vector<double> contrast_before = {};  // of each texel of the previous frame; empty: none
};

// At each texel of the current frame's viewport.
std::vector<Move> reproject(const Frame& current, const Frame& previous, const ReprojectOptions& options);

// The picture, and what its errors depend on.
struct ReprojectedPicture : Picture {
  // Per pixel: by how much it changes at most when each weight changes by 1 (over their sum); infinite where
  // a rounding decides whether a sample that is not finite counts.
  std::vector<double> condition;
  std::vector<double> move;    // per pixel: the larger axis of the move
  std::int64_t undecided = 0;  // pixels with an infinite condition
};

// `moves`: one for each texel of the current frame. `reactive`: the reactive values of both frames count too,
// which they already do in the moves of reproject().
ReprojectedPicture resolve_reprojected(const Frame& current, const Frame& previous,
                                       const std::vector<Move>& moves, bool reactive, int output_width,
                                       int output_height);

}  // namespace quincunx::reference
