// SPDX-License-Identifier: MIT
// merge_histories: what two histories of one pixel, both at its centre, come to. In tone space, for own a of confidence
// W and other b of V: m = l a + (1 - l) b, l = f(W) / (f(W) + f(V)), f(W) = W^2 / (W + 1) + .001. Where a has two
// layers, F of the far one and N of the near one of coverage c, W = 1 / ((1 - c) / (F + .1) + c / (N + .1)) - .1.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {
namespace {

constexpr double kMergeWeightMin = 1e-3;  // of what nothing is known of
constexpr double kLayerConfidence = .1;   // added to what is known of each of two layers
constexpr double kToneRestMin = 0x1p-16;  // least 1 - tone, against a division by 0 on the way back

template <typename Real>
Real weight_of(const Real& confidence) {
  return confidence * confidence / (confidence + 1) + kMergeWeightMin;
}

// The confidence of both layers together, where there are two.
template <typename Real>
Real confidence_of(const HistoryTexel<double>& own, const NearLayer& near) {
  const Real known = std::abs(own.texel[3]);
  if (!std::signbit(own.texel[3])) return known;
  const Real far = known + kLayerConfidence, nearer = Real(near.confidence) + kLayerConfidence;
  const Real coverage = std::clamp(near.coverage, 0.0, 1.0);
  return max(far * nearer / (nearer + coverage * (far - nearer)) - kLayerConfidence, 0);
}

template <typename Real>
Real brightest_of(const PixelOf<Real>& colour) {
  return max(max(max(colour[0], colour[1]), colour[2]), 0);
}

template <typename Real>
PixelOf<Real> tone_of(const Pixel& texel) {
  const PixelOf<Real> colour = as<Real>(texel);
  const Real scale = 1 + brightest_of(colour);
  return {colour[0] / scale, colour[1] / scale, colour[2] / scale, 0};
}

}  // namespace

template <typename Real>
HistoryTexel<Real> merge_histories(const HistoryTexel<double>& own, const NearLayer& near,
                                   const HistoryTexel<double>& other) {
  const bool layered = std::signbit(own.texel[3]) || std::signbit(other.texel[3]);
  const Real confidence = confidence_of<Real>(own, near);
  const Real known = weight_of<Real>(confidence), other_known = weight_of<Real>(std::abs(other.texel[3]));
  const Real share = other_known / (known + other_known);
  const PixelOf<Real> tone = tone_of<Real>(own.texel), other_tone = tone_of<Real>(other.texel);
  PixelOf<Real> mixed = {};
  for (std::size_t c = 0; c < 3; ++c)
    mixed[c] = tone[c] + (other_tone[c] - tone[c]) * share;
  const Real rest = max(1 - brightest_of(mixed), kToneRestMin);
  HistoryTexel<Real> merged;
  for (std::size_t c = 0; c < 3; ++c)
    merged.texel[c] = mixed[c] / rest;
  const Real sum = confidence + std::abs(other.texel[3]);
  merged.texel[3] = layered ? -sum : sum;
  merged.alpha = own.alpha + (Real(other.alpha) - own.alpha) * share;
  return merged;
}

template HistoryTexel<double> merge_histories(const HistoryTexel<double>&, const NearLayer&,
                                              const HistoryTexel<double>&);
template HistoryTexel<Bounded> merge_histories(const HistoryTexel<double>&, const NearLayer&,
                                               const HistoryTexel<double>&);

}  // namespace quincunx::reference
