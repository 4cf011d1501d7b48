// SPDX-License-Identifier: MIT
// Reseeding: history of almost no confidence starts over from this frame's samples.
#pragma once

#include <algorithm>
#include <cstddef>

#include "frame_samples.h"
#include "limit_confidence.h"

namespace quincunx::reference {

// Confidence below which history is reseeded, and which the seed of a single frame has.
constexpr double kConfidenceMin = .15;
// Inertia of a whole seed against its first sample, in weights of samples: worth .01 dB, .05 to .1 in first frames.
constexpr double kSeedInertia = .85;
// 1 / (2 sigma^2) of the seed's Gaussian, sigma = .45 samples.
constexpr double kSeedFalloff = 2.5;
// Output pixels a frame by which the motion of one surface's samples differs: ghosts .17 -> .06 at most.
constexpr double kSameSurfaceMotionMax = .15;
constexpr double kSimilarityMin = 0x1p-10;  // so that a seed exists where all samples differ

// In (0, 1]: how far another sample may show the surface of `own`, by its motion. Those of another surface
// would stay as a ghost when it has moved on.
template <typename Real>
Real similarity(const TemporalInputs& in, int own_x, int own_y, int x, int y) {
  if (in.reprojections.empty()) return 1;
  const Reprojection& own = in.reprojection_at(own_x, own_y);
  const Reprojection& other =
      in.reprojection_at(std::clamp(x, 0, in.frame.width - 1), std::clamp(y, 0, in.frame.height - 1));
  const Real dx = (Real(other.x) - own.x) * in.reprojection_scale(0) / kSameSurfaceMotionMax;
  const Real dy = (Real(other.y) - own.y) * in.reprojection_scale(1) / kSameSurfaceMotionMax;
  return max(1 - dx * dx - dy * dy, kSimilarityMin);
}

template <typename Real>
struct Seed {
  PixelOf<Real> colour = {};
  bool is_known = false;  // a valid sample is near enough
};

// Where no near sample is valid: the mean of those in eight directions, weighted by luma and 1 / distance.
template <typename Real>
PixelOf<Real> seed_from_afar(const Frame& frame, int x, int y) {
  PixelOf<Real> sum = {};
  Real weights = 0;
  for (const int distance : {2, 4, 8, 16}) {
    for (int dy = -distance; dy <= distance; dy += distance) {
      for (int dx = -distance; dx <= distance; dx += distance) {
        const Pixel& sample = texel_clamped(frame, x + dx, y + dy);
        if (!is_valid(sample)) continue;
        const Real weight = luma_weighted(Real(1) / distance, as<Real>(sample));
        weights += weight;
        for (std::size_t c = 0; c < 4; ++c)
          sum[c] += sample[c] * weight;
      }
    }
  }
  for (std::size_t c = 0; c < 4 && weights > 0; ++c)
    sum[c] = sum[c] / weights;
  return sum;
}

// The Gaussian of those of the 3 x 3 samples that move alike.
template <typename Real>
Seed<Real> seed_at(const TemporalInputs& in, const Neighbourhood<Real>& near) {
  PixelOf<Real> sum = {};
  Real weights = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = near.x.sample + dx;
      const int y = near.y.sample + dy;
      const Pixel& sample = texel_clamped(in.frame, x, y);
      if (!is_valid(sample)) continue;
      const Real across = dx - near.x.past;
      const Real down = dy - near.y.past;
      const Real gaussian = bell((across * across + down * down) * kSeedFalloff);
      const Real weight = luma_weighted(gaussian, as<Real>(sample)) *
                          similarity<Real>(in, near.x.sample, near.y.sample, x, y);
      weights += weight;
      for (std::size_t c = 0; c < 4; ++c)
        sum[c] += sample[c] * weight;
    }
  }
  Seed<Real> seed;
  seed.is_known = weights > 0;
  if (!seed.is_known) {
    seed.colour = seed_from_afar<Real>(in.frame, near.x.sample, near.y.sample);
    return seed;
  }
  for (std::size_t c = 0; c < 4; ++c)
    seed.colour[c] = sum[c] / weights;
  return seed;
}

// The less is known, the more of the seed.
template <typename Real>
void reseed(const TemporalInputs& in, const Neighbourhood<Real>& near, Known<Real>& known) {
  if (!seamless(known.confidence < kConfidenceMin)) return;
  const Seed<Real> seed = seed_at(in, near);
  const Real share = max(1 - known.confidence / kConfidenceMin, 0);
  for (std::size_t c = 0; c < 3; ++c)
    known.colour[c] += (seed.colour[c] - known.colour[c]) * share;
  known.alpha += (seed.colour[3] - known.alpha) * share;
  known.inertia = kSeedInertia * share;
  if (seed.is_known)
    known.confidence = max(known.confidence, kConfidenceMin);
  else if (known.confidence < kConfidenceMin)
    known.confidence = 0;
}

}  // namespace quincunx::reference
