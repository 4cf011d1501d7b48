// SPDX-License-Identifier: MIT
// temporal_light against its reference, on tiles of any findings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "expected.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using reference::Tile;

struct Findings {
  Extent count;
  std::vector<Tile> before, tiles;
  TotalLight total{};
};

class Finder {
 public:
  Findings find(int round) {
    Findings found;
    found.count = round % 3 == 0 ? Extent{1, 1} : round % 3 == 1 ? Extent{5, 3} : Extent{33, 17};
    const double lean = round % 4 == 0 ? 1 : uniform() - .5;  // how far changes agree
    for (int i = 0; i < found.count.width * found.count.height; ++i)
      add_tile(found, round, lean);
    for (LagTotal& part : found.total.lags)
      part = lag(round % 2 == 0 ? .002 : round % 8 == 1 ? .3 : .1);
    return found;
  }

 private:
  double uniform() { return uniform_(random_); }
  float below(double limit) { return static_cast<float>(limit * uniform()); }

  // Sums of a part of the picture, up to `most` of its light; now and then without evidence.
  LagTotal lag(double most) {
    if (uniform() < .1) return {};
    const auto below_int = [&](double limit) { return static_cast<int>(limit * uniform()); };
    const int lit = 100'000 + below_int(200'000);
    const double relative = most * (uniform() - .3);
    return {.lag = static_cast<int>(relative * lit),
            .lit = lit,
            .usual_lag = static_cast<int>(relative * (2 * uniform() - .2) * lit),
            .usual_lit = below_int(1. * lit)};
  }

  void add_tile(Findings& found, int round, double lean) {
    testing::KernelTile tile{};
    tile.light = below(30);
    tile.history_error = below(round % 4 == 1 ? 30 : 10);
    tile.neighbour_error = below(6);
    tile.count = static_cast<float>(1 + static_cast<int>(15 * uniform()));
    tile.brighter = static_cast<float>(
        std::lround(static_cast<double>(tile.count) * std::clamp(2 * lean + uniform() - .5, -1.0, 1.0)));
    tile.brightening = tile.history_error * static_cast<float>(lean + .5 * uniform() - .25);
    if (uniform() < .2) {  // changes on its own, all over
      tile.brighter = std::copysign(tile.count, tile.brighter);
      tile.brightening = std::copysign(tile.history_error, tile.brighter);
    }
    for (CellEvidence& cell : tile.TileEvidence::cells) {
      cell.count = static_cast<float>(static_cast<int>(6 * uniform()));
      cell.brighter = std::copysign(uniform() < .5 ? cell.count : 1.f, tile.brightening);
      cell.brightening = std::copysign(cell.count * below(.6), cell.brighter);
    }
    tile.has_motion_edge = round % 7 < 3 && uniform() < .1 ? 1 : 0;
    tile.is_rigid = found.tiles.size() % 5 == 0 ? 0 : 1;
    if (tile.is_rigid == 1 && round % 2 == 0) {
      tile.step_x = static_cast<int>(std::lround(60 * uniform() - 30));
      tile.step_y = static_cast<int>(std::lround(30 * uniform() - 15));
    }
    if (uniform() < .008) tile.outliers = static_cast<float>(1 + found.tiles.size() % 3);
    add_to_total(found.total, tile, round);
    found.tiles.push_back(testing::to_reference(tile));
    tile.persistence = static_cast<float>(2 * uniform() - 1);
    tile.trend = static_cast<float>(.02 * uniform() - .01);
    if (uniform() < .5) tile.brightening *= static_cast<float>(-2 * uniform());
    for (CellLight& cell : tile.TileLight::cells) {
      cell.flicker = uniform() < .5 ? below(.01) : below(.2);
      cell.mean_brightening = std::copysign(below(.5), static_cast<float>(uniform() - .5));
      cell.drift = std::copysign(below(1), cell.mean_brightening);
      if (round % 2 == 0) cell.suspicion = std::copysign(below(1), cell.mean_brightening);
    }
    if (found.tiles.size() % 11 == 0) tile.confirmation = std::abs(tile.persistence);
    if (uniform() < .03) tile.recent_outliers = std::abs(tile.persistence);
    found.before.push_back(testing::to_reference(tile));
  }

  static void add_to_total(TotalLight& total, const testing::KernelTile& tile, int round) {
    total.light += static_cast<int>(tile.light * 40);
    // A cut would hide why single tiles are rejected.
    total.history_error += static_cast<int>(tile.history_error * (round % 4 == 1 ? 40 : 4));
    total.neighbour_error += static_cast<int>(tile.neighbour_error * 40);
    if (round % 5 != 0 || total.changed == 0) ++total.changed;
  }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

reference::LightInputs inputs_of(const Findings& found) {
  const auto number = [](int value) { return static_cast<double>(value); };
  const TotalLight& total = found.total;
  reference::LightInputs in{
      found.count.width,
      found.count.height,
      found.before,
      found.tiles,
      {number(total.light), number(total.history_error), number(total.neighbour_error), total.changed, {}}};
  for (std::size_t i = 0; i < in.total.lags.size(); ++i) {
    const LagTotal& part = total.lags[i];
    in.total.lags[i] = {number(part.lag), number(part.lit), number(part.usual_lag), number(part.usual_lit)};
  }
  return in;
}

std::vector<reference::TileLight> lights_of(const Findings& found) {
  const reference::LightInputs in = inputs_of(found);
  std::vector<reference::TileLight> lights;
  for (int y = 0; y < in.tiles_y; ++y) {
    for (int x = 0; x < in.tiles_x; ++x)
      lights.push_back(reference::temporal_light<double>(in, x, y));
  }
  return lights;
}

// The same, had there been another flicker.
std::vector<reference::TileLight> with_flicker(Findings found, double flicker) {
  for (Tile& tile : found.before) {
    for (reference::CellLightOf<double>& cell : tile.light.cells)
      cell.flicker = flicker;
  }
  return lights_of(found);
}

// The same, did history not lag behind, and had it not.
std::vector<reference::TileLight> without_lag(Findings found) {
  for (LagTotal& part : found.total.lags)
    part = {};
  for (Tile& tile : found.before)
    tile.light.trend = 0;
  return lights_of(found);
}

std::vector<reference::TileLight> with_edges(Findings found, bool all) {
  for (Tile& tile : found.tiles)
    tile.reprojection.has_motion_edge = all;
  return lights_of(found);
}

std::vector<reference::TileLight> with_confirmation(Findings found, double confirmation) {
  for (Tile& tile : found.before)
    tile.light.confirmation = confirmation;
  return lights_of(found);
}

// The same, had no cell drifted.
std::vector<reference::TileLight> without_drift(Findings found) {
  for (Tile& tile : found.before) {
    for (reference::CellLightOf<double>& cell : tile.light.cells)
      cell.drift = 0;
  }
  return lights_of(found);
}

std::vector<reference::TileLight> with_spread(Findings found) {
  found.total.changed = found.count.width * found.count.height;
  return lights_of(found);
}

bool some_cell_differs(const reference::TileLight& one, const reference::TileLight& other) {
  const auto same = [](const auto& a, const auto& b) { return a.rejection == b.rejection; };
  return !std::equal(one.cells.begin(), one.cells.end(), other.cells.begin(), same);
}

// How many tiles meet what: each finding is taken away to see what it changes.
struct Met {
  int tiles = 0, decided = 0, relit = 0, rejected = 0;
  int gain_held_back = 0;  // by a motion edge
  int broad = 0;           // which motion edges do not hold back
  int explained = 0;       // rejected otherwise, were it not for the broad gain
  int spared = 0;          // from a cut, as the whole picture is relit
  int alternating = 0, of_flicker = 0, of_drift = 0, of_one_cell = 0;
  int confirmed = 0, hidden_by_waiting = 0;
  int held_back = 0, not_rearmed = 0, not_widespread = 0;

  template <typename Expected>
  void add(const Findings& found, const std::vector<Expected>& expected) {
    const std::vector<reference::TileLight> joined = with_edges(found, false),
                                            edged = with_edges(found, true), even = with_flicker(found, 0),
                                            wild = with_flicker(found, 1e6), sudden = without_drift(found),
                                            confirmed_lately = with_confirmation(found, 1),
                                            spread = with_spread(found), even_light = without_lag(found);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double gain = expected[i].value.gain, rejection = expected[i].value.rejection;
      ++tiles;
      if (expected[i].undecided) continue;
      ++decided;
      relit += even_light[i].gain != 1 ? 1 : 0;
      rejected += rejection > 0 ? 1 : 0;
      gain_held_back += gain != joined[i].gain ? 1 : 0;
      broad += edged[i].gain != 1 ? 1 : 0;
      spared += expected[i].value.new_cut < even_light[i].new_cut ? 1 : 0;
      explained += some_cell_differs(expected[i].value, even_light[i]) ? 1 : 0;
      alternating += even[i].cells[0].flicker > 0 ? 1 : 0;
      of_flicker += rejection != wild[i].rejection ? 1 : 0;
      of_one_cell += rejection > expected[i].value.cells[0].rejection ? 1 : 0;
      of_drift += some_cell_differs(expected[i].value, sudden[i]) ? 1 : 0;
      confirmed += expected[i].value.confirmation == 1 ? 1 : 0;
      hidden_by_waiting += rejection < confirmed_lately[i].rejection ? 1 : 0;
      held_back += expected[i].value.holds_back ? 1 : 0;
      not_rearmed += found.tiles[i].evidence.outliers > 0 && !expected[i].value.holds_back ? 1 : 0;
      not_widespread += rejection != spread[i].rejection ? 1 : 0;
    }
  }
};

void expect_near(double expected, const reference::Bounded& bound, float actual, const std::string& what) {
  ASSERT_NEAR(expected, bound.value, 1e-12 * std::max(1.0, std::abs(expected))) << what;
  ASSERT_NEAR(expected, static_cast<double>(actual), bound.error) << what;
}

TEST(TemporalLight, MatchesTheReference_small) {
  const testing::TemporalStages stages({});
  Finder finder;
  Met met;
  for (int round = 0; round < 84; ++round) {
    const Findings found = finder.find(round);
    const reference::LightInputs in = inputs_of(found);
    const auto expected = testing::expected_pixels(
        in.tiles_x, in.tiles_y,
        [&]<typename Real>(Real, int x, int y) { return reference::temporal_light<Real>(in, x, y); });
    const auto actual = stages.run_light(found.count, found.before, found.total, found.tiles);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto& [value, bound, undecided] = expected[i];
      const std::string what = fmt::format("round {}, tile {}: ", round, i);
      for (std::size_t c = 0; c < 4; ++c) {
        const auto& cell = value.cells[c];
        const auto& limit = bound.cells[c];
        const CellLight& found_cell = actual[i].cells[c];
        const std::string where = fmt::format("{}cell {}: ", what, c);
        expect_near(cell.flicker, limit.flicker, found_cell.flicker, where + "flicker");
        expect_near(cell.mean_brightening, limit.mean_brightening, found_cell.mean_brightening,
                    where + "mean");
        expect_near(cell.drift, limit.drift, found_cell.drift, where + "drift");
        if (undecided) continue;
        expect_near(cell.suspicion, limit.suspicion, found_cell.suspicion, where + "suspicion");
        expect_near(cell.rejection, limit.rejection, found_cell.rejection, where + "rejection");
      }
      if (undecided) continue;
      expect_near(value.gain, bound.gain, actual[i].gain, what + "gain");
      expect_near(value.rejection, bound.rejection, actual[i].rejection, what + "rejection");
      expect_near(value.trend, bound.trend, actual[i].trend, what + "trend");
      expect_near(value.cut, bound.cut, actual[i].cut, what + "cut");
      expect_near(value.new_cut, bound.new_cut, actual[i].new_cut, what + "new cut");
      expect_near(value.persistence, bound.persistence, actual[i].persistence, what + "persistence");
      expect_near(value.confirmation, bound.confirmation, actual[i].confirmation, what + "confirmation");
      expect_near(value.recent_outliers, bound.recent_outliers, actual[i].recent_outliers,
                  what + "recent_outliers");
      EXPECT_EQ(value.holds_back, actual[i].holds_back != 0) << what << "holds back";
      if (HasFatalFailure()) return;
    }
    met.add(found, expected);
  }
  EXPECT_GE(met.decided, met.tiles * 9 / 10);
  EXPECT_GT(met.relit, met.tiles / 20);
  EXPECT_GT(met.rejected, met.tiles / 20);
  EXPECT_GT(met.gain_held_back, met.tiles / 100);
  EXPECT_GT(met.broad, met.tiles / 2);
  EXPECT_GT(met.explained, met.tiles / 100);
  EXPECT_GT(met.spared, met.tiles / 100);
  EXPECT_GT(met.alternating, met.tiles / 20);
  EXPECT_GT(met.of_flicker, met.tiles / 100);
  EXPECT_GT(met.of_drift, met.tiles / 100);
  EXPECT_GT(met.confirmed, met.tiles / 100);
  EXPECT_GT(met.hidden_by_waiting, met.tiles / 100);
  EXPECT_GT(met.of_one_cell, met.tiles / 100);
  EXPECT_GT(met.held_back, met.tiles / 100);
  EXPECT_GT(met.not_rearmed, met.tiles / 1000);
  EXPECT_GT(met.not_widespread, met.tiles / 100);
}

}  // namespace
}  // namespace quincunx
