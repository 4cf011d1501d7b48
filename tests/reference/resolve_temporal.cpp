// SPDX-License-Identifier: MIT
// resolve_temporal: what one output pixel's history becomes with this frame. p: the pixel's centre, R: the
// phase of its tile, s: the sample nearest to p + R, m and W: colour and confidence of history.
//   fetch history     m, W at the place that s moved from; k, how far that lies between texels
//   limit confidence  W <- min(W, 32); W <- W / (1 + .2 k W), and at most 8 where k > .01;
//                     W <- min(W, trust / (1 + 1/32 - trust)); W <- W / (1 + 4 e W),
//                     e = smooth_step(motion edge, .1, 1)
//   reject            d = max(1 - trust, strength of the motion edge, rejection of the tile)
//   relight           m <- gain m
//   rectify           where d > 0: m moves by d of the way into mean +- .75 standard deviations of a cross of
//                     five samples, as c / (1 + max c); W <- W (1 - d min(1, distance / (deviation + .02)))
//   reseed            where W < .15: f = 1 - W / .15; m <- m + f (Gaussian of 3 x 3 samples - m); W <- .15
//   (alpha takes the same steps with the same weights, but is not relit, and rectified as it is)
//   accumulate        m <- m + (s - m) w / (W + w + .85 f); W <- min(W + w, 32);
//                     w = (1 - d^2 / r^2)^2 / max(1, brightest channel of s / 2), d the distance of s
// Source: accumulation and rectification after Karis, "High-Quality Temporal Supersampling", 2014, and AMD
// FidelityFX Super Resolution 2.2.1; the rest found by measuring (docs/temporal.md, whose dB are cited here).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "history_sampling.h"
#include "motion_edge.h"

namespace quincunx::reference {
namespace {

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
// Half the size of the box that history is clamped to, in standard deviations of the samples in a cross.
constexpr double kBoxSize = .75;
// Tone-mapped colour: added to the box's size where a distance is compared with it.
constexpr double kBoxMargin = .02;
constexpr double kLeastRest = 0x1p-16;  // of 1 - tone, against a division by 0 on the way back
// Confidence below which history is reseeded, and which the seed of a single frame has.
constexpr double kReseedBelow = .15;
// Of a whole seed against its first sample, in weights of samples: worth .01 dB, .05 to .1 in first frames.
constexpr double kSeedInertia = .85;
// 1 / (2 sigma^2) of the seed's Gaussian, sigma = .45 samples.
constexpr double kSeedFalloff = 2.5;
// Output pixels a frame by which the motion of one surface's samples differs: ghosts .17 -> .06 at most.
constexpr double kSameMotion = .15;
constexpr double kLeastSimilarity = 0x1p-10;  // so that a seed exists where all samples differ
// Output pixels from which on a sample has no weight, and the same in still tiles as W grows: 1.2 dB on still
// pictures.
constexpr double kReach = 1.05;
constexpr double kLeastReach = .85;
constexpr double kNarrowing = .1;       // for each unit of confidence
constexpr double kLeastWeight = 1e-30;  // against a division by 0

// ---- Reproject: the sample that an output pixel looks at.

// On one axis, with distances in samples.
template <typename Real>
struct Nearest {
  int sample = 0;
  Real past = 0;  // from the sample to p + R, which may lie beyond the outermost sample
  int left = 0;   // the samples on either side of p + R, clamped to the edge ...
  int right = 0;
  Real fraction = 0;  // ... and how far it lies between them
};

template <typename Real>
Nearest<Real> nearest_sample(int x, int output, int render, double jitter, double phase) {
  const double u = texel_coordinate(x, output, render, jitter);
  const int texel = static_cast<int>(std::floor(u));
  const Real at = u - texel + phase / Real(static_cast<double>(output) / render);  // from that texel on
  const int last = render - 1;
  Nearest<Real> nearest;
  nearest.sample = texel + round_down_within(at, -texel, last - texel);
  nearest.past = at - (nearest.sample - texel);
  nearest.left = texel + floor_within(at, -texel, std::max(last - 1, 0) - texel);
  nearest.right = std::min(nearest.left + 1, last);
  nearest.fraction = clamp(at - (nearest.left - texel), 0, nearest.right - nearest.left);
  return nearest;
}

template <typename Real>
struct Neighbourhood {
  Nearest<Real> x, y;
};

// ---- Trust in history, by what reproject found.

// Of a sample without velocity or depth there is none.
double known_trust(const Reprojection& sample) {
  return std::isnan(sample.trust) ? 0 : std::max(sample.trust, 0.0);
}

template <typename Real>
Real trust_between_samples(const TemporalInputs& in, const Neighbourhood<Real>& near) {
  const auto trust = [&](int x, int y) { return Real(known_trust(in.reprojection_at(x, y))); };
  const Real& fx = near.x.fraction;
  const Real& fy = near.y.fraction;
  const Real above = trust(near.x.left, near.y.left) * (1 - fx) + trust(near.x.right, near.y.left) * fx;
  const Real below = trust(near.x.left, near.y.right) * (1 - fx) + trust(near.x.right, near.y.right) * fx;
  return above * (1 - fy) + below * fy;
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
Real trust_at(const TemporalInputs& in, const TemporalOptions& options, const Neighbourhood<Real>& near) {
  if (in.reprojections.empty()) return trust_of_still<Real>(in, near.x.sample, near.y.sample);
  if (options.bilinear_trust) return trust_between_samples(in, near);
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

// ---- Relight and reject: what temporal_light found in the tiles around.

// On a row linear between the means of two tiles at their common edge, over rows between the tiles' middles.
template <typename Real>
Real between_tiles(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y,
                   double TileLight::*what) {
  const auto edge = [&](int column, int row) {
    const auto tile = [&](int i) {
      return Real(tiles[index_of(in.tiles_x(), std::clamp(i, 0, in.tiles_x() - 1), row)].light.*what);
    };
    return .5 * (tile(column - 1) + tile(column));
  };
  const int middle = y - kTile / 2;
  const int above = std::max(middle, 0) / kTile;
  const int below = std::min(above + 1, in.tiles_y() - 1);
  const double down = middle < 0 ? 0 : (middle % kTile + .5) / kTile;
  const double along = (x % kTile + .5) / kTile;
  const auto at_edge = [&](int column) {
    const Real upper = edge(column, above);
    return upper + (edge(column, below) - upper) * down;
  };
  const Real left = at_edge(x / kTile);
  return left + (at_edge(x / kTile + 1) - left) * along;
}

template <typename Real>
void relight(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y, Known<Real>& known) {
  const auto gain = between_tiles<Real>(in, tiles, x, y, &TileLight::gain);
  for (Real& value : known.colour)
    value *= gain;
}

template <typename Real>
void reject(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y, Known<Real>& known) {
  const auto rejection = between_tiles<Real>(in, tiles, x, y, &TileLight::rejection);
  known.rejection = max(known.rejection, rejection);
  known.confidence = min(known.confidence, most_confidence(1 - rejection));
}

// ---- Rectify.

template <typename Real>
Real brightest(const PixelOf<Real>& c) {
  return max(max(c[0], c[1]), max(c[2], 0));
}

// Differences as the eye has them, rather than as light.
template <typename Real>
PixelOf<Real> to_tone(const PixelOf<Real>& colour) {
  const Real scale = 1 + brightest(colour);
  return {colour[0] / scale, colour[1] / scale, colour[2] / scale, 0};
}

template <typename Real>
PixelOf<Real> from_tone(const PixelOf<Real>& tone) {
  const Real rest = max(1 - brightest(tone), kLeastRest);
  return {tone[0] / rest, tone[1] / rest, tone[2] / rest, 0};
}

// What the samples around a pixel allow, in tone space.
template <typename Real>
struct Box {
  PixelOf<Real> mean = {};
  PixelOf<Real> deviation = {};  // times kBoxSize
  bool is_known = false;         // there is a valid sample
};

// Of the sample (x, y) and its four neighbours.
template <typename Real>
Box<Real> box_around(const Frame& frame, int x, int y) {
  const int cross[][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  // Sums of the differences to the first sample: their squares lose no digits.
  PixelOf<Real> first = {}, sum = {}, squares = {};
  int count = 0;
  for (const auto& step : cross) {
    const Pixel& sample = texel_clamped(frame, x + step[0], y + step[1]);
    if (!is_valid(sample)) continue;
    const PixelOf<Real> tone = to_tone(as<Real>(sample));
    if (count == 0) first = tone;
    for (std::size_t c = 0; c < 3 && count > 0; ++c) {
      const Real difference = tone[c] - first[c];
      sum[c] += difference;
      squares[c] += difference * difference;
    }
    ++count;
  }
  Box<Real> box;
  box.is_known = count > 0;
  for (std::size_t c = 0; c < 3 && count > 0; ++c) {
    const Real mean = sum[c] / count;
    box.mean[c] = first[c] + mean;
    box.deviation[c] = kBoxSize * sqrt(max(squares[c] / count - mean * mean, 0));
  }
  return box;
}

// Towards what the surroundings allow; confidence falls by how wrong history was.
template <typename Real>
void rectify(const Box<Real>& box, Known<Real>& known) {
  if (!box.is_known) return;
  PixelOf<Real> tone = to_tone(known.colour);
  Real distance = 0;
  Real spread = 0;
  bool is_outside = false;
  for (std::size_t c = 0; c < 3; ++c) {
    const Real low = box.mean[c] - box.deviation[c];
    const Real high = box.mean[c] + box.deviation[c];
    spread += box.deviation[c];
    if (seamless(tone[c] < low) || seamless(tone[c] > high)) {
      const Real step = clamp(tone[c], low, high) - tone[c];
      distance += abs(step);
      tone[c] += step * known.rejection;
      is_outside = true;
    }
  }
  known.confidence *= 1 - known.rejection * min(1, distance / (spread + kBoxMargin));
  if (is_outside) known.colour = from_tone(tone);
}

// Alpha, towards that of the valid ones of the same samples. It is no light: no tone curve.
template <typename Real>
void rectify_alpha(const Frame& frame, int x, int y, Known<Real>& known) {
  const int cross[][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  Real first = 0, sum = 0, squares = 0;
  int count = 0;
  for (const auto& step : cross) {
    const Pixel& sample = texel_clamped(frame, x + step[0], y + step[1]);
    if (!is_valid(sample)) continue;
    if (count == 0) first = sample[3];
    const Real difference = sample[3] - first;
    sum += difference;
    squares += difference * difference;
    ++count;
  }
  if (count == 0) return;
  const Real mean = sum / count;
  const Real deviation = kBoxSize * sqrt(max(squares / count - mean * mean, 0));
  const Real middle = first + mean;
  known.alpha += (clamp(known.alpha, middle - deviation, middle + deviation) - known.alpha) * known.rejection;
}

// ---- Reseed.

// In (0, 1]: how far another sample may show the surface of `own`, by its motion. Those of another surface
// would stay as a ghost when it has moved on.
template <typename Real>
Real similarity(const TemporalInputs& in, int own_x, int own_y, int x, int y) {
  if (in.reprojections.empty()) return 1;
  const Reprojection& own = in.reprojection_at(own_x, own_y);
  const Reprojection& other =
      in.reprojection_at(std::clamp(x, 0, in.frame.width - 1), std::clamp(y, 0, in.frame.height - 1));
  const Real dx = (Real(other.x) - own.x) * in.reprojection_scale(0) / kSameMotion;
  const Real dy = (Real(other.y) - own.y) * in.reprojection_scale(1) / kSameMotion;
  return max(1 - dx * dx - dy * dy, kLeastSimilarity);
}

// A sample's weight times its luma weight 1 / max(1, brightest / 2): one sample shall not outshine the others.
template <typename Real>
Real luma_weighted(const Real& weight, const Pixel& sample) {
  return weight / max(1, .5 * brightest(as<Real>(sample)));
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
        const Real weight = luma_weighted<Real>(Real(1) / distance, sample);
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
      const Real weight =
          luma_weighted(gaussian, sample) * similarity<Real>(in, near.x.sample, near.y.sample, x, y);
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
  if (!seamless(known.confidence < kReseedBelow)) return;
  const Seed<Real> seed = seed_at(in, near);
  const Real share = max(1 - known.confidence / kReseedBelow, 0);
  for (std::size_t c = 0; c < 3; ++c)
    known.colour[c] += (seed.colour[c] - known.colour[c]) * share;
  known.alpha += (seed.colour[3] - known.alpha) * share;
  known.inertia = kSeedInertia * share;
  if (seed.is_known)
    known.confidence = max(known.confidence, kReseedBelow);
  else if (known.confidence < kReseedBelow)
    known.confidence = 0;
}

// ---- Accumulate.

// Of a sample `dx` and `dy` output pixels away.
template <typename Real>
Real sample_weight(const Pixel& sample, const Real& dx, const Real& dy, bool is_still,
                   const Real& confidence) {
  const Real reach = is_still ? max(kReach - kNarrowing * confidence, kLeastReach) : Real(kReach);
  const Real near = max(1 - (dx * dx + dy * dy) / (reach * reach), 0);
  return luma_weighted<Real>(near * near, sample);
}

template <typename Real>
HistoryTexel<Real> accumulate(const Known<Real>& known, const Pixel& sample, const Real& weight) {
  HistoryTexel<Real> updated = {known.colour, known.alpha};
  const Real total = known.confidence + weight;
  const Real share = weight / max(total + known.inertia, kLeastWeight);
  for (std::size_t c = 0; c < 3 && is_valid(sample); ++c)
    updated.texel[c] += (sample[c] - updated.texel[c]) * share;
  if (is_valid(sample)) updated.alpha += (sample[3] - updated.alpha) * share;
  updated.texel[3] = min(total, kMostConfidence);
  return updated;
}

}  // namespace

template <typename Real>
HistoryTexel<Real> resolve_temporal(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                    const TemporalOptions& options, int x, int y) {
  const Frame& frame = in.frame;
  const TileReprojection& tile = tiles[index_of(in.tiles_x(), x / kTile, y / kTile)].reprojection;
  const Neighbourhood<Real> near = {
      nearest_sample<Real>(x, in.output_width, frame.width, frame.jitter_x, tile.phase[0]),
      nearest_sample<Real>(y, in.output_height, frame.height, frame.jitter_y, tile.phase[1])};
  const Pixel& sample = texel_clamped(frame, near.x.sample, near.y.sample);
  Reprojection reprojection{.trust = 1};
  if (!in.reprojections.empty()) reprojection = in.reprojection_at(near.x.sample, near.y.sample);
  const Real trust = trust_at(in, options, near);
  const double motion_edge = std::abs(reprojection.motion_edge);

  const auto history = fetch_history<Real>(in, tile, reprojection, options, x, y);
  Known<Real> known{history.known.texel, history.known.alpha, limit_confidence(history, trust, motion_edge),
                    max(1 - trust, motion_edge_strength(Real(motion_edge)))};
  reject(in, tiles, x, y, known);
  relight(in, tiles, x, y, known);
  if (seamless(known.rejection > 0)) {
    rectify_alpha(frame, near.x.sample, near.y.sample, known);
    rectify(box_around<Real>(frame, near.x.sample, near.y.sample), known);
  }
  reseed(in, near, known);

  Real weight = 0;
  if (is_valid(sample)) {
    weight = sample_weight<Real>(sample, near.x.past * in.spacing(0), near.y.past * in.spacing(1),
                                 stands_still(tile), known.confidence);
  }
  return accumulate(known, sample, weight);
}

template HistoryTexel<double> resolve_temporal(const TemporalInputs&, const std::vector<Tile>&,
                                               const TemporalOptions&, int, int);
template HistoryTexel<Bounded> resolve_temporal(const TemporalInputs&, const std::vector<Tile>&,
                                                const TemporalOptions&, int, int);

}  // namespace quincunx::reference
