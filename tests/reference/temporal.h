// SPDX-License-Identifier: MIT
// What the kernels of the temporal upscaler should give, each on its own, in double precision, and how far
// single precision may be from it.
#pragma once

#include <array>
#include <vector>

#include "bounded.h"
#include "reproject.h"

namespace quincunx::reference {

constexpr int kTile = 8;  // output pixels

using BoundedPixel = std::array<Bounded, 4>;

inline BoundedPixel exact(const Pixel& pixel) {
  return {pixel[0], pixel[1], pixel[2], pixel[3]};
}

// How the texels of a tile take history over, and what is known of it. Given to a stage the numbers are
// exact.
struct Tile {
  std::array<Bounded, 2> offset = {};
  std::array<double, 2> source = {};
  std::array<int, 2> step = {};
  bool rigid = false;
  bool plain = false;  // rigid, all samples are trusted, and there is no edge of motion
  bool torn = false;   // there is an edge of motion that makes history doubtful
  Bounded brightening, light, history_error, neighbour_error;
  Bounded persistence, flicker, doubt;
  Bounded gain = 1;
  int samples = 0;   // that were judged
  int brighter = 0;  // how many are brighter than history by more than noise, less those that are darker
  bool undecided = false;  // a rounding may decide how history is taken over
  bool unsure = false;     // or which texels, or what to believe
};

struct TotalLight {
  double brightening = 0, change = 0, light = 0, history_error = 0, neighbour_error = 0;
};

// What one frame meets.
struct TemporalInputs {
  Frame frame;  // colour, jitter
  int previous_width = 0;
  int previous_height = 0;
  std::vector<Move> moves;              // of each sample of the frame; empty: nothing moves
  std::vector<double> reactive_before;  // of the previous viewport, where frame.reactive counts
  int output_width = 0;
  int output_height = 0;
  std::vector<Pixel> history;  // of each output pixel: red, green, blue and confidence
  std::vector<Tile> before;    // of the previous frame
  int judged_apart = 2;        // of how many samples one judges history: 2 or 4

  int tiles_x() const { return (output_width + kTile - 1) / kTile; }
  int tiles_y() const { return (output_height + kTile - 1) / kTile; }
  double spacing(int axis) const {
    return axis == 0 ? static_cast<double>(output_width) / frame.width
                     : static_cast<double>(output_height) / frame.height;
  }
  // From moves to output pixels.
  double move_scale(int axis) const {
    return axis == 0 ? static_cast<double>(output_width) / previous_width
                     : static_cast<double>(output_height) / previous_height;
  }
  const Move& move_of(int x, int y) const {
    return moves[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                 static_cast<std::size_t>(x)];
  }
  const Pixel& history_at(int x, int y) const {
    return history[static_cast<std::size_t>(y) * static_cast<std::size_t>(output_width) +
                   static_cast<std::size_t>(x)];
  }
  // The outermost tile beyond the edges.
  const Tile& tile_before(int tile_x, int tile_y) const;
};

// Whether a sample takes part: finite, and less than the largest half.
bool is_valid(const Pixel& sample);

std::vector<Tile> temporal_tiles(const TemporalInputs& in);

// Completes the tiles.
void temporal_light(int tiles_x, int tiles_y, const std::vector<Tile>& before, const TotalLight& total,
                    std::vector<Tile>& tiles);

struct TemporalOptions {
  int taps = 16;                // of history; 4: bilinear
  bool bilinear_trust = false;  // else the nearest sample's
};

struct HistoryTexel {
  BoundedPixel value;
  bool undecided = false;  // a rounding may decide what it is made of
};

std::vector<HistoryTexel> resolve_temporal(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                           const TemporalOptions& options);

struct DisplayOptions {
  bool smooth = true;
  bool alpha = true;  // bilinear, of the frame; else 1
};

std::vector<HistoryTexel> temporal_display(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                           const DisplayOptions& options);

// (1 - t / 8)^8
Bounded bell(const Bounded& t);

}  // namespace quincunx::reference
