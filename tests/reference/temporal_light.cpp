// SPDX-License-Identifier: MIT
// temporal_light: of each tile whether the light has changed, and how far its history is to be rejected. B, L,
// E, N, n: sums of brightening, light, history_error, neighbour_error and count over the tile and the eight
// around it; mean: the tile's own brightening / count; b, k: its own brighter and count.
//   relative     B / L
//   coherent     |B| > .75 sum |brightening|, |relative| > .05, |B| > 3 N / sqrt(n), no motion edge in the nine
//                tiles, and the samples agree: (sum of b) sign(relative) > .4 n, seven of ten
//   persistence  p <- .6 p, + .4 sign(relative) if coherent
//   gain         1 + relative if coherent and p sign(relative) > .62
//   widespread   more than .2 of all tiles have changed
//   relit        |sum of brightenings| of the whole picture > .8 its change and > .05 its light,
//                and widespread; then at once gain = 1 + that sum / light, where the samples agree on
//                the same sign; a tile whose |B| > .5 sum |brightening| and whose relative differs by
//                more than .3 of it, far from motion edges, keeps its own
//   flicker      f <- .9 f + .1 a, a the smaller |mean| of this frame and of the previous one where their signs
//                differ, else 0
//   rejection    the largest of three, each within [0, 1]; a suspicion below 0 is 0, and its confirmed part is
//                max(min(s, s') - .3, s - 4), s' that of the previous frame, 0 if of the other sign of mean
//     by error   (E - e) / e, e = 1.6 N + .002 n, where |B| < .5 E; in a calm tile its confirmed part
//     by change  (|mean| - T) / (T / 2), T = .8 N / n + 12 f + .01, where gain = 1, (|b| - 1)^2 >= 1.1 k and
//                |brightening| > .15 light; in a calm tile its confirmed part
//     by cut     (E' - 1.25 N') / (.35 N' + 1) of the whole picture's sums, where E' > .03 L', it is not
//                relit, and the change is widespread
//   unrest       1 where the confirmed part of either suspicion is above 0, else u <- .97 u
//   startled     1 where one of the nine tiles has startling > 0, else a <- .9 a
//   holds back   there, if none of the nine had a startled >= .15 in the previous frame,
//                and the picture is neither relit nor cut; gain = 1 and rejection = 0 then
//   calm         the tile stands still, and in the nine tiles the previous frame's unrest is below .3
// Source: found by measuring (docs/temporal.md): the gain is worth 4.7 dB on moving light and 6.8 dB on steps
// of the whole picture.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {
namespace {

// Relighting. All are parts of the sums above.
constexpr double kCoherent = .75;
constexpr double kLeastChange = .05;   // of L
constexpr double kAboveChance = 3;     // times N / sqrt(n), what aliasing alone may give
constexpr double kAgreement = .4;      // of samples, brighter less darker: seven of ten; +.02 dB
constexpr double kMemory = .6;         // of persistence, each frame
constexpr double kPersistent = .62;    // two coherent frames give .4 + .6 * .4 = .64
constexpr double kMostGain = 4;        // and 1 / 4 the least
constexpr double kLeastLight = 1e-6;   // against a division by 0
constexpr double kWholeCoherent = .8;  // of the whole picture
constexpr double kOwnCoherent = .5;    // of a tile that goes its own way while the whole picture changes ...
constexpr double kOwnDifference = .3;  // ... by a gain that differs by this part of the whole picture's

// Rejection.
constexpr double kWorse = 1.6;          // times N: history foretells worse than the neighbours do
constexpr double kErrorFloor = .002;    // of each sample
constexpr double kIncoherent = .5;      // |B| / E below which the error is no change of light
constexpr double kMajority = 1.1;       // (|b| - 1)^2 / samples: a test of signs
constexpr double kOwnChange = .15;      // of the tile's own light
constexpr double kNeighbourShare = .8;  // of the neighbours' mean error, which is usual
constexpr double kFlickerShare = 12;    // times flicker; without flicker -.08 dB
constexpr double kUsualFloor = .01;     // mean change of luma of a sample
constexpr double kChangeRange = .5;     // times what is usual, over which rejection grows to 1
constexpr double kFlickerMemory = .9;   // each frame: about ten
constexpr double kConfirmingCost = .3;  // of what two frames share of a suspicion
constexpr double kSureAlone = 4;        // suspicion of one frame that needs no other
constexpr double kUnrestMemory = .97;   // each frame
constexpr double kCalm = .3;            // unrest below which a tile that stands still is calm
constexpr double kCut = 1.25;           // E / N of the whole picture from which on it may be another one
constexpr double kCutRange = .35;       // of N, over which rejection grows to 1
constexpr double kCutFloor = .03;       // of the whole picture's light
constexpr double kCutMemory = .9;       // each frame: what seems another picture in each of them has no cut
constexpr double kSpread = .2;          // of all tiles: fewer are not the whole picture

// Startling samples.
constexpr double kStartledMemory = .9;  // each frame
constexpr double kForgotten = .15;      // after 18 frames

template <typename Real>
struct Sums {
  Real brightening = 0, change = 0, light = 0, history_error = 0, neighbour_error = 0;
  int count = 0;
  int brighter = 0;
  int startling = 0;
  double unrest = 0, startled = 0;  // the most
  bool has_motion_edge = false;
};

template <typename Real>
Sums<Real> sums_around(const LightInputs& in, int x, int y) {
  Sums<Real> sums;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, in.tiles_y - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, in.tiles_x - 1); ++column) {
      const Tile& tile = in.tiles[index_of(in.tiles_x, column, row)];
      sums.brightening += tile.evidence.brightening;
      sums.change += std::abs(tile.evidence.brightening);
      sums.light += tile.evidence.light;
      sums.history_error += tile.evidence.history_error;
      sums.neighbour_error += tile.evidence.neighbour_error;
      sums.count += tile.evidence.count;
      sums.brighter += tile.evidence.brighter;
      sums.startling += tile.evidence.startling;
      const TileLight& before = in.before[index_of(in.tiles_x, column, row)].light;
      sums.unrest = std::max(sums.unrest, before.unrest);
      sums.startled = std::max(sums.startled, before.startled);
      sums.has_motion_edge = sums.has_motion_edge || tile.reprojection.has_motion_edge;
    }
  }
  return sums;
}

// Whether the whole picture brightens or darkens as one.
template <typename Real>
bool is_relit(const TotalLightOf<Real>& total, bool is_widespread) {
  const Real whole = abs(total.brightening);
  return is_widespread && whole > kWholeCoherent * total.change && whole > kLeastChange * total.light;
}

// Persistence and gain.
template <typename Real>
void relight(const Sums<Real>& sums, const TotalLightOf<Real>& total, bool is_relit,
             const TileLightOf<Real>& before, TileLightOf<Real>& light) {
  const Real relative = sums.brightening / max(sums.light, kLeastLight);
  const Real coherence = abs(sums.brightening) / max(sums.change, kLeastLight);
  const Real samples = sums.count;
  const Real chance = sums.neighbour_error / sqrt(max(samples, 1));
  const int sign = relative > 0 ? 1 : -1;
  const bool agrees = sums.brighter * sign > kAgreement * samples;
  const bool is_coherent = !sums.has_motion_edge && agrees && coherence > kCoherent &&
                           abs(relative) > kLeastChange && abs(sums.brightening) > kAboveChance * chance;
  const Real memory = kMemory;
  light.persistence = memory * before.persistence;
  if (is_coherent) light.persistence += (1 - memory) * sign;
  light.gain = is_coherent && light.persistence * sign > kPersistent ? 1 + relative : Real(1);

  if (is_relit && agrees && relative * total.brightening > 0) {
    const Real whole = total.brightening / total.light;
    const bool is_own = !sums.has_motion_edge && coherence > kOwnCoherent &&
                        abs(relative - whole) > kOwnDifference * abs(whole);
    light.gain = 1 + (is_own ? relative : whole);
  }
  light.gain = clamp(light.gain, 1 / kMostGain, kMostGain);
}

template <typename Real>
Real mean_brightening(const TileEvidenceOf<Real>& evidence) {
  return evidence.brightening / std::max(evidence.count, 1);
}

template <typename Real>
Real update_flicker(const Real& mean_brightening, const TileLightOf<Real>& before) {
  Real alternation = 0;
  if (mean_brightening * before.mean_brightening < 0)
    alternation = min(abs(mean_brightening), abs(before.mean_brightening));
  const Real memory = kFlickerMemory;
  return memory * before.flicker + (1 - memory) * alternation;
}

// History foretells the samples worse than their neighbours do, and not by a change of light.
template <typename Real>
Real suspicion_by_error(const Sums<Real>& sums) {
  if (abs(sums.brightening) >= kIncoherent * sums.history_error) return 0;
  const Real allowed = kWorse * sums.neighbour_error + Real(kErrorFloor) * std::max(sums.count, 1);
  return max((sums.history_error - allowed) / allowed, 0);
}

// The tile's own samples agree that it is brighter or darker now, by more than aliasing has shown so far.
template <typename Real>
Real suspicion_by_change(const TileEvidenceOf<Real>& evidence, const TileLightOf<Real>& light,
                         const Sums<Real>& sums) {
  if (light.gain != 1) return 0;
  const int majority = std::abs(evidence.brighter) - 1;
  if (majority <= 0 || majority * majority < kMajority * evidence.count) return 0;
  if (abs(evidence.brightening) <= kOwnChange * evidence.light) return 0;
  const Real neighbours = sums.neighbour_error / std::max(sums.count, 1);
  const Real usual = kNeighbourShare * neighbours + kFlickerShare * light.flicker + kUsualFloor;
  return max((abs(light.mean_brightening) - usual) / (kChangeRange * usual), 0);
}

// What is left of a suspicion where a second frame must confirm it.
template <typename Real>
Real confirm(const Real& suspected, const Real& before) {
  return max(min(suspected, before) - kConfirmingCost, suspected - kSureAlone);
}

// Suspicions, unrest, and rejection but for a cut.
template <typename Real>
void suspect(const TileEvidenceOf<Real>& evidence, const TileLightOf<Real>& before, const Sums<Real>& sums,
             bool is_still, TileLightOf<Real>& light) {
  const Real error = suspicion_by_error(sums);
  const Real change = suspicion_by_change(evidence, light, sums);
  const int sign = light.mean_brightening < 0 ? -1 : 1;
  const bool is_same_way = before.suspected_change * sign > 0;
  const Real sure_error = confirm(error, before.suspected_error);
  const Real sure_change = confirm(change, is_same_way ? abs(before.suspected_change) : Real(0));
  light.suspected_error = error;
  light.suspected_change = change * sign;
  light.unrest = max(sure_error, sure_change) > 0 ? Real(1) : kUnrestMemory * before.unrest;
  const bool is_calm = is_still && sums.unrest < kCalm;
  light.rejection = clamp(is_calm ? max(sure_error, sure_change) : max(error, change), 0, 1);
}

// Over the whole picture history foretells no better than the neighbours: it shows another picture.
template <typename Real>
Real rejection_by_cut(const TotalLightOf<Real>& total) {
  if (total.history_error <= kCutFloor * total.light) return 0;
  return clamp((total.history_error - kCut * total.neighbour_error) / (kCutRange * total.neighbour_error + 1),
               0, 1);
}

}  // namespace

template <typename Real>
TileLightOf<Real> temporal_light(const LightInputs& in, int x, int y) {
  const auto i = index_of(in.tiles_x, x, y);
  const auto evidence = as<Real>(in.tiles[i].evidence);
  const auto before = as<Real>(in.before[i].light);
  const auto total = as<Real>(in.total);
  const auto sums = sums_around<Real>(in, x, y);
  TileLightOf<Real> light;
  const bool is_widespread = total.changed > kSpread * in.tiles_x * in.tiles_y;
  const bool relit = is_relit(total, is_widespread);
  relight(sums, total, relit, before, light);
  light.mean_brightening = mean_brightening(evidence);
  light.flicker = update_flicker(light.mean_brightening, before);
  suspect(evidence, before, sums, stands_still(in.tiles[i].reprojection), light);
  const Real by_cut = is_widespread && !relit ? rejection_by_cut(total) : Real(0);
  light.rejection = max(light.rejection, by_cut);
  light.cut = max(by_cut, kCutMemory * before.cut);
  light.new_cut = max(by_cut - before.cut, 0);
  light.startled = sums.startling > 0 ? Real(1) : kStartledMemory * before.startled;
  light.holds_back = sums.startling > 0 && Real(sums.startled) < kForgotten && !relit && !(by_cut > 0);
  if (light.holds_back) {
    light.gain = 1;
    light.rejection = 0;
  }
  return light;
}

template TileLightOf<double> temporal_light(const LightInputs&, int, int);
template TileLightOf<Bounded> temporal_light(const LightInputs&, int, int);

}  // namespace quincunx::reference
