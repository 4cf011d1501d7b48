// SPDX-License-Identifier: MIT
// reproject and resolve_reprojected: the specification. error_bound.h tells what `Real` may be.
#pragma once

#include <limits>
#include <vector>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

// The reprojection of one sample: its surface was at its own place + (x, y), in pixels of the previous frame.
template <typename Real>
struct ReprojectionOf {
  Real x = 0;
  Real y = 0;
  Real trust = 0;  // in [0, 1]; NaN: the sample's velocity or depth is not finite
  // The largest difference of velocity to the eight neighbours, output pixels; negative: that of the previous
  // frame there, which is larger. 0 where not asked for.
  Real motion_edge = 0;
  // Trust without a look at depths and motion edges; a number where trust is NaN.
  Real open_trust = 0;
};
using Reprojection = ReprojectionOf<double>;

struct ReprojectOptions {
  bool reactive = false;
  double residual_weight = 0;  // K
  // The extent of the output, for motion edges in its pixels and what follows from them; 0: none are wanted.
  int output_width = 0;
  int output_height = 0;
  // Motion edges of the previous frame's texels; empty: there were none.
  std::vector<double> motion_edges_before = {};
};

// Returns the reprojection of sample (x, y) of the current frame's viewport.
template <typename Real>
ReprojectionOf<Real> reproject(const Frame& current, const Frame& previous, const ReprojectOptions& options,
                               int x, int y);

// The picture, and what its errors depend on.
struct ReprojectedPicture : Picture {
  // Per pixel: by how much it changes at most when each weight changes by 1 (over their sum); infinite where
  // a rounding decides whether a sample that is not finite counts.
  std::vector<double> condition;
  std::vector<double> motion;  // per pixel: the larger axis of its reprojection
  std::int64_t undecided = 0;  // pixels with an infinite condition
};

// `reprojections`: one for each texel of the current frame. `reactive`: the reactive values of both frames
// count too, which they already do in what reproject() gives.
ReprojectedPicture resolve_reprojected(const Frame& current, const Frame& previous,
                                       const std::vector<Reprojection>& reprojections, bool reactive,
                                       int output_width, int output_height);

}  // namespace quincunx::reference
