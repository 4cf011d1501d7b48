// SPDX-License-Identifier: MIT
#include "measure_content.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quincunx::reference {
namespace {

constexpr int kTile = 32;
constexpr int kSamples = 8;  // samples of a tile, on each axis
constexpr double kMoving = .25;
constexpr double kApart = 1;
constexpr double kFastest = 255;
constexpr double kBehind = .9;
constexpr double kReactive = .1;
constexpr int kJudgedTile = 8;  // output pixels
constexpr double kGrows = .01;
constexpr double kThinReach = 3;
constexpr double kUnit = 0x1p-24;

struct Sample {
  double x, y;  // velocity, output pixels
  double depth;
};

class Counter {
 public:
  Counter(const Frame& frame, int width, int height, bool reactive, const std::vector<double>& confirmations)
      : frame_(frame), width_(width), height_(height), reactive_(reactive), confirmations_(confirmations) {
    tiles_x_ = (width + kTile - 1) / kTile;
    tiles_y_ = (height + kTile - 1) / kTile;
    reach_x_ = std::max(1, static_cast<int>(std::lround(kThinReach * frame.width / width)));
    reach_y_ = std::max(1, static_cast<int>(std::lround(kThinReach * frame.height / height)));
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x)
        largest_ = std::max({largest_, std::abs(at(x, y).x), std::abs(at(x, y).y)});
    }
  }

  ContentCounts run() {
    for (int y = 0; y < tiles_y_; ++y) {
      for (int x = 0; x < tiles_x_; ++x)
        count_tile(x, y);
    }
    counts_.tiles = std::int64_t{tiles_x_} * tiles_y_;
    return counts_;
  }

 private:
  // Whether value >= threshold. `error`: how far the kernel may be off.
  bool reaches(double value, double threshold, double error) {
    counts_.margin = std::min(counts_.margin, std::abs(value - threshold) / error);
    return value >= threshold;
  }

  Sample at(int x, int y) const {
    const std::size_t i = index_of(frame_.width, x, y);
    return {sanitised(frame_.velocity[i][0] * frame_.velocity_scale[0] * width_),
            sanitised(frame_.velocity[i][1] * frame_.velocity_scale[1] * height_), frame_.depth[i]};
  }
  Sample sample(int i, int j) const { return at(column(i), row(j)); }
  int column(int i) const { return (2 * i + 1) * frame_.width / (2 * tiles_x_ * kSamples); }
  int row(int j) const { return (2 * j + 1) * frame_.height / (2 * tiles_y_ * kSamples); }

  bool behind(const Sample& a, const Sample& b) {
    const double least = kBehind * b.depth;
    if (least > 0) reaches(a.depth, least, 2 * kUnit * least);
    return a.depth < least;
  }
  // A velocity is a product of three factors, one of which is rounded twice; a difference is rounded once more, and so
  // are squares, sum and threshold.
  bool moves(double x, double y, double least = kMoving) {
    return reaches(std::hypot(x, y), least, 2 * 6 * kUnit * largest_ + 4 * kUnit);
  }
  bool differ(const Sample& a, const Sample& b, double least = kMoving) {
    return moves(a.x - b.x, a.y - b.y, least);
  }
  bool are_apart(const Sample& a, const Sample& b) {
    return (behind(a, b) || behind(b, a)) && differ(a, b, kApart);
  }
  bool is_thin(const Sample& here, const Sample& one, const Sample& other) {
    return behind(one, here) && behind(other, here) && (differ(here, one) || differ(here, other));
  }

  bool judged() const { return !confirmations_.empty(); }

  bool thin_at(int x, int y) {
    const Sample here = at(x, y);
    const bool across = x >= reach_x_ && x + reach_x_ < frame_.width &&
                        is_thin(here, at(x - reach_x_, y), at(x + reach_x_, y));
    const bool down = y >= reach_y_ && y + reach_y_ < frame_.height &&
                      is_thin(here, at(x, y - reach_y_), at(x, y + reach_y_));
    return across || down;
  }

  // The mean of what velocity gains from one sample to the next on an axis, a pixel.
  double growth(int tile_x, int tile_y, bool across) {
    double sum = 0;
    int pairs = 0;
    for (int j = across ? 0 : 1; j < kSamples; ++j) {
      for (int i = across ? 1 : 0; i < kSamples; ++i) {
        const int x = tile_x * kSamples + i, y = tile_y * kSamples + j;
        const Sample here = sample(x, y), before = sample(across ? x - 1 : x, across ? y : y - 1);
        apart_ |= are_apart(before, here);
        if (behind(here, before) || behind(before, here)) continue;
        sum += across ? here.x - before.x : here.y - before.y;
        ++pairs;
      }
    }
    const double step = across ? static_cast<double>(width_) / (tiles_x_ * kSamples)
                               : static_cast<double>(height_) / (tiles_y_ * kSamples);
    return pairs > 0 ? sum / pairs / step : 0;
  }

  // Whether the judge has found light that moves at the place in the output that the sample stands for.
  bool is_confirmed(int i, int j) {
    const int x = (2 * i + 1) * width_ / (2 * tiles_x_ * kSamples);
    const int y = (2 * j + 1) * height_ / (2 * tiles_y_ * kSamples);
    const int tiles = (width_ + kJudgedTile - 1) / kJudgedTile;
    return confirmations_[index_of(tiles, x / kJudgedTile, y / kJudgedTile)] >= 1;
  }

  void count_tile(int tile_x, int tile_y) {
    constexpr std::int64_t kAll = kSamples * kSamples;
    std::int64_t moving = 0;
    bool thin = false, light = false;
    for (int j = tile_y * kSamples; j < (tile_y + 1) * kSamples; ++j) {
      for (int i = tile_x * kSamples; i < (tile_x + 1) * kSamples; ++i) {
        const Sample here = sample(i, j);
        if (moves(here.x, here.y)) {
          ++moving;
          counts_.speed += std::min(std::hypot(here.x, here.y), kFastest);
        }
        thin |= thin_at(column(i), row(j));
        light |= reactive_ &&
                 reaches(frame_.reactive[index_of(frame_.width, column(i), row(j))], kReactive, 2 * kUnit);
        light |= judged() && is_confirmed(i, j);
      }
    }
    apart_ = false;
    const double x = growth(tile_x, tile_y, true), y = growth(tile_x, tile_y, false);
    // 56 differences, whose sum never exceeds 16 of the largest velocity.
    const double step = std::min(width_ / (8. * tiles_x_), height_ / (8. * tiles_y_));
    const double error = (2 * 6 + 16 + 4) * kUnit * largest_ / step;
    const bool grows_x = reaches(x, kGrows, error), grows_y = reaches(y, kGrows, error);
    const bool shrinks_x = reaches(-x, kGrows, error), shrinks_y = reaches(-y, kGrows, error);
    const bool grows = grows_x && grows_y, shrinks = shrinks_x && shrinks_y;
    counts_.moving += moving;
    counts_.apart += apart_ ? kAll : 0;
    counts_.thin += thin ? kAll : 0;
    counts_.light += light ? kAll : 0;
    counts_.judged += judged() ? kAll : 0;
    counts_.zoom += grows || shrinks ? moving : 0;
  }

  const Frame& frame_;
  int width_, height_;  // size of the output
  bool reactive_;
  const std::vector<double>& confirmations_;
  int tiles_x_, tiles_y_, reach_x_, reach_y_;
  double largest_ = 1e-30;  // velocity on an axis, output pixels
  bool apart_ = false;
  ContentCounts counts_;
};

}  // namespace

ContentCounts measure_content(const Frame& frame, int output_width, int output_height, bool reactive,
                              const std::vector<double>& confirmations) {
  return Counter(frame, output_width, output_height, reactive, confirmations).run();
}

}  // namespace quincunx::reference
