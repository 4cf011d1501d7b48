// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "temporal.h"

namespace quincunx::reference {
namespace {

constexpr double kRigid = .05;   // output pixels that the samples of a rigid tile may differ by
constexpr double kNoEdge = .1;   // output pixels of contrast that change nothing
constexpr double kEdge = .15;    // and that begin to make history doubtful
constexpr double kStill = 1e-4;  // output pixels that count as none
constexpr double kTrusted = .9;  // samples less sure of their history do not judge it
constexpr double kKnown = .1;    // nor do they judge history of less confidence
constexpr double kNoise = .01;   // of brightness, that says nothing
constexpr double kLargestHalf = 65504;

struct Range {
  int first = 0;
  int last = 0;
};

// The samples whose centres lie in a tile; at least one, the nearest.
Range samples_in(int tile, double spacing, double jitter, int count, bool& undecided) {
  const Bounded start = rounded((.5 + jitter) * spacing);
  const auto index = [&](double corner) {
    return decide((corner - start) / rounded(spacing),
                  [&](double at) { return static_cast<int>(std::clamp(std::ceil(at), -1.0, count + 1.0)); },
                  undecided);
  };
  const int first = std::clamp(index(tile * kTile), 0, count - 1);
  return {first, std::clamp(index((tile + 1) * kTile) - 1, first, count - 1)};
}

int tile_of(const Bounded& at, int count, bool& undecided) {
  return decide(
      at,
      [&](double place) { return static_cast<int>(std::clamp(std::floor(place / kTile), 0.0, count - 1.0)); },
      undecided);
}

bool on_screen(const std::array<Bounded, 2>& at, const TemporalInputs& in, bool& undecided) {
  return !less(at[0], 0, undecided) && !less(at[1], 0, undecided) &&
         less(at[0], in.output_width, undecided) && less(at[1], in.output_height, undecided);
}

// Of the samples in both ranges.
struct Moves {
  std::array<double, 2> least = {1e9, 1e9};
  std::array<double, 2> most = {-1e9, -1e9};
  double contrast = 0;
  bool known = true;
  bool trusted = true;  // wholly
};

Moves moves_in(const TemporalInputs& in, Range columns, Range rows) {
  Moves moves;
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const Move& move = in.move_of(x, y);
      moves.known = moves.known && !std::isnan(move.trust);
      moves.trusted = moves.trusted && move.trust == 1;
      moves.contrast = std::max(moves.contrast, std::abs(move.contrast));
      moves.least = {std::min(moves.least[0], move.x), std::min(moves.least[1], move.y)};
      moves.most = {std::max(moves.most[0], move.x), std::max(moves.most[1], move.y)};
    }
  }
  return moves;
}

// Makes a tile rigid if all samples in both ranges move alike.
void follow(Tile& tile, const TemporalInputs& in, Range columns, Range rows, int tile_x, int tile_y) {
  const Moves found = moves_in(in, columns, rows);
  tile.torn = less(rounded(kEdge), found.contrast, tile.undecided);
  if (!found.known) return;
  std::array<Bounded, 2> move;
  std::array<Bounded, 2> source;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Bounded scale = rounded(in.move_scale(static_cast<int>(axis)));
    if (less(rounded(kRigid), (Bounded(found.most[axis]) - Bounded(found.least[axis])) * scale,
             tile.undecided))
      return;
    move[axis] = Bounded(.5) * (Bounded(found.most[axis]) + Bounded(found.least[axis])) * scale;
    if (less(abs(move[axis]), rounded(kStill), tile.undecided)) move[axis] = 0;
    source[axis] = Bounded((axis == 0 ? tile_x : tile_y) * kTile + kTile / 2) + move[axis];
  }
  const Tile& from = in.tile_before(tile_of(source[0], in.tiles_x(), tile.undecided),
                                    tile_of(source[1], in.tiles_y(), tile.undecided));
  tile.rigid = true;
  tile.plain = found.trusted && !less(rounded(kNoEdge), found.contrast, tile.undecided);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    tile.source[axis] = from.offset[axis].value;
    const Bounded place = tile.source[axis] - move[axis];
    tile.step[axis] = floor_of(place + .5, tile.undecided);
    tile.offset[axis] = place - tile.step[axis];
  }
}

Bounded luma(const Pixel& c) {
  return max(Bounded(.25) * (Bounded(c[0]) + c[2]) + Bounded(.5) * c[1], 0);
}

const Pixel& sample_at(const TemporalInputs& in, int x, int y) {
  return texel_at(in.frame, std::clamp(x, 0, in.frame.width - 1), std::clamp(y, 0, in.frame.height - 1));
}

// How far the mean of the four neighbours is from a sample; 0 where it is not valid.
Bounded neighbour_difference(const TemporalInputs& in, int x, int y, const Bounded& own) {
  Pixel mean = {};
  const std::array<const Pixel*, 4> around = {&sample_at(in, x - 1, y), &sample_at(in, x + 1, y),
                                              &sample_at(in, x, y - 1), &sample_at(in, x, y + 1)};
  for (std::size_t c = 0; c < 4; ++c)
    mean[c] = .25 * ((*around[0])[c] + (*around[1])[c] + (*around[2])[c] + (*around[3])[c]);
  if (!is_valid(mean)) return 0;
  Bounded value = luma(mean);
  value.error += 4 * kUnit * std::abs(value.value);  // three sums, then a luma
  return abs(own - value);
}

// Where what the sample shows was; false: it does not judge.
bool place_before(const Tile& tile, const TemporalInputs& in, int x, int y, std::array<Bounded, 2>& at,
                  bool& unsure) {
  const std::array<int, 2> sample = {x, y};
  const std::array<double, 2> jitter = {in.frame.jitter_x, in.frame.jitter_y};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double spacing = in.spacing(static_cast<int>(axis));
    at[axis] = Bounded(sample[axis]) * rounded(spacing) + rounded((.5 + jitter[axis]) * spacing);
    if (tile.rigid) at[axis] = at[axis] - (tile.offset[axis] + tile.step[axis]);
  }
  if (!in.moves.empty()) {
    const Move& move = in.move_of(x, y);
    if (!(move.trust > kTrusted)) return false;
    if (!tile.rigid) {
      at[0] = at[0] + Bounded(move.x) * rounded(in.move_scale(0));
      at[1] = at[1] + Bounded(move.y) * rounded(in.move_scale(1));
      const Tile& from =
          in.tile_before(tile_of(at[0], in.tiles_x(), unsure), tile_of(at[1], in.tiles_y(), unsure));
      at = {at[0] - from.offset[0], at[1] - from.offset[1]};
    }
  }
  return on_screen(at, in, unsure);
}

void judge(Tile& tile, const TemporalInputs& in, int x, int y) {
  std::array<Bounded, 2> at;
  if (!place_before(tile, in, x, y, at, tile.unsure)) return;
  const Pixel& before = in.history_at(floor_of(at[0], tile.unsure), floor_of(at[1], tile.unsure));
  const Pixel& sample = sample_at(in, x, y);
  if (before[3] < kKnown || !is_valid(sample)) return;
  const Bounded own = luma(sample);
  const Bounded known = luma(before);
  const Bounded scale = Bounded(1) / (Bounded(1) + own + known);
  const Bounded change = (own - known) * scale;
  tile.brightening = tile.brightening + change;
  tile.light = tile.light + known * scale;
  tile.history_error = tile.history_error + abs(change);
  tile.neighbour_error = tile.neighbour_error + neighbour_difference(in, x, y, own) * scale;
  if (less(rounded(kNoise), change, tile.unsure)) ++tile.brighter;
  if (less(change, -rounded(kNoise), tile.unsure)) --tile.brighter;
  ++tile.samples;
}

}  // namespace

bool is_valid(const Pixel& sample) {
  return std::all_of(sample.begin(), sample.end(), [](double c) { return std::abs(c) < kLargestHalf; });
}

const Tile& TemporalInputs::tile_before(int tile_x, int tile_y) const {
  const int x = std::clamp(tile_x, 0, tiles_x() - 1);
  const int y = std::clamp(tile_y, 0, tiles_y() - 1);
  return before[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_x()) +
                static_cast<std::size_t>(x)];
}

std::vector<Tile> temporal_tiles(const TemporalInputs& in) {
  std::vector<Tile> tiles;
  const int width = in.frame.width;
  const int height = in.frame.height;
  for (int tile_y = 0; tile_y < in.tiles_y(); ++tile_y) {
    for (int tile_x = 0; tile_x < in.tiles_x(); ++tile_x) {
      Tile tile;
      const Range columns = samples_in(tile_x, in.spacing(0), in.frame.jitter_x, width, tile.undecided);
      const Range rows = samples_in(tile_y, in.spacing(1), in.frame.jitter_y, height, tile.undecided);
      if (in.moves.empty()) {
        tile.rigid = tile.plain = true;
      } else {
        follow(tile, in, {std::max(columns.first - 1, 0), std::min(columns.last + 1, width - 1)},
               {std::max(rows.first - 1, 0), std::min(rows.last + 1, height - 1)}, tile_x, tile_y);
      }
      for (int y = rows.first; y <= rows.last; ++y) {
        for (int x = columns.first; x <= columns.last; ++x) {
          if ((x + in.judged_apart / 2 * y) % in.judged_apart == 0) judge(tile, in, x, y);
        }
      }
      tiles.push_back(tile);
    }
  }
  return tiles;
}

}  // namespace quincunx::reference
