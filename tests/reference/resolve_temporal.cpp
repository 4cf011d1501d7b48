// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "history_sampling.h"

namespace quincunx::reference {
namespace {

constexpr double kMost = 32;          // confidence that is ever kept
constexpr double kMostResampled = 8;  // and once resampled
constexpr double kStart = .15;        // confidence of what a frame alone shows
constexpr double kReach = 1.05;       // output pixels, from where on a sample counts nothing
constexpr double kLeastReach = .85;   // in a still tile
constexpr double kBoxSize = .75;      // standard deviations
constexpr double kFalloff = 2.5;      // of the Gaussian: 1 / (2 sigma^2), samples
constexpr double kSameMotion = .15;   // output pixels a frame
constexpr double kInertia = .85;      // of a Gaussian alone
constexpr double kBoxMargin = .02;    // of confidence

struct Place {
  int nearest = 0;  // sample
  Bounded past;     // how far the place lies past it, in samples
  Bounded at;       // the place, held among the samples
};

// Where an output pixel's picture lies among the samples; of what lies outside the nearest is the outermost.
Place place_of(int x, int output, int render, double jitter, const Bounded& offset, bool& undecided) {
  const double u = (x + .5) * render / output - .5 - jitter;
  const double whole = std::floor(u);
  const Bounded sum = rounded(u - whole) + offset / rounded(static_cast<double>(output) / render);
  const Bounded place{sum.value + whole, sum.error};
  const Bounded at = clamp(place, 0, render - 1);
  const int nearest = decide(
      at, [](double held) { return static_cast<int>(std::ceil(held - .5)); }, undecided);
  return {nearest, place - nearest, at};
}

Bounded smooth_step(const Bounded& x, double low, double high) {
  const Bounded t = clamp((x - rounded(low)) * rounded(1 / (high - low)), 0, 1);
  return t * t * (Bounded(3) - Bounded(2) * t);
}

Bounded largest_colour(const BoundedPixel& c) {
  return max(max(c[0], c[1]), max(c[2], 0));
}

const Pixel& sample_at(const Frame& frame, int x, int y) {
  return texel_at(frame, std::clamp(x, 0, frame.width - 1), std::clamp(y, 0, frame.height - 1));
}

// How far the sample (x, y) may show the same surface as the sample (own_x, own_y), by its motion.
Bounded similarity(const TemporalInputs& in, int own_x, int own_y, int x, int y) {
  if (in.moves.empty()) return 1;
  const Move& own = in.move_of(own_x, own_y);
  const Move& other = in.move_of(std::clamp(x, 0, in.frame.width - 1), std::clamp(y, 0, in.frame.height - 1));
  const auto apart = [&](double from, double to, int axis) {
    return (Bounded(to) - Bounded(from)) * rounded(in.move_scale(axis)) * (Bounded(1) / rounded(kSameMotion));
  };
  const Bounded across = apart(own.x, other.x, 0);
  const Bounded down = apart(own.y, other.y, 1);
  return max(Bounded(1) - across * across - down * down, 0x1p-10);
}

struct Pixels {
  BoundedPixel colour;  // of history; its fourth is not used
  Bounded confidence;
  Bounded doubt;
  Bounded inertia;  // of what began anew, against this frame's sample
};

Bounded most_confidence(const Bounded& trust) {
  return trust / (Bounded(1 + 1 / kMost) - trust);
}

Bounded weigh(const Taken& taken, const Bounded& trust, const Bounded& contrast, bool& undecided) {
  Bounded w = clamp(taken.value[3], 0, kMost);
  w = w / (Bounded(1) + rounded(.2) * taken.between * w);
  if (less(rounded(.01), taken.between, undecided)) w = min(w, kMostResampled);
  w = min(w, most_confidence(trust));
  return w / (Bounded(1) + Bounded(4) * smooth_step(contrast, .1, 1) * w);
}

// Between tiles: on a row linear between the means of neighbours at their common edge, over rows between
// middles.
Bounded between_tiles(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y,
                      Bounded Tile::*what) {
  const auto edge = [&](int column, int row) {
    const auto tile = [&](int i) {
      return tiles[static_cast<std::size_t>(row * in.tiles_x() + std::clamp(i, 0, in.tiles_x() - 1))].*what;
    };
    return Bounded(.5) * (tile(column - 1) + tile(column));
  };
  const int middle = y - kTile / 2;
  const int above = std::max(middle, 0) / kTile;
  const int below = std::min(above + 1, in.tiles_y() - 1);
  const Bounded down = middle < 0 ? 0 : (middle % kTile + .5) / kTile;
  const auto at_edge = [&](int column) {
    const Bounded upper = edge(column, above);
    return upper + (edge(column, below) - upper) * down;
  };
  const Bounded left = at_edge(x / kTile);
  const Bounded along = (x % kTile + .5) / kTile;
  return left + (at_edge(x / kTile + 1) - left) * along;
}

BoundedPixel to_tone(const BoundedPixel& colour) {
  const Bounded scale = Bounded(1) + largest_colour(colour);
  return {colour[0] / scale, colour[1] / scale, colour[2] / scale, 0};
}

struct Box {
  BoundedPixel mean, deviation;
  bool any = false;
};

Box box_at(const Frame& frame, int x, int y) {
  const int cross[][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  Box box;
  BoundedPixel first, sum, squares;
  double count = 0;
  for (const auto& step : cross) {
    const Pixel& sample = sample_at(frame, x + step[0], y + step[1]);
    if (!is_valid(sample)) continue;
    const BoundedPixel tone = to_tone(exact(sample));
    if (count == 0) first = tone;
    for (std::size_t c = 0; c < 3; ++c) {
      const Bounded difference = count == 0 ? Bounded(0) : tone[c] - first[c];
      sum[c] = sum[c] + difference;
      squares[c] = squares[c] + difference * difference;
    }
    ++count;
  }
  box.any = count > 0;
  for (std::size_t c = 0; c < 3 && box.any; ++c) {
    const Bounded mean = sum[c] / count;
    box.mean[c] = first[c] + mean;
    box.deviation[c] = Bounded(kBoxSize) * sqrt(max(squares[c] / count - mean * mean, 0));
  }
  return box;
}

// Towards what the surroundings allow; confidence falls by how wrong history was.
void rectify(Pixels& pixel, const Box& box) {
  if (!box.any) return;
  BoundedPixel tone = to_tone(pixel.colour);
  Bounded distance = 0;
  Bounded spread = 0;
  bool stays = true;
  for (std::size_t c = 0; c < 3; ++c) {
    const Bounded low = box.mean[c] - box.deviation[c];
    const Bounded high = box.mean[c] + box.deviation[c];
    spread = spread + box.deviation[c];
    bool unsure = false;
    if (!less(tone[c], low, unsure) && !less(high, tone[c], unsure) && !unsure) continue;
    stays = false;
    const Bounded step = clamp(tone[c], low, high) - tone[c];
    distance = distance + abs(step);
    tone[c] = tone[c] + step * pixel.doubt;
  }
  const Bounded wrong = min(1, distance / (spread + rounded(kBoxMargin)));
  pixel.confidence = pixel.confidence * (Bounded(1) - pixel.doubt * wrong);
  if (stays) return;
  const Bounded rest = max(Bounded(1) - largest_colour(tone), 0x1p-16);
  for (std::size_t c = 0; c < 3; ++c)
    pixel.colour[c] = tone[c] / rest;
}

struct Smooth {
  BoundedPixel colour;
  bool any = false;  // valid sample is near enough
};

// A Gaussian of the frame's samples that move alike.
Smooth smooth_at(const TemporalInputs& in, const Place& column, const Place& row, bool& undecided) {
  BoundedPixel sum, stand_in;
  Bounded weights = 0;
  Smooth smooth;
  for (int i = 0; i < 9; ++i) {
    const int dx = i % 3 - 1;
    const int dy = i / 3 - 1;
    const int x = column.nearest + dx;
    const int y = row.nearest + dy;
    const Pixel& sample = sample_at(in.frame, x, y);
    if (!is_valid(sample)) {
      for (std::size_t c = 0; c < 3; ++c)
        stand_in[c] = stand_in[c] + Bounded(sanitised(sample[c])) * rounded(1. / 9);
      continue;
    }
    const Bounded across = Bounded(dx) - column.past;
    const Bounded down = Bounded(dy) - row.past;
    const Bounded near = bell((across * across + down * down) * kFalloff);
    const Bounded weight = near / max(1, Bounded(.5) * largest_colour(exact(sample))) *
                           similarity(in, column.nearest, row.nearest, x, y);
    weights = weights + weight;
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] = sum[c] + Bounded(sample[c]) * weight;
  }
  smooth.any = less(0, weights, undecided);
  for (std::size_t c = 0; c < 3; ++c)
    smooth.colour[c] = smooth.any ? sum[c] / weights : stand_in[c];
  return smooth;
}

// The less confident, the more of a Gaussian of the frame.
void start(Pixels& pixel, const TemporalInputs& in, const Place& column, const Place& row, bool& undecided) {
  if (pixel.confidence.value - pixel.confidence.error >= kStart) return;
  const Smooth smooth = smooth_at(in, column, row, undecided);
  const Bounded share = max(Bounded(1) - pixel.confidence / rounded(kStart), 0);
  for (std::size_t c = 0; c < 3; ++c)
    pixel.colour[c] = pixel.colour[c] + (smooth.colour[c] - pixel.colour[c]) * share;
  pixel.inertia = rounded(kInertia) * share;
  if (!smooth.any) less(pixel.confidence, rounded(kStart), undecided);
  pixel.confidence = smooth.any ? max(pixel.confidence, rounded(kStart)) : Bounded(0);
}

HistoryTexel add_sample(const Pixels& pixel, const Pixel& sample, bool still,
                        const std::array<Bounded, 2>& away) {
  HistoryTexel texel;
  Bounded weight = 0;
  if (is_valid(sample)) {
    const Bounded reach =
        still ? max(rounded(kReach) - rounded(.1) * pixel.confidence, rounded(kLeastReach)) : rounded(kReach);
    const Bounded near = max(Bounded(1) - (away[0] * away[0] + away[1] * away[1]) / (reach * reach), 0);
    weight = near * near / max(1, Bounded(.5) * largest_colour(exact(sample)));
  }
  const Bounded total = pixel.confidence + weight;
  const Bounded part =
      weight.value == 0 && weight.error == 0 ? Bounded(0) : weight / max(total + pixel.inertia, 1e-30);
  for (std::size_t c = 0; c < 3; ++c) {
    const Bounded& before = pixel.colour[c];
    texel.value[c] = is_valid(sample) ? before + (Bounded(sample[c]) - before) * part : before;
  }
  texel.value[3] = min(total, kMost);
  return texel;
}

double known_trust(const Move& move) {
  return std::isnan(move.trust) ? 0 : std::max(move.trust, 0.0);
}

// Between samples.
Bounded trust_between(const TemporalInputs& in, const Bounded& at_x, const Bounded& at_y) {
  const int x = std::clamp(static_cast<int>(std::floor(at_x.value)), 0, std::max(in.frame.width - 2, 0));
  const int y = std::clamp(static_cast<int>(std::floor(at_y.value)), 0, std::max(in.frame.height - 2, 0));
  const int right = std::min(x + 1, in.frame.width - 1);
  const int below = std::min(y + 1, in.frame.height - 1);
  const Bounded fx = at_x - x;
  const Bounded fy = at_y - y;
  const auto on_row = [&](int row) {
    return Bounded(known_trust(in.move_of(x, row))) * (Bounded(1) - fx) +
           Bounded(known_trust(in.move_of(right, row))) * fx;
  };
  return on_row(y) * (Bounded(1) - fy) + on_row(below) * fy;
}

// Of the still sample (x, y), by the reactive values of both frames.
Bounded trust_of_still(const TemporalInputs& in, int x, int y, bool& undecided) {
  if (in.frame.reactive.empty()) return 1;
  const auto before = [&](int sample, int size, int size_before) {
    return decide((Bounded(sample) + .5) * rounded(static_cast<double>(size_before) / size),
                  [&](double at) { return std::min(static_cast<int>(at), size_before - 1); }, undecided);
  };
  const int column = before(x, in.frame.width, in.previous_width);
  const int row = before(y, in.frame.height, in.previous_height);
  const double now = in.frame.reactive[static_cast<std::size_t>(y * in.frame.width + x)];
  const double then = in.reactive_before[static_cast<std::size_t>(row * in.previous_width + column)];
  return (Bounded(1) - rounded(now)) * (Bounded(1) - rounded(then));
}

Bounded trust_at(const TemporalInputs& in, const TemporalOptions& options, const Place& column,
                 const Place& row, bool& undecided) {
  if (in.moves.empty()) return trust_of_still(in, column.nearest, row.nearest, undecided);
  if (options.bilinear_trust) return trust_between(in, column.at, row.at);
  return known_trust(in.move_of(column.nearest, row.nearest));
}

HistoryTexel resolve(const TemporalInputs& in, const std::vector<Tile>& tiles, const TemporalOptions& options,
                     int x, int y) {
  const Frame& frame = in.frame;
  const Tile& tile = tiles[static_cast<std::size_t>(y / kTile * in.tiles_x() + x / kTile)];
  bool undecided = false;
  const Place column = place_of(x, in.output_width, frame.width, frame.jitter_x, tile.offset[0], undecided);
  const Place row = place_of(y, in.output_height, frame.height, frame.jitter_y, tile.offset[1], undecided);
  Move move{.trust = 1};
  if (!in.moves.empty()) move = in.move_of(column.nearest, row.nearest);
  const Bounded trust = trust_at(in, options, column, row, undecided);

  const double contrast = std::abs(move.contrast);
  const Taken taken = take_history(in, tile, move, x, y, options, undecided);
  Pixels pixel{taken.value, weigh(taken, trust, contrast, undecided),
               max(Bounded(1) - trust, smooth_step(contrast, .15, .6)), 0};
  const Bounded changed = between_tiles(in, tiles, x, y, &Tile::doubt);
  pixel.doubt = max(pixel.doubt, changed);
  pixel.confidence = min(pixel.confidence, most_confidence(Bounded(1) - changed));
  const Bounded gain = between_tiles(in, tiles, x, y, &Tile::gain);
  for (Bounded& value : pixel.colour)
    value = value * gain;
  if (pixel.doubt.value + pixel.doubt.error > 0) rectify(pixel, box_at(frame, column.nearest, row.nearest));
  start(pixel, in, column, row, undecided);

  const bool still = tile.rigid && tile.offset[0].value == 0 && tile.offset[1].value == 0 &&
                     tile.step[0] == 0 && tile.step[1] == 0;
  HistoryTexel texel = add_sample(pixel, sample_at(frame, column.nearest, row.nearest), still,
                                  {column.past * rounded(in.spacing(0)), row.past * rounded(in.spacing(1))});
  texel.undecided = undecided;
  return texel;
}

}  // namespace

Bounded bell(const Bounded& t) {
  const Bounded rest = max(Bounded(1) - Bounded(.125) * t, 0);
  const Bounded square = rest * rest;
  const Bounded fourth = square * square;
  return fourth * fourth;
}

std::vector<HistoryTexel> resolve_temporal(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                           const TemporalOptions& options) {
  std::vector<HistoryTexel> updated;
  for (int y = 0; y < in.output_height; ++y) {
    for (int x = 0; x < in.output_width; ++x)
      updated.push_back(resolve(in, tiles, options, x, y));
  }
  return updated;
}

}  // namespace quincunx::reference
