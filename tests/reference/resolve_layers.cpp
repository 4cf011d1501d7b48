// SPDX-License-Identifier: MIT
// resolve_layers: what one output pixel's layers become with this frame. p: the pixel's centre, R and R': the phases of
// its tile's far and near layer, n: the sample nearest to p + R. The pixel has the layers of n: one, or a far one of
// depth b and a near one of depth a, D = (a + b) / 2 lying between them.
//   one layer  as in resolve_temporal, steps fetch history to accumulate, but texels of two layers give the one of
//              n's depth (fetch_layer), and where the texel that n moved from had two, trust is open trust
//              (outliers are held back as there)
//   far layer  fetch history     the far surface, at the place that it moved from
//              limit confidence, reject, relight     as in resolve_temporal, trust being open trust
//              reseed            where W < .15: as in resolve_temporal, of the samples behind D alone; where there is
//                                none nothing changes
//              accumulate        n, if it lies behind D
//   near layer, as colour and alpha, both times coverage, and coverage: a sample before D counts as its colour, its
//              alpha and 1, one behind as 0
//              fetch history     the near surface, at the place that p + R' moved from; where the near layers of the
//                                tile move apart by more than 1 px, others may cross it
//              limit confidence  W <- W / (1 + .2 k W); at most 8, and min(t, 1 - new cut) in place of t in
//                                t / (1 + 1/32 - t), t being open trust
//              relight           as in resolve_temporal
//              reseed            where W < .15: f = 1 - W / .15; F <- F + f (Gaussian of 3 x 3 samples - F); W <- .15;
//                                without any valid sample F <- F (1 - f), W <- 0
//              accumulate        as in resolve_temporal, the sample nearest to p + R'; W at most 8
// Source: found by measuring (docs/lab/layers.md).
#include "resolve_layers.h"

#include <cmath>
#include <cstddef>

#include "temporal/accumulate.h"
#include "temporal/limit_confidence.h"
#include "temporal/rectify.h"
#include "temporal/reseed.h"

namespace quincunx::reference {
namespace {

constexpr double kCrossingMotionMin =
    1;  // px a frame: near layers of a tile that move apart by more may cross
constexpr double kNearReach =
    .6;  // times the distance between samples: the near layer's, at least kWideReach

// An output pixel of this frame.
template <typename Real>
struct LayeredPixel {
  int x = 0, y = 0;
  const Tile* tile = nullptr;
  const LayerTile* layers = nullptr;
  LayerSplit split;
  double depth = 0;  // depth of the sample nearest to the far, or only, layer's picture
  double open_trust = 0;
  Real between = 0;  // D
};

// ---- Samples as a layer has them.

enum class Side { kNeither, kFar, kNear };

// Where sample (x, y), clamped to the edge, lies of D. One that is not valid, or has no depth, lies nowhere.
template <typename Real>
Side side_of(const Frame& frame, const Real& between, int x, int y) {
  const int column = std::clamp(x, 0, frame.width - 1);
  const int row = std::clamp(y, 0, frame.height - 1);
  if (!is_valid(texel_at(frame, column, row))) return Side::kNeither;
  const double depth = frame.depth[index_of(frame.width, column, row)];
  if (depth > between) return Side::kNear;
  return depth < between ? Side::kFar : Side::kNeither;
}

// A sample as a layer has it.
struct Part {
  Pixel value = {};  // colour and coverage
  double alpha = 0;
};

// Returns a layer's part of a sample on either side.
Part part_of(const Pixel& sample, Side side, Layer layer) {
  if (layer == Layer::kNear && side == Side::kFar) return {};
  return {{sample[0], sample[1], sample[2], 1}, sample[3]};
}

template <typename Real>
struct LayerSeed {
  PixelOf<Real> value = {};
  Real alpha = 0;
  bool is_known = false;  // a sample of the layer is near enough
};

// The Gaussian of those of the 3 x 3 samples that the layer has.
template <typename Real>
LayerSeed<Real> seed_of_layer(const Frame& frame, const Neighbourhood<Real>& near, const Real& between,
                              Layer layer) {
  LayerSeed<Real> seed;
  Real weights = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = near.x.sample + dx;
      const int y = near.y.sample + dy;
      const Side side = side_of(frame, between, x, y);
      if (side == Side::kNeither || (layer == Layer::kFar && side == Side::kNear)) continue;
      const Part sample = part_of(texel_clamped(frame, x, y), side, layer);
      const Real across = dx - near.x.past;
      const Real down = dy - near.y.past;
      const Real weight =
          luma_weighted(bell((across * across + down * down) * kSeedFalloff), as<Real>(sample.value));
      weights += weight;
      for (std::size_t c = 0; c < 4; ++c)
        seed.value[c] += sample.value[c] * weight;
      seed.alpha += sample.alpha * weight;
    }
  }
  seed.is_known = weights > 0;
  if (!seed.is_known) return seed;
  for (Real& channel : seed.value)
    channel = channel / weights;
  seed.alpha = seed.alpha / weights;
  return seed;
}

// ---- The far layer, or the only one.

template <typename Real>
void reseed_far(const LayeredPixel<Real>& pixel, const Frame& frame, const Neighbourhood<Real>& near,
                Known<Real>& known) {
  if (!seamless(known.confidence < kConfidenceMin)) return;
  const auto seed = seed_of_layer(frame, near, pixel.between, Layer::kFar);
  if (!seed.is_known) return;
  const Real share = max(1 - known.confidence / kConfidenceMin, 0);
  for (std::size_t c = 0; c < 3; ++c)
    known.colour[c] += (seed.value[c] - known.colour[c]) * share;
  known.alpha += (seed.alpha - known.alpha) * share;
  known.inertia = kSeedInertia * share;
  known.confidence = max(known.confidence, kConfidenceMin);
}

// The range of the alphas of a layer's own samples around a pixel.
template <typename Real>
AlphaRange alphas_of(const LayeredPixel<Real>& pixel, const Frame& frame, const Neighbourhood<Real>& near,
                     Side side) {
  return alphas_around(frame, near.x.sample, near.y.sample,
                       [&](int x, int y) { return side_of(frame, pixel.between, x, y) == side; });
}

template <typename Real>
void follow_far_alpha(const ResolveInputs& in, const LayeredPixel<Real>& pixel,
                      const Neighbourhood<Real>& near, const std::array<int, 2>& texel, Real& alpha) {
  if (pixel.split.is_split()) {
    follow_alpha(
        alphas_of(pixel, in.now.frame, near, Side::kFar), [] { return 0; }, alpha);
    return;
  }
  const LayerHistory& past = in.past;
  const auto texel_at = [&](int x, int y) {
    return past.texel(std::clamp(x, 0, past.width - 1), std::clamp(y, 0, past.height - 1));
  };
  follow_alpha_of_one(
      in.now.frame, near.x.sample, near.y.sample, texel,
      [&](int x, int y) { return past.alpha[texel_at(x, y)]; },
      [&](int x, int y) { return std::signbit(past.far[texel_at(x, y)][3]); }, alpha);
}

template <typename Real>
HistoryTexel<Real> update_far(const ResolveInputs& in, const LayeredPixel<Real>& pixel,
                              const Neighbourhood<Real>& near) {
  const TemporalInputs& now = in.now;
  const TileReprojection& tile = pixel.tile->reprojection;
  const bool is_split = pixel.split.is_split();
  const Reprojection& reprojection = now.reprojection_at(near.x.sample, near.y.sample);
  const double motion_edge = std::abs(reprojection.motion_edge);

  // Fetch history.
  const LayerWish wish = is_split ? LayerWish{Layer::kFar, pixel.split.near_depth, pixel.split.far_depth}
                                  : LayerWish{Layer::kOnly, pixel.depth, 0};
  const std::array<Real, 2> place = {
      Real(pixel.x + .5) + tile.phase[0] + Real(reprojection.x) * now.reprojection_scale(0),
      Real(pixel.y + .5) + tile.phase[1] + Real(reprojection.y) * now.reprojection_scale(1)};
  const auto fetched = fetch_layer(in.past, wish, place, tile.is_rigid);
  FetchedHistory<Real> history;
  history.between = fetched.between;
  history.known.alpha = 0;
  if (fetched.value[3] > kNearCoverageMin) {
    for (std::size_t c = 0; c < 3; ++c)
      history.known.texel[c] = fetched.value[c] / fetched.value[3];
    history.known.texel[3] = fetched.confidence;
    history.known.alpha = fetched.alpha / fetched.value[3];
  }

  // Limit confidence, reject, relight. Layers answer for depth.
  const Real trust = is_split || fetched.was_split ? Real(pixel.open_trust) : trust_at<Real>(now, near);
  const Pixel& sample = texel_clamped(now.frame, near.x.sample, near.y.sample);
  // What nothing is known of, and no sample shows, is as transparent as what hides it.
  if (is_valid(sample) && history.known.texel[3] == 0) history.known.alpha = sample[3];
  Known<Real> known{history.known.texel, history.known.alpha, limit_confidence(history, trust, motion_edge),
                    max(1 - trust, motion_edge_strength(Real(motion_edge)))};
  reject(now, in.tiles, pixel.x, pixel.y, known);
  relight(now, in.tiles, pixel.x, pixel.y, known.colour);

  if (in.has_alpha()) follow_far_alpha(in, pixel, near, fetched.texel, known.alpha);
  const bool is_held_back = holds_back(pixel.tile->light, known, sample);

  // Rectify and reseed.
  if (is_split) {
    reseed_far(pixel, now.frame, near, known);
  } else {
    if (seamless(known.rejection > 0)) {
      rectify(box_around<Real>(now.frame, near.x.sample, near.y.sample), known);
      rectify_alpha(now.frame, near.x.sample, near.y.sample, known);
    }
    reseed(now, near, known);
  }

  // Accumulate. A split tile does not move as a whole.
  TileReprojection whole = tile;
  whole.is_rigid = tile.is_rigid && !pixel.layers->is_split;
  Real weight = 0;
  if (is_valid(sample) && !is_held_back && (!is_split || pixel.depth < pixel.between)) {
    weight = sample_weight(as<Real>(sample), near.x.past * now.spacing(0), near.y.past * now.spacing(1),
                           reach_of(whole, known.confidence));
  }
  HistoryTexel<Real> updated = accumulate(known, as<Real>(sample), weight);
  if (is_split) updated.texel[3] = -updated.texel[3];
  return updated;
}

// ---- The near layer.

template <typename Real>
struct NearTexel {
  PixelOf<Real> value = {};  // colour, times coverage, and coverage
  Real confidence = 0;
  Real alpha = 0;  // alpha, times coverage
};

template <typename Real>
NearTexel<Real> fetch_near(const ResolveInputs& in, const LayeredPixel<Real>& pixel) {
  const LayerSplit& s = pixel.split;
  const std::array<Real, 2> place = {Real(pixel.x + .5) + pixel.layers->phase[0] + s.motion[0],
                                     Real(pixel.y + .5) + pixel.layers->phase[1] + s.motion[1]};
  const bool may_cross = pixel.layers->motion_range > kCrossingMotionMin;
  const auto fetched = fetch_layer(in.past, {Layer::kNear, s.near_depth, s.far_depth, may_cross}, place,
                                   pixel.layers->is_rigid);
  NearTexel<Real> near{fetched.value, fetched.confidence, fetched.alpha};

  // Limit confidence, relight.
  const auto gain = between_tiles<Real>(in.now, in.tiles, pixel.x, pixel.y, &TileLight::gain);
  near.confidence = near.confidence / (1 + kResamplingCost * fetched.between * near.confidence);
  near.confidence =
      min(near.confidence, min(most_confidence(min(pixel.open_trust, 1 - Real(pixel.tile->light.new_cut))),
                               kResampledConfidenceMax));
  for (std::size_t c = 0; c < 3; ++c)
    near.value[c] *= gain;
  return near;
}

template <typename Real>
NearTexel<Real> update_near(const ResolveInputs& in, const LayeredPixel<Real>& pixel) {
  const Frame& frame = in.now.frame;
  const auto around = nearest_samples<Real>(in.now, pixel.x, pixel.y, pixel.layers->phase);
  NearTexel<Real> near = fetch_near(in, pixel);
  if (in.has_alpha() && near.value[3] > kShownCoverageMin) {
    Real alpha = near.alpha / near.value[3];
    follow_alpha(
        alphas_of(pixel, frame, around, Side::kNear), [] { return 0; }, alpha);
    near.alpha = near.value[3] * alpha;
  }

  // Reseed.
  Real inertia = 0;
  if (seamless(near.confidence < kConfidenceMin)) {
    const auto seed = seed_of_layer(frame, around, pixel.between, Layer::kNear);
    const Real share = max(1 - near.confidence / kConfidenceMin, 0);
    for (std::size_t c = 0; c < 4; ++c)
      near.value[c] += (seed.value[c] - near.value[c]) * share;
    near.alpha += (seed.alpha - near.alpha) * share;
    inertia = kSeedInertia * share;
    if (seed.is_known)
      near.confidence = max(near.confidence, kConfidenceMin);
    else if (near.confidence < kConfidenceMin)
      near.confidence = 0;
  }

  // Accumulate.
  const Side side = side_of(frame, pixel.between, around.x.sample, around.y.sample);
  if (side != Side::kNeither) {
    const Part sample = part_of(texel_clamped(frame, around.x.sample, around.y.sample), side, Layer::kNear);
    const double reach = std::max(kNearReach * std::max(in.now.spacing(0), in.now.spacing(1)), kWideReach);
    const Real weight = sample_weight(as<Real>(sample.value), around.x.past * in.now.spacing(0),
                                      around.y.past * in.now.spacing(1), Real(reach));
    const Real total = near.confidence + weight;
    const Real share = weight / max(total + inertia, kWeightSumMin);
    for (std::size_t c = 0; c < 4; ++c)
      near.value[c] += (sample.value[c] - near.value[c]) * share;
    near.alpha += (sample.alpha - near.alpha) * share;
    near.confidence = total;
  }
  near.confidence = min(near.confidence, kResampledConfidenceMax);
  return near;
}

template <typename Real>
Real fourth_root(const Real& depth) {
  return sqrt(sqrt(depth));
}

}  // namespace

template <typename Real>
LayeredTexelOf<Real> resolve_layers(const ResolveInputs& in, int x, int y) {
  const TemporalInputs& now = in.now;
  const std::size_t tile = index_of(now.tiles_x(), x / kTile, y / kTile);
  const auto& phase = in.tiles[tile].reprojection.phase;
  const auto near = nearest_samples<Real>(now, x, y, phase);
  const std::size_t sample = index_of(now.frame.width, near.x.sample, near.y.sample);
  const LayerSplit& split = in.splits[sample];
  const LayeredPixel<Real> pixel = {x,
                                    y,
                                    &in.tiles[tile],
                                    &in.layers[tile],
                                    split,
                                    now.frame.depth[sample],
                                    in.open_trust[sample],
                                    .5 * (Real(split.near_depth) + split.far_depth)};
  LayeredTexelOf<Real> texel;
  texel.is_split = split.is_split();
  const HistoryTexel<Real> far = update_far(in, pixel, near);
  texel.far = far.texel;
  texel.alpha = far.alpha;
  texel.state = {fourth_root<Real>(pixel.depth), 0, 0};
  if (!texel.is_split) return texel;
  const NearTexel<Real> updated = update_near(in, pixel);
  texel.near = updated.value;
  texel.state = {fourth_root<Real>(split.far_depth), fourth_root<Real>(split.near_depth), updated.confidence,
                 in.has_alpha() ? updated.alpha : 0};
  return texel;
}

template LayeredTexelOf<double> resolve_layers(const ResolveInputs&, int, int);
template LayeredTexelOf<Bounded> resolve_layers(const ResolveInputs&, int, int);

}  // namespace quincunx::reference
