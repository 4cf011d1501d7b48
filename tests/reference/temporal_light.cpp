// SPDX-License-Identifier: MIT
// temporal_light: of each tile whether the light has changed, and how far its history is to be rejected. B, L,
// E, N, n: sums of brightening, light, history_error, neighbour_error and count over the tile and the eight
// around it; mean: brightening / count of the tile or cell; b, k: its brighter and count.
//   relative     B / L
//   coherent     |B| > .75 sum |brightening|, |relative| > .05, |B| > 3 N / sqrt(n), no motion edge in the nine
//                tiles, and the samples agree: (sum of b) sign(relative) > .4 n, seven of ten
//   persistence  p <- .6 p, + .4 sign(relative) if coherent
//   agreement    of sums over some of the picture's 4 x 3 parts: usual_lag / (.005 lit)
//   lag          m = lag / lit, u = usual_lag / max(usual_lit, .25 d^2 lit), each of sums over 3 x 3 of the parts,
//                weighted by a quadratic B-spline, d = max(1 - (2 agreement)^2, 0); if both have the same sign:
//                m min(1, (u / m)^2)
//   change       t + e min(max(|e| / .02, .2), 1), e = lag - t; the trend of the place, t <- t + .02 e, with e in +-.05
//   gain         1 + relative if coherent and p sign(relative) > .62, else 1 + change if |change| > .0005, else 1
//   widespread   more than .2 of all tiles have changed
//   relit        of all parts |agreement| > .8 and |lag / lit| > .05, both with the same sign; and widespread
//   before       a rigid tile's memory, primed here, is that of the tile, and of the cells, where the middles of it and
//                of its cells were `step` texels ago, clamped to the picture
//   flicker      of a cell: f <- .9 f + .1 a, a the smaller |mean| of this frame and of the previous one where
//                their signs differ, else 0; of a tile: the mean of its cells'
//   drift        of a cell: d <- .7 d + mean
//   rejection    of each cell the larger of two, within [0, 1]
//     judged     where the gain is not by relative, and |mean| > 4 f: the network of judge_weights.h, of a cell's
//                inputs as judge_cell() lists them, in units of u = N / n + .02 and turned to the sign of its mean.
//                Brightenings are less what the broad gain explains: change times the tile's mean light a sample
//     waits      where the tile is rigid and the nine tiles' confirmation was below .3, max(2 min(s, s') - 1, 0) in
//                place of s, s and s' of what was judged in this frame and in the previous one; 0 if the signs of their
//                means differ
//     by cut     (E' - 1.25 N') / (.35 N' + 1) of the whole picture's sums, where E' > .03 L', it is not
//                relit, and the change is widespread
//   confirmation 1 where 2 min(s, s') - 1 > 0 in a cell, else u <- .97 u
//   recent outliers  1 where one of the nine tiles has outliers, else a <- .9 a
//   holds back   there, if none of the nine had recent outliers >= .15 in the previous frame,
//                and the picture is neither relit nor cut; gain by change, and rejection = 0 then, and cells keep what
//                they remembered
// Source: found by measuring (docs/lab/temporal.md): the gain is worth 4.7 dB on moving light and 6.8 dB on steps
// of the whole picture, the broad one .4 to 2.3 dB on light that drifts.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"
#include "temporal/judge_weights.h"

namespace quincunx::reference {
namespace {

// Relighting. All are parts of the sums above.
constexpr double kRelightCoherenceMin = .75;
constexpr double kRelightChangeMin = .05;   // part of L
constexpr double kRelightMajorityMin = .4;  // share brighter less share darker: seven of ten; +.02 dB
constexpr double kPersistenceMemory = .6;   // part of persistence that is kept, each frame
constexpr double kPersistenceMin = .62;     // two coherent frames give .4 + .6 * .4 = .64
constexpr double kGainMax = 4;              // and 1 / 4 the least
constexpr double kLagAtOnce = .02;          // part of the light: of less a part is corrected
constexpr double kUsualLagMax = .005;       // of a tile's light
constexpr double kLagAgreementMin = .5;     // beyond doubt
constexpr double kLagDoubt = .25;   // part of the light that at least lags less, where one way is as likely
constexpr double kLagTiles = 64;    // of no lag beside those of a part, over the fourth power of their number
constexpr double kLagPartMin = .2;  // each frame
constexpr double kTrendPart = .02;  // part of the surprise that is learnt, each frame
constexpr double kTrendSurpriseMax = .05;  // part of the light
constexpr double kGainChangeMin = .0005;   // part of the light
constexpr double kLightSumMin = 1e-6;      // against a division by 0
constexpr double kWholeAgreementMin = .8;  // of the whole picture

// Rejection.
constexpr double kJudgeErrorFloor = .02;          // added to the neighbours' mean error, the unit of changes
constexpr double kJudgeInputMax = 8;              // of each input's magnitude
constexpr double kFlickerMemory = .9;             // each frame: about ten
constexpr double kConfirmationMemory = .97;       // each frame
constexpr double kRigidTileConfirmationMax = .3;  // below it a rigid tile waits for a second frame
constexpr double kDriftMemory = .7;               // each frame
constexpr double kJudgedChangeMin = .002;         // |mean| and |drift|: both at most this are no change
constexpr double kFlickerRatioMin = 4;            // |mean| / flicker: less is no change
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

// How far tiles agree about the sign of a lag.
template <typename Real>
Real agreement_of(const LagTotalOf<Real>& sum) {
  return sum.usual_lag / (kUsualLagMax * max(sum.lit, 1));
}

template <typename Real>
void add(LagTotalOf<Real>& sum, double weight, const LagTotalOf<Real>& part) {
  sum.lag += weight * part.lag;
  sum.lit += weight * part.lit;
  sum.usual_lag += weight * part.usual_lag;
  sum.usual_lit += weight * part.usual_lit;
}

// Whether the whole picture brightens or darkens as one.
template <typename Real>
bool is_relit(const TotalLightOf<Real>& total, bool is_widespread) {
  LagTotalOf<Real> sum;
  for (const LagTotalOf<Real>& part : total.lags)
    add(sum, 1, part);
  return is_widespread && sum.lag * sum.usual_lag > 0 && abs(agreement_of(sum)) > kWholeAgreementMin &&
         abs(sum.lag) > kRelightChangeMin * sum.lit;
}

// The gain of a coherent change, which persists; 1 without.
template <typename Real>
Real local_gain(const Sums<Real>& sums, const TileLightOf<Real>& before, TileLightOf<Real>& light) {
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
  const bool persists = is_coherent && light.persistence * sign > kPersistenceMin;
  return persists ? clamp(1 + relative, 1 / kGainMax, kGainMax) : Real(1);
}

// A quadratic B-spline: what the part of a picture counts at `place`, in parts from its edge.
double part_weight(int part, double place) {
  const double away = std::abs(place - part - .5);
  if (away >= 1.5) return 0;
  return away <= .5 ? .75 - away * away : .5 * (1.5 - away) * (1.5 - away);
}

template <typename Real>
LagTotalOf<Real> lags_around(const LightInputs& in, const TotalLightOf<Real>& total, int x, int y) {
  LagTotalOf<Real> sum;
  for (int row = 0; row < kLagRows; ++row) {
    for (int column = 0; column < kLagColumns; ++column) {
      const double weight = part_weight(column, (x + .5) * kLagColumns / in.tiles_x) *
                            part_weight(row, (y + .5) * kLagRows / in.tiles_y);
      if (weight == 0) continue;
      add(sum, weight, total.lags[index_of(kLagColumns, column, row)]);
    }
  }
  return sum;
}

// How many units of LagTotal a tile's light has.
double lag_units(const LightInputs& in) {
  return std::min(65536., 0x1p28 / ((in.tiles_x / kLagColumns + 1) * (in.tiles_y / kLagRows + 1)));
}

// How far history lags behind.
template <typename Real>
Real lag_of(const LagTotalOf<Real>& sum, double units) {
  if (!(sum.lag * sum.usual_lag > 0)) return 0;
  const Real tiles = sum.lit / units;
  const Real mean = sum.lag / max(sum.lit, 1);
  const Real agreed = agreement_of(sum) / kLagAgreementMin, doubt = max(1 - agreed * agreed, 0);
  const Real without = max(sum.usual_lit, kLagDoubt * doubt * doubt * sum.lit);
  const Real usual = sum.usual_lag / max(without, units * kLagTiles / (tiles * tiles * tiles * tiles));
  return abs(mean) > abs(usual) ? usual * usual / mean : mean;
}

// The broad gain by what is around a tile; learns the trend. Without evidence nothing changes.
template <typename Real>
Real broad_gain(const LagTotalOf<Real>& sum, double units, const Real& trend, TileLightOf<Real>& light) {
  light.trend = trend;
  if (!(sum.lit > 0)) return Real(1);
  const Real surprise = lag_of(sum, units) - trend;
  const Real change = trend + surprise * clamp(abs(surprise) / kLagAtOnce, kLagPartMin, 1);
  light.trend = trend + kTrendPart * clamp(surprise, -kTrendSurpriseMax, kTrendSurpriseMax);
  return abs(change) > kGainChangeMin ? clamp(1 + change, 1 / kGainMax, kGainMax) : Real(1);
}

// A cell that is not rejected. `explained`: what the broad gain makes of each sample's brightening.
template <typename Real>
CellLightOf<Real> cell_light(const CellEvidenceOf<Real>& evidence, const Real& explained,
                             const CellLightOf<Real>& before) {
  CellLightOf<Real> cell;
  cell.mean_brightening = (evidence.brightening - explained * evidence.count) / std::max(evidence.count, 1);
  Real alternation = 0;
  if (cell.mean_brightening * before.mean_brightening < 0)
    alternation = min(abs(cell.mean_brightening), abs(before.mean_brightening));
  const Real memory = kFlickerMemory;
  cell.flicker = memory * before.flicker + (1 - memory) * alternation;
  cell.drift = kDriftMemory * before.drift + cell.mean_brightening;
  return cell;
}

// The network: rejection, not clamped.
template <typename Real>
Real judge(const std::array<Real, JUDGE_INPUTS>& inputs) {
  constexpr std::array<float, JUDGE_INPUTS* JUDGE_HIDDEN> weights = {JUDGE_INPUT_WEIGHTS};
  constexpr std::array<float, JUDGE_HIDDEN> biases = {JUDGE_BIASES}, of_hidden = {JUDGE_OUTPUT_WEIGHTS};
  Real rejection = static_cast<double>(JUDGE_OUTPUT_BIAS);
  for (std::size_t h = 0; h < biases.size(); ++h) {
    Real hidden = static_cast<double>(biases[h]);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      hidden += clamp(inputs[i], -kJudgeInputMax, kJudgeInputMax) *
                static_cast<double>(weights[i * JUDGE_HIDDEN + h]);
    rejection += max(hidden, 0) * static_cast<double>(of_hidden[h]);
  }
  return rejection;
}

// That of cell (x, y) of the picture.
template <typename Real>
Real judge_cell(const LightInputs& in, int x, int y, const Sums<Real>& sums, const CellLightOf<Real>& now,
                const CellLightOf<Real>& before, const Real& tile_flicker, const Real& explained) {
  const auto cell_at = [&](int column, int row) -> CellEvidenceOf<Real> {
    if (column < 0 || row < 0 || column >= 2 * in.tiles_x || row >= 2 * in.tiles_y) return {};
    const Tile& tile = in.tiles[index_of(in.tiles_x, column / 2, row / 2)];
    CellEvidenceOf<Real> cell =
        as<Real>(tile.evidence).cells[static_cast<std::size_t>(row % 2 * 2 + column % 2)];
    cell.brightening = cell.brightening - explained * cell.count;
    return cell;
  };
  const auto mean_at = [&](int column, int row) {
    const CellEvidenceOf<Real> cell = cell_at(column, row);
    return cell.brightening / std::max(cell.count, 1);
  };
  CellEvidenceOf<Real> around{};
  for (int row = y - 1; row <= y + 1; ++row) {
    for (int column = x - 1; column <= x + 1; ++column) {
      const CellEvidenceOf<Real> cell = cell_at(column, row);
      around.brightening += cell.brightening;
      around.brighter += cell.brighter;
      around.count += cell.count;
    }
  }
  const int sign = now.mean_brightening < 0 ? -1 : 1;
  const auto line = [&](int dx, int dy) {
    return sign * (mean_at(x - dx, y - dy) + mean_at(x, y) + mean_at(x + dx, y + dy)) / 3;
  };
  const Real longest = max(max(line(1, 1), line(0, 1)), max(line(-1, 1), line(1, 0)));

  const CellEvidenceOf<Real> own = cell_at(x, y);
  const auto tile = as<Real>(in.tiles[index_of(in.tiles_x, x / 2, y / 2)].evidence);
  const auto mean_of = [](const Real& sum, int count) { return sum / std::max(count, 1); };
  const Real unit = mean_of(sums.neighbour_error, sums.count) + kJudgeErrorFloor;
  const Real majority = sign * own.brighter, majority_around = sign * around.brighter;
  return judge<Real>({abs(now.mean_brightening) / unit,
                      sign * mean_of(around.brightening, around.count) / unit, longest / unit,
                      sign * before.mean_brightening / unit, sign * before.drift / unit, now.flicker / unit,
                      tile_flicker / unit, mean_of(tile.history_error, tile.count) / unit,
                      mean_of(sums.history_error, sums.count) / unit, mean_of(majority, own.count),
                      mean_of(majority_around, around.count), unit, abs(now.mean_brightening),
                      mean_of(tile.neighbour_error, tile.count) / unit, Real(own.count)});
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
  const Real broad =
      broad_gain<Real>(lags_around(in, total, x, y), lag_units(in), in.before[i].light.trend, light);
  const Real local = local_gain(sums, before, light);
  light.gain = local == 1 ? broad : local;
  const Real explained = (broad - 1) * evidence.light / std::max(evidence.count, 1);
  const Real by_cut = is_widespread && !relit ? rejection_by_cut(total) : Real(0);
  Real flicker = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    light.cells[c] = cell_light(evidence.cells[c], explained, before.cells[c]);
    flicker += .25 * light.cells[c].flicker;
  }
  const bool waits = in.tiles[i].reprojection.is_rigid && Real(sums.confirmation) < kRigidTileConfirmationMax;
  light.confirmation = kConfirmationMemory * before.confirmation;
  for (int c = 0; c < 4; ++c) {
    const auto n = static_cast<std::size_t>(c);
    CellLightOf<Real>& cell = light.cells[n];
    const Real change = abs(cell.mean_brightening);
    Real judged = 0;
    const bool has_changed = max(change, abs(cell.drift)) > kJudgedChangeMin;
    if (local == 1 && has_changed && change > kFlickerRatioMin * cell.flicker) {
      judged =
          clamp(judge_cell(in, 2 * x + c % 2, 2 * y + c / 2, sums, cell, before.cells[n], flicker, explained),
                0, 1);
    }
    cell.suspicion = cell.mean_brightening < 0 ? -judged : judged;
    const Real suspected = before.cells[n].suspicion;
    Real sure = 0;
    if (cell.suspicion * suspected > 0) sure = max(2 * min(judged, abs(suspected)) - 1, 0);
    if (sure > 0) light.confirmation = 1;
    cell.rejection = clamp(max(waits ? sure : judged, by_cut), 0, 1);
    light.rejection = max(light.rejection, cell.rejection);
  }
  light.cut = max(by_cut, kCutMemory * before.cut);
  light.new_cut = max(by_cut - before.cut, 0);
  light.recent_outliers = sums.outliers > 0 ? Real(1) : kOutlierMemory * before.recent_outliers;
  light.holds_back =
      sums.outliers > 0 && Real(sums.recent_outliers) < kOutlierRearmMax && !relit && !(by_cut > 0);
  if (light.holds_back) {
    light.gain = broad;
    light.rejection = 0;
    light.cells = before.cells;
    for (CellLightOf<Real>& cell : light.cells)
      cell.rejection = 0;
  }
  return light;
}

template TileLightOf<double> temporal_light(const LightInputs&, int, int);
template TileLightOf<Bounded> temporal_light(const LightInputs&, int, int);

}  // namespace quincunx::reference
