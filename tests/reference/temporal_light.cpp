// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {
namespace {

struct Sums {
  Bounded brightening, change, light, history_error, neighbour_error;
  double samples = 0;
  double brighter = 0;
  bool torn = false;
};

Sums sums_around(const std::vector<Tile>& tiles, int tiles_x, int tiles_y, int x, int y) {
  Sums sums;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, tiles_y - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, tiles_x - 1); ++column) {
      const Tile& tile = tiles[static_cast<std::size_t>(row * tiles_x + column)];
      sums.brightening = sums.brightening + tile.brightening;
      sums.change = sums.change + abs(tile.brightening);
      sums.light = sums.light + tile.light;
      sums.history_error = sums.history_error + tile.history_error;
      sums.neighbour_error = sums.neighbour_error + tile.neighbour_error;
      sums.samples += tile.samples;
      sums.brighter += tile.brighter;
      sums.torn = sums.torn || tile.torn;
    }
  }
  return sums;
}

Bounded exact_count(double count) {
  return rounded(count);  // an int beyond 2^24 is rounded
}

// Where the whole picture brightens or darkens: by how much, of its light.
bool whole_changes(const TotalLight& total, bool& unsure) {
  const Bounded whole = abs(exact_count(total.brightening));
  return less(rounded(.8) * exact_count(total.change), whole, unsure) &&
         less(rounded(.05) * exact_count(total.light), whole, unsure);
}

void judge_light(Tile& tile, const Sums& sums, const Tile& before, const TotalLight& total) {
  const Bounded relative = sums.brightening / max(sums.light, rounded(1e-6));
  const Bounded coherence = abs(sums.brightening) / max(sums.change, rounded(1e-6));
  bool sign_unsure = false;
  const double sign = less(0, relative, sign_unsure) ? 1 : -1;
  const Bounded chance = sums.neighbour_error / sqrt(Bounded(std::max(sums.samples, 1.0)));
  const bool agreed = less(rounded(.4) * sums.samples, sums.brighter * sign, tile.unsure);
  const bool hit = !sums.torn && agreed && less(rounded(.75), coherence, tile.unsure) &&
                   less(rounded(.05), abs(relative), tile.unsure) &&
                   less(Bounded(3) * chance, abs(sums.brightening), tile.unsure);
  tile.persistence = rounded(.6) * before.persistence;
  if (hit) tile.persistence = tile.persistence + (Bounded(1) - rounded(.6)) * sign;
  Bounded gain = 1;
  if (hit && less(rounded(.62), tile.persistence * sign, tile.unsure)) gain = Bounded(1) + relative;
  const Bounded whole = exact_count(total.brightening);
  const bool same_sign = relative.value * whole.value > 0;
  if (whole_changes(total, tile.unsure)) tile.unsure = tile.unsure || sign_unsure;
  if (whole_changes(total, tile.unsure) && agreed && same_sign) {
    const Bounded everywhere = whole / exact_count(total.light);
    const bool own = !sums.torn && less(.5, coherence, tile.unsure) &&
                     less(rounded(.3) * abs(everywhere), abs(relative - everywhere), tile.unsure);
    gain = Bounded(1) + (own ? relative : everywhere);
  }
  tile.gain = clamp(gain, .25, 4);
}

Bounded mean_brightening(const Tile& tile) {
  return tile.brightening / Bounded(std::max(tile.samples, 1));
}

// By how much a sample brightens and darkens in turn.
Bounded reversal(const Tile& tile, const Tile& before, bool& unsure) {
  if (!less(tile.brightening * before.brightening, 0, unsure)) return 0;
  return min(abs(mean_brightening(tile)), abs(mean_brightening(before)));
}

// Of a tile whose gain is 1 while more of its samples have become brighter, or darker, than chance gives.
Bounded doubt_of_change(Tile& tile, const Bounded& neighbour_error) {
  if (less(0, abs(tile.gain - 1), tile.unsure)) return 0;
  const double majority = std::abs(tile.brighter) - 1;
  if (majority <= 0 || majority * majority < 1.1 * tile.samples) return 0;
  if (!less(rounded(.15) * tile.light, abs(tile.brightening), tile.unsure)) return 0;
  const Bounded usual = rounded(.8) * neighbour_error + Bounded(12) * tile.flicker + rounded(.01);
  return clamp((abs(mean_brightening(tile)) - usual) / (Bounded(.5) * usual), 0, 1);
}

// Of a picture that history foretells no better than the neighbours: it is another one.
Bounded doubt_of_cut(const TotalLight& total, bool& unsure) {
  if (whole_changes(total, unsure)) return 0;
  const Bounded error = exact_count(total.history_error);
  const Bounded allowed = exact_count(total.neighbour_error);
  if (!less(rounded(.03) * exact_count(total.light), error, unsure)) return 0;
  return clamp((error - rounded(.95) * allowed) / (Bounded(.25) * allowed + 1), 0, 1);
}

}  // namespace

void temporal_light(int tiles_x, int tiles_y, const std::vector<Tile>& before, const TotalLight& total,
                    std::vector<Tile>& tiles) {
  const std::vector<Tile> given = tiles;
  for (int y = 0; y < tiles_y; ++y) {
    for (int x = 0; x < tiles_x; ++x) {
      const auto i = static_cast<std::size_t>(y * tiles_x + x);
      const Sums sums = sums_around(given, tiles_x, tiles_y, x, y);
      Tile& tile = tiles[i];
      judge_light(tile, sums, before[i], total);
      tile.flicker = rounded(.9) * before[i].flicker +
                     (Bounded(1) - rounded(.9)) * reversal(tile, before[i], tile.unsure);
      const Bounded allowed = rounded(1.6) * sums.neighbour_error + rounded(.02);
      Bounded doubt = 0;
      if (less(abs(sums.brightening), Bounded(.5) * sums.history_error, tile.unsure))
        doubt = clamp((sums.history_error - allowed) / allowed, 0, 1);
      const Bounded around = sums.neighbour_error / Bounded(std::max(sums.samples, 1.0));
      tile.doubt = max(max(doubt, doubt_of_change(tile, around)), doubt_of_cut(total, tile.unsure));
    }
  }
}

}  // namespace quincunx::reference
