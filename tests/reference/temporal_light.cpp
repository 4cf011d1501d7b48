// SPDX-License-Identifier: MIT
// temporal_light: of each tile whether the light has changed, and how far its history is to be rejected. B, L,
// E, N, n: sums of brightening, light, history_error, neighbour_error and count over the tile and the eight
// around it; mean: brightening / count of the tile or cell; b, k: its brighter and count.
//   relative     B / L
//   coherent     |B| > .75 sum |brightening|, |relative| > .05, |B| > 3 N / sqrt(n), no motion edge in the nine
//                tiles, and the samples agree: (sum of b) sign(relative) > .4 n, seven of ten
//   persistence  p <- .6 p, + .4 sign(relative) if coherent
//   gain         1 + relative if coherent and p sign(relative) > .62
//   widespread   more than .2 of all tiles have changed
//   relit        |sum of brightenings| of the whole picture > .8 its change and > .05 its light,
//                and widespread; then at once gain = 1 + that sum / light, where the samples agree on
//                the same sign
//   before       a rigid tile's memory, primed here, is that of the tile, and of the cells, where the middles of it and
//                of its cells were `step` texels ago, clamped to the picture
//   flicker      of a cell: f <- .9 f + .1 a, a the smaller |mean| of this frame and of the previous one where
//                their signs differ, else 0; of a tile: the mean of its cells'
//   rejection    of each cell the largest of three, each within [0, 1]; a suspicion below 0 is 0, and its confirmed
//                part is max(min(s, s') - 1, s - 4), s' that of the previous frame, 0 if of the other sign of mean
//     by error   (E - e) / e, e = 1.6 N + (.002 + 2 f) n, f of the tile, where |B| < .5 E; where it waits its
//                confirmed part
//     by change  (|mean| - T) / (T / 2), of a cell (|mean| - T) / (1.5 T), T = .3 N / n + 6 f + .01, where
//                gain = 1 and (|b| - 1)^2 >= 1.1 k; where it waits its confirmed part; the larger of the tile's and
//                the cell's
//     by cut     (E' - 1.25 N') / (.35 N' + 1) of the whole picture's sums, where E' > .03 L', it is not
//                relit, and the change is widespread
//   confirmation 1 where the confirmed part of any suspicion is above 0, else u <- .97 u
//   recent outliers  1 where one of the nine tiles has outliers, else a <- .9 a
//   holds back   there, if none of the nine had recent outliers >= .15 in the previous frame,
//                and the picture is neither relit nor cut; gain = 1 and rejection = 0 then
//   waits        where the tile is rigid, and in the nine tiles the previous frame's confirmation is below .3
// Source: found by measuring (docs/lab/temporal.md): the gain is worth 4.7 dB on moving light and 6.8 dB on steps
// of the whole picture.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {
namespace {

// Relighting. All are parts of the sums above.
constexpr double kRelightCoherenceMin = .75;
constexpr double kRelightChangeMin = .05;   // part of L
constexpr double kRelightMajorityMin = .4;  // share brighter less share darker: seven of ten; +.02 dB
constexpr double kPersistenceMemory = .6;   // part of persistence that is kept, each frame
constexpr double kPersistenceMin = .62;     // two coherent frames give .4 + .6 * .4 = .64
constexpr double kGainMax = 4;              // and 1 / 4 the least
constexpr double kLightSumMin = 1e-6;       // against a division by 0
constexpr double kWholeCoherenceMin = .8;   // coherence of the whole picture

// Rejection.
constexpr double kErrorRatioMin = 1.6;            // times N: history foretells worse than the neighbours do
constexpr double kErrorFloor = .002;              // for each sample
constexpr double kErrorFlicker = 2;               // times flicker, for each sample
constexpr double kErrorCoherenceMax = .5;         // |B| / E below which the error is no change of light
constexpr double kSignTestMin = 1.1;              // (|b| - 1)^2 / samples: a test of signs
constexpr double kUsualNeighbourError = .3;       // part of the neighbours' mean error, which is usual
constexpr double kUsualFlicker = 6;               // times flicker
constexpr double kUsualChange = .01;              // mean change of luma of a sample
constexpr double kTileChangeRange = .5;           // times what is usual, over which rejection grows to 1
constexpr double kCellChangeRange = 1.5;          // the same of a cell
constexpr double kFlickerMemory = .9;             // each frame: about ten
constexpr double kConfirmationCost = 1;           // taken from the suspicion that two frames share
constexpr double kSingleFrameRejectMin = 4;       // suspicion of one frame that needs no other
constexpr double kConfirmationMemory = .97;       // each frame
constexpr double kRigidTileConfirmationMax = .3;  // below it a rigid tile waits for a second frame
constexpr double kCutRatioMin = 1.25;   // E / N of the whole picture from which on it may be another one
constexpr double kCutRatioRange = .35;  // times N, over which rejection grows to 1
constexpr double kCutErrorMin = .03;    // part of the whole picture's light
constexpr double kCutMemory = .9;       // each frame: what seems another picture in each of them has no cut
constexpr double kWholeChangedTilesMin = .2;  // part of all tiles: fewer are not the whole picture

// Outliers.
constexpr double kOutlierMemory = .9;     // each frame
constexpr double kOutlierRearmMax = .15;  // after 18 frames

template <typename Real>
struct Sums {
  Real brightening = 0, change = 0, light = 0, history_error = 0, neighbour_error = 0;
  int count = 0;
  int brighter = 0;
  int outliers = 0;
  double confirmation = 0, recent_outliers = 0;  // the most
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
      sums.outliers += tile.evidence.outliers;
      const TileLight& before = in.before[index_of(in.tiles_x, column, row)].light;
      sums.confirmation = std::max(sums.confirmation, before.confirmation);
      sums.recent_outliers = std::max(sums.recent_outliers, before.recent_outliers);
      sums.has_motion_edge = sums.has_motion_edge || tile.reprojection.has_motion_edge;
    }
  }
  return sums;
}

// Whether the whole picture brightens or darkens as one.
template <typename Real>
bool is_relit(const TotalLightOf<Real>& total, bool is_widespread) {
  const Real whole = abs(total.brightening);
  return is_widespread && whole > kWholeCoherenceMin * total.change &&
         whole > kRelightChangeMin * total.light;
}

// Persistence and gain.
template <typename Real>
void relight(const Sums<Real>& sums, const TotalLightOf<Real>& total, bool is_relit,
             const TileLightOf<Real>& before, TileLightOf<Real>& light) {
  const Real relative = sums.brightening / max(sums.light, kLightSumMin);
  const Real coherence = abs(sums.brightening) / max(sums.change, kLightSumMin);
  const Real samples = sums.count;
  const int sign = relative > 0 ? 1 : -1;
  const bool agrees = sums.brighter * sign > kRelightMajorityMin * samples;
  const bool is_coherent = !sums.has_motion_edge && agrees && coherence > kRelightCoherenceMin &&
                           abs(relative) > kRelightChangeMin;
  const Real memory = kPersistenceMemory;
  light.persistence = memory * before.persistence;
  if (is_coherent) light.persistence += (1 - memory) * sign;
  light.gain = is_coherent && light.persistence * sign > kPersistenceMin ? 1 + relative : Real(1);

  if (is_relit && agrees && relative * total.brightening > 0)
    light.gain = 1 + total.brightening / total.light;
  light.gain = clamp(light.gain, 1 / kGainMax, kGainMax);
}

// History foretells the samples worse than their neighbours do, and not by a change of light.
template <typename Real>
Real suspicion_by_error(const Sums<Real>& sums, const Real& flicker) {
  if (abs(sums.brightening) >= kErrorCoherenceMax * sums.history_error) return 0;
  const Real usual = kErrorFloor + kErrorFlicker * flicker;
  const Real allowed = kErrorRatioMin * sums.neighbour_error + usual * std::max(sums.count, 1);
  return max((sums.history_error - allowed) / allowed, 0);
}

// How much change is usual of a tile or cell.
template <typename Real>
Real usual_change(const Sums<Real>& sums, const Real& flicker) {
  return kUsualNeighbourError * (sums.neighbour_error / std::max(sums.count, 1)) + kUsualFlicker * flicker +
         kUsualChange;
}

// The samples of a tile or cell agree that it is brighter or darker now, by more than aliasing has shown so far. With
// the sign of the change.
template <typename Real, typename Evidence>
Real suspicion_by_change(const Evidence& evidence, const Real& usual, double range) {
  const int majority = std::abs(evidence.brighter) - 1;
  if (majority <= 0 || majority * majority < kSignTestMin * evidence.count) return 0;
  const Real mean = evidence.brightening / std::max(evidence.count, 1);
  const Real suspected = max((abs(mean) - usual) / (range * usual), 0);
  return mean < 0 ? -suspected : suspected;
}

// A cell that is not rejected.
template <typename Real>
CellLightOf<Real> cell_light(const CellEvidenceOf<Real>& evidence, const CellLightOf<Real>& before,
                             const Sums<Real>& sums) {
  CellLightOf<Real> cell;
  cell.mean_brightening = evidence.brightening / std::max(evidence.count, 1);
  Real alternation = 0;
  if (cell.mean_brightening * before.mean_brightening < 0)
    alternation = min(abs(cell.mean_brightening), abs(before.mean_brightening));
  const Real memory = kFlickerMemory;
  cell.flicker = memory * before.flicker + (1 - memory) * alternation;
  cell.suspected_change = suspicion_by_change(evidence, usual_change(sums, cell.flicker), kCellChangeRange);
  return cell;
}

// Returns the rest of a suspicion where a second frame must confirm it.
template <typename Real>
Real confirm(const Real& suspected, const Real& before) {
  return max(min(suspected, before) - kConfirmationCost, suspected - kSingleFrameRejectMin);
}

// The same of a change, with its sign: the previous frame's counts if it went the same way.
template <typename Real>
Real confirm_change(const Real& suspected, const Real& before) {
  return confirm(abs(suspected), suspected * before > 0 ? abs(before) : Real(0));
}

// Suspicions, their confirmation, and rejection. Where the light has changed, a change is no suspicion.
template <typename Real>
void suspect(const TileEvidenceOf<Real>& evidence, const TileLightOf<Real>& before, const Sums<Real>& sums,
             bool is_rigid, const Real& by_cut, TileLightOf<Real>& light) {
  Real flicker = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    light.cells[i] = cell_light(evidence.cells[i], before.cells[i], sums);
    flicker += .25 * light.cells[i].flicker;
    if (light.gain != 1) light.cells[i].suspected_change = 0;
  }
  light.suspected_error = suspicion_by_error(sums, flicker);
  if (light.gain == 1)
    light.suspected_change = suspicion_by_change(evidence, usual_change(sums, flicker), kTileChangeRange);

  const bool waits = is_rigid && sums.confirmation < kRigidTileConfirmationMax;
  const auto sure_of = [](const auto& now, const auto& then) {
    return confirm_change(now.suspected_change, then.suspected_change);
  };
  const Real sure = max(confirm(light.suspected_error, before.suspected_error), sure_of(light, before));
  const Real by_tile = max(waits ? sure : max(light.suspected_error, abs(light.suspected_change)), by_cut);
  Real surest = sure;
  for (std::size_t i = 0; i < 4; ++i) {
    CellLightOf<Real>& cell = light.cells[i];
    const Real sure_of_cell = sure_of(cell, before.cells[i]);
    surest = max(surest, sure_of_cell);
    cell.rejection = clamp(max(by_tile, waits ? sure_of_cell : abs(cell.suspected_change)), 0, 1);
    light.rejection = max(light.rejection, cell.rejection);
  }
  light.confirmation = surest > 0 ? Real(1) : kConfirmationMemory * before.confirmation;
}

// Over the whole picture history foretells no better than the neighbours: it shows another picture.
template <typename Real>
Real rejection_by_cut(const TotalLightOf<Real>& total) {
  if (total.history_error <= kCutErrorMin * total.light) return 0;
  return clamp((total.history_error - kCutRatioMin * total.neighbour_error) /
                   (kCutRatioRange * total.neighbour_error + 1),
               0, 1);
}

// The index of the place, of `count` places of `size` pixels on an axis, where the middle of place i was.
int place_before(int i, int size, int step, int count) {
  const int middle = i * size + size / 2 - step;
  return std::clamp(middle, 0, count * size - 1) / size;
}

// What is remembered of a tile, from where it was.
TileLight memory_of(const LightInputs& in, int x, int y) {
  const auto& step = in.tiles[index_of(in.tiles_x, x, y)].reprojection.step;
  const auto light_at = [&](int column, int row) -> const TileLight& {
    return in.before[index_of(in.tiles_x, column, row)].light;
  };
  TileLight light =
      light_at(place_before(x, kTile, step[0], in.tiles_x), place_before(y, kTile, step[1], in.tiles_y));
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const int from_x = place_before(2 * x + column, kTile / 2, step[0], 2 * in.tiles_x);
      const int from_y = place_before(2 * y + row, kTile / 2, step[1], 2 * in.tiles_y);
      light.cells[static_cast<std::size_t>(2 * row + column)] =
          light_at(from_x / 2, from_y / 2).cells[static_cast<std::size_t>(from_y % 2 * 2 + from_x % 2)];
    }
  }
  return light;
}

}  // namespace

template <typename Real>
TileLightOf<Real> temporal_light(const LightInputs& in, int x, int y) {
  const auto i = index_of(in.tiles_x, x, y);
  const auto evidence = as<Real>(in.tiles[i].evidence);
  const auto before = as<Real>(memory_of(in, x, y));
  const auto total = as<Real>(in.total);
  const auto sums = sums_around<Real>(in, x, y);
  TileLightOf<Real> light;
  const bool is_widespread = total.changed > kWholeChangedTilesMin * in.tiles_x * in.tiles_y;
  const bool relit = is_relit(total, is_widespread);
  relight(sums, total, relit, before, light);
  const Real by_cut = is_widespread && !relit ? rejection_by_cut(total) : Real(0);
  suspect(evidence, before, sums, in.tiles[i].reprojection.is_rigid, by_cut, light);
  light.cut = max(by_cut, kCutMemory * before.cut);
  light.new_cut = max(by_cut - before.cut, 0);
  light.recent_outliers = sums.outliers > 0 ? Real(1) : kOutlierMemory * before.recent_outliers;
  light.holds_back =
      sums.outliers > 0 && Real(sums.recent_outliers) < kOutlierRearmMax && !relit && !(by_cut > 0);
  if (light.holds_back) {
    light.gain = 1;
    light.rejection = 0;
    for (CellLightOf<Real>& cell : light.cells)
      cell.rejection = 0;
  }
  return light;
}

template TileLightOf<double> temporal_light(const LightInputs&, int, int);
template TileLightOf<Bounded> temporal_light(const LightInputs&, int, int);

}  // namespace quincunx::reference
