// SPDX-License-Identifier: MIT
// What is known of an output pixel: its history, and how far that is to be believed.
#pragma once

#include <algorithm>
#include <cmath>

#include "../history_sampling.h"
#include "../motion_edge.h"
#include "nearest_sample.h"

namespace quincunx::reference {

// Confidence, in weights of samples: what is ever kept (about 140 frames at scale .5), and once resampled.
constexpr double kMostConfidence = 32;
constexpr double kMostResampled = 8;
// Of confidence, for each resampling midway between texels; .2 instead of .3 is worth .05 dB.
constexpr double kResamplingCost = .2;
// Part of the way between texels, from which on history counts as resampled.
constexpr double kResampledFrom = .01;
// Output pixels of a motion edge that begin to cost confidence, and that cost most; 4 instead of 2 as the cost
// leaves fewer ghosts: pixels above 2/255 on a texture fall from .052 to .033 %.
constexpr double kMotionEdgeCostsFrom = .1;
constexpr double kMotionEdgeCostsMost = 1;
constexpr double kMotionEdgeCost = 4;

// ---- Trust in history, by what reproject found.

// Of a sample without velocity or depth there is none.
inline double known_trust(const Reprojection& sample) {
  return std::isnan(sample.trust) ? 0 : std::max(sample.trust, 0.0);
}

// Where nothing moves only reactive values of both frames take trust.
template <typename Real>
Real trust_of_still(const TemporalInputs& in, int x, int y) {
  if (in.frame.reactive.empty()) return 1;
  const auto before = [](int sample, int size, int size_before) {
    return truncate_within((sample + Real(.5)) * (static_cast<double>(size_before) / size), 0,
                           size_before - 1);
  };
  const int column = before(x, in.frame.width, in.previous_width);
  const int row = before(y, in.frame.height, in.previous_height);
  const Real now = in.frame.reactive[index_of(in.frame.width, x, y)];
  const Real then = in.reactive_before[index_of(in.previous_width, column, row)];
  return (1 - now) * (1 - then);
}

template <typename Real>
Real trust_at(const TemporalInputs& in, const Neighbourhood<Real>& near) {
  if (in.reprojections.empty()) return trust_of_still<Real>(in, near.x.sample, near.y.sample);
  return known_trust(in.reprojection_at(near.x.sample, near.y.sample));
}

// ---- What is known of a pixel.

template <typename Real>
struct Known {
  PixelOf<Real> colour;  // of history; the fourth channel is not used
  Real alpha;
  Real confidence;
  Real rejection;    // in [0, 1]
  Real inertia = 0;  // of a seed, against this frame's sample
};

// What a trust in [0, 1] leaves: 32 of a whole one, 1 of a half, 0 of none.
template <typename Real>
Real most_confidence(const Real& trust) {
  return trust / (1 + 1 / kMostConfidence - trust);
}

template <typename Real>
Real limit_confidence(const FetchedHistory<Real>& history, const Real& trust, double motion_edge) {
  Real w = clamp(history.known.texel[3], 0, kMostConfidence);
  w = w / (1 + kResamplingCost * history.between * w);
  if (history.between > kResampledFrom) w = min(w, kMostResampled);
  w = min(w, most_confidence(trust));
  const Real edge = smooth_step(Real(motion_edge), kMotionEdgeCostsFrom, kMotionEdgeCostsMost);
  return w / (1 + kMotionEdgeCost * edge * w);
}

}  // namespace quincunx::reference
