// SPDX-License-Identifier: MIT
// resolve_temporal: what one output pixel's history becomes with this frame. p: the pixel's centre, R: the
// phase of its tile, s: the sample nearest to p + R, m and W: colour and confidence of history.
//   fetch history     m, W at the place that s moved from; k, how far that lies between texels
//   limit confidence  W <- min(W, 32); W <- W / (1 + .2 k W), and at most 8 where k > .01;
//                     W <- min(W, trust / (1 + 1/32 - trust)); W <- W / (1 + 4 e W),
//                     e = smooth_step(motion edge, .1, 1)
//   reject            d = max(1 - trust, strength of the motion edge, rejection of the tile)
//   relight           m <- gain m
//   hold back         where the tile does, W >= .15 and s is an outlier for m, w is 0
//   rectify           where d > 0: m moves by d of the way into mean +- .75 standard deviations of a cross of
//                     five samples, as c / (1 + max c); W <- W (1 - d min(1, distance / (deviation + .02)))
//   reseed            where W < .15: f = 1 - W / .15; m <- m + f (Gaussian of 3 x 3 samples - m); W <- .15
//   (alpha takes the same steps with the same weights, but is not relit, and rectified as it is)
//   accumulate        m <- m + (s - m) w / (W + w + .85 f); W <- min(W + w, 32);
//                     w = (1 - d^2 / r^2)^2 / max(1, brightest channel of s / 2), d the distance of s
// Source: accumulation and rectification after Karis, "High-Quality Temporal Supersampling", 2014, and AMD
// FidelityFX Super Resolution 2.2.1; the rest found by measuring (docs/lab/temporal.md, whose dB are cited here).
#include <cmath>

#include "history_sampling.h"
#include "temporal/accumulate.h"
#include "temporal/limit_confidence.h"
#include "temporal/rectify.h"
#include "temporal/reseed.h"

namespace quincunx::reference {

template <typename Real>
HistoryTexel<Real> resolve_temporal(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                    const TemporalOptions& options, int x, int y) {
  const Frame& frame = in.frame;
  const TileReprojection& tile = tiles[index_of(in.tiles_x(), x / kTile, y / kTile)].reprojection;
  const Neighbourhood<Real> near = nearest_samples<Real>(in, x, y, tile.phase);
  const Pixel& sample = texel_clamped(frame, near.x.sample, near.y.sample);
  Reprojection reprojection{.trust = 1};
  if (!in.reprojections.empty()) reprojection = in.reprojection_at(near.x.sample, near.y.sample);
  const Real trust = trust_at(in, near);
  const double motion_edge = std::abs(reprojection.motion_edge);

  const auto history = fetch_history<Real>(in, tile, reprojection, options, x, y);
  Known<Real> known{history.known.texel, history.known.alpha, limit_confidence(history, trust, motion_edge),
                    max(1 - trust, motion_edge_strength(Real(motion_edge)))};
  reject(in, tiles, x, y, known);
  relight(in, tiles, x, y, known.colour);
  if (!in.history_alpha.empty()) {
    follow_alpha_of_one(
        frame, near.x.sample, near.y.sample, history.texel,
        [&](int i, int j) { return in.alpha_clamped(i, j); },
        [&](int i, int j) { return std::signbit(in.history_clamped(i, j)[3]); }, known.alpha);
  }
  const bool is_held_back =
      holds_back(tiles[index_of(in.tiles_x(), x / kTile, y / kTile)].light, known, sample);
  if (seamless(known.rejection > 0)) {
    rectify_alpha(frame, near.x.sample, near.y.sample, known);
    rectify(box_around<Real>(frame, near.x.sample, near.y.sample), known);
  }
  reseed(in, near, known);

  Real weight = 0;
  if (is_valid(sample) && !is_held_back) {
    weight = sample_weight<Real>(as<Real>(sample), near.x.past * in.spacing(0), near.y.past * in.spacing(1),
                                 reach_of(tile, known.confidence));
  }
  return accumulate(known, as<Real>(sample), weight);
}

template HistoryTexel<double> resolve_temporal(const TemporalInputs&, const std::vector<Tile>&,
                                               const TemporalOptions&, int, int);
template HistoryTexel<Bounded> resolve_temporal(const TemporalInputs&, const std::vector<Tile>&,
                                                const TemporalOptions&, int, int);

}  // namespace quincunx::reference
