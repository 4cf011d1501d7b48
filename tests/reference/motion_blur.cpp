// SPDX-License-Identifier: MIT
// motion_tiles, motion_neighbours, motion_blur: what a shutter would have seen, by the streaks of the surfaces.
// A sample stands for a moment, the fraction f of the shutter's time ago: a surface with the streak s was at the
// pixel p then if it is at p + f s now.
//   nothing moves   the pixel itself
//   all move alike  the mean of the colours at p + f s
//   mixed           the mean over moments of the nearest surface that was at p: one with the longest streak
//                   around, or one with the pixel's own. A surface counts if the streak found there agrees.
#include "motion_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "hash.h"

namespace quincunx::reference {
namespace {

constexpr int kTile = 32;                     // output pixels on either axis
constexpr int kUnits = 64;                    // units of a streak, in an output pixel
constexpr int kLongest = 8 * kTile * kUnits;  // units: longer streaks are cut
constexpr int kSteps = 256;                   // steps of the shutter's time
constexpr float kNearer = 1.01f;              // ratio of depths from which one surface is nearer

int units_of(double velocity, float scale) {
  if (!std::isfinite(velocity)) return 0;
  // One product of two floats, as the input is defined.
  const float streak = static_cast<float>(velocity) * scale;
  return static_cast<int>(std::clamp(streak, -static_cast<float>(kLongest), static_cast<float>(kLongest)));
}

struct Seen {
  Streak streak;
  float depth = 0;
};

Seen seen_at(const BlurInput& input, int x, int y) {
  const Frame& frame = *input.frame;
  const int column = nearest_texel(x, input.output_width, frame.width, frame.jitter_x);
  const int row = nearest_texel(y, input.output_height, frame.height, frame.jitter_y);
  const std::size_t texel = index_of(frame.width, column, row);
  Seen seen;
  seen.streak = {units_of(frame.velocity[texel][0], input.scale[0]),
                 units_of(frame.velocity[texel][1], input.scale[1])};
  const double depth = frame.depth[texel];
  seen.depth = depth > 0 ? static_cast<float>(depth) : 0;
  return seen;
}

int length_of(Streak streak) {
  return std::max(std::abs(streak.x), std::abs(streak.y));
}

bool longer(Streak a, Streak b) {
  const long la = static_cast<long>(a.x) * a.x + static_cast<long>(a.y) * a.y;
  const long lb = static_cast<long>(b.x) * b.x + static_cast<long>(b.y) * b.y;
  if (la != lb) return la > lb;
  return a.x != b.x ? a.x > b.x : a.y > b.y;
}

// The streaks of the pixels of a tile: the longest, and the range of each axis.
struct Range {
  Streak longest;
  Streak least;
  Streak most;

  void add(const Range& other) {
    if (longer(other.longest, longest)) longest = other.longest;
    least = {std::min(least.x, other.least.x), std::min(least.y, other.least.y)};
    most = {std::max(most.x, other.most.x), std::max(most.y, other.most.y)};
  }
  int reach() const { return std::max(length_of(least), length_of(most)); }
};

// Every texel that lies between those that the first and the last pixel of the tile see.
Range range_of(const BlurInput& input, int tile_x, int tile_y) {
  const Frame& frame = *input.frame;
  const auto column = [&](int x) {
    return nearest_texel(x, input.output_width, frame.width, frame.jitter_x);
  };
  const auto row = [&](int y) { return nearest_texel(y, input.output_height, frame.height, frame.jitter_y); };
  const int right = column(std::min((tile_x + 1) * kTile, input.output_width) - 1);
  const int bottom = row(std::min((tile_y + 1) * kTile, input.output_height) - 1);
  Range range;
  bool first = true;
  for (int y = row(tile_y * kTile); y <= bottom; ++y) {
    for (int x = column(tile_x * kTile); x <= right; ++x) {
      const auto& velocity = frame.velocity[index_of(frame.width, x, y)];
      const Streak streak = {units_of(velocity[0], input.scale[0]), units_of(velocity[1], input.scale[1])};
      const Range one = {streak, streak, streak};
      if (first) range = one;
      range.add(one);
      first = false;
    }
  }
  return range.reach() < kUnits / 2 ? Range{} : range;
}

struct Place {
  int x;
  int y;
};

int floor_divide(long value, long divisor) {
  const long quotient = value / divisor;
  return static_cast<int>(value % divisor < 0 ? quotient - 1 : quotient);
}

Place along(const BlurInput& input, Place from, Streak streak, int fraction) {
  const long step = kSteps * kUnits;
  const auto axis = [&](int at, int units, int size) {
    return std::clamp(floor_divide(at * step + step / 2 + static_cast<long>(units) * fraction, step), 0,
                      size - 1);
  };
  return {axis(from.x, streak.x, input.output_width), axis(from.y, streak.y, input.output_height)};
}

bool moves_as(Streak streak, Streak expected) {
  const int away = std::max(std::abs(streak.x - expected.x), std::abs(streak.y - expected.y));
  return away <= kUnits / 2 + length_of(expected) / 4;
}

bool nearer(float a, float b) {
  return a > b * kNearer;
}

// Where the surface that pixel p saw at a moment is now.
Place place_seen(const BlurInput& input, const BlurTile& tile, Place p, int fraction) {
  const Seen own = seen_at(input, p.x, p.y);
  const Place passing = along(input, p, tile.longest, fraction);
  const Place staying = along(input, p, own.streak, fraction);
  const Seen passer = seen_at(input, passing.x, passing.y);
  const Seen stayer = seen_at(input, staying.x, staying.y);
  const bool passes = !moves_as(own.streak, tile.longest) && moves_as(passer.streak, tile.longest);
  const bool stays = moves_as(stayer.streak, own.streak);
  if (passes && (!stays || nearer(passer.depth, stayer.depth))) return passing;
  if (passes || stays || !nearer(stayer.depth, own.depth)) return staying;
  const Place mirrored = along(input, p, {-own.streak.x, -own.streak.y}, fraction);
  return moves_as(seen_at(input, mirrored.x, mirrored.y).streak, own.streak) ? mirrored : p;
}

}  // namespace

std::vector<BlurTile> blur_tiles(const BlurInput& input) {
  const int columns = (input.output_width + kTile - 1) / kTile;
  const int rows = (input.output_height + kTile - 1) / kTile;
  std::vector<Range> ranges;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x)
      ranges.push_back(range_of(input, x, y));
  }
  std::vector<BlurTile> tiles;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const Range own = ranges[static_cast<std::size_t>(y * columns + x)];
      Range all = own;
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          const Range& other = ranges[static_cast<std::size_t>(j * columns + i)];
          const int gap = (std::max(std::abs(i - x), std::abs(j - y)) - 1) * kTile * kUnits;
          if (std::max(own.reach(), other.reach()) > gap) all.add(other);
        }
      }
      BlurTile tile;
      tile.longest = all.longest;
      while (tile.samples < input.most_samples && tile.samples * kUnits < length_of(all.longest))
        tile.samples *= 2;
      const int spread = std::max(all.most.x - all.least.x, all.most.y - all.least.y);
      tile.kind = all.reach() < kUnits / 2 ? 0 : spread <= kUnits / 4 ? 1 : 2;
      tiles.push_back(tile);
    }
  }
  return tiles;
}

Picture motion_blur(const BlurInput& input, const std::vector<Pixel>& resolved) {
  const std::vector<BlurTile> tiles = blur_tiles(input);
  const int columns = (input.output_width + kTile - 1) / kTile;
  Picture picture;
  picture.width = input.output_width;
  picture.height = input.output_height;
  for (int y = 0; y < input.output_height; ++y) {
    for (int x = 0; x < input.output_width; ++x) {
      const BlurTile& tile = tiles[static_cast<std::size_t>(y / kTile * columns + x / kTile)];
      const int samples = tile.kind == 0 ? 1 : tile.samples;
      const int phase = static_cast<int>(random_of(x, y, 0) >> 24);  // 1/256 of the time between two samples
      Pixel sum = {};
      double largest = 0;
      for (int k = 0; k < samples; ++k) {
        const int fraction = (kSteps * k + phase) / samples;
        Place place = {x, y};
        if (tile.kind == 1) place = along(input, place, tile.longest, fraction);
        if (tile.kind == 2) place = place_seen(input, tile, place, fraction);
        const Pixel& colour = resolved[static_cast<std::size_t>(place.y * input.output_width + place.x)];
        for (std::size_t c = 0; c < 4; ++c) {
          sum[c] += colour[c] / samples;
          largest = std::max(largest, std::abs(colour[c]));
        }
      }
      picture.pixels.push_back(sum);
      picture.largest.push_back(largest);
    }
  }
  return picture;
}

}  // namespace quincunx::reference
