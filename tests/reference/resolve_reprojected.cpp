// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "reproject.h"

namespace quincunx::reference {
namespace {

constexpr double kBright = 2;
constexpr double kDoubt = 1e-5;  // weights below this may be 0 in single precision

// Texel coordinate of the centre of output pixel x.
double texel_coordinate(int x, int output, int render, double jitter) {
  return (x + .5) * render / output - .5 - jitter;
}

double reach_of(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

struct AxisTaps {
  int texel[2] = {0, 0};
  double distance[2] = {0, 1};
};

// The samples next to a texel coordinate; beyond the edges the outermost one.
AxisTaps taps_at(double u, int size) {
  if (size == 1) return {{0, 0}, {0, 1}};
  const double inside = std::clamp(u, 0.0, size - 1.0);
  const int base = std::min(static_cast<int>(std::floor(inside)), size - 2);
  return {{base, base + 1}, {inside - base, 1 - (inside - base)}};
}

double by_distance(double distance, double reach) {
  const double rest = std::max(1 - distance * distance / (reach * reach), 0.0);
  return rest * rest * rest;
}

struct WeightedTap {
  const Pixel* pixel;
  double weight;
};

// Four samples of a frame; `share` is how far they are weighed by distance, the rest is bilinear.
std::array<WeightedTap, 4> weigh(const Frame& frame, double u, double v, double share, int output_width,
                                 int output_height) {
  const AxisTaps columns = taps_at(u, frame.width);
  const AxisTaps rows = taps_at(v, frame.height);
  const auto weight = [share](double distance, double reach) {
    return share * by_distance(distance, reach) + (1 - share) * (1 - distance);
  };
  std::array<WeightedTap, 4> taps;
  for (std::size_t i = 0; i < 4; ++i) {
    taps[i] = {&texel_at(frame, columns.texel[i % 2], rows.texel[i / 2]),
               weight(columns.distance[i % 2], reach_of(frame.width, output_width)) *
                   weight(rows.distance[i / 2], reach_of(frame.height, output_height))};
  }
  return taps;
}

bool finite(const Pixel& pixel) {
  return std::all_of(pixel.begin(), pixel.end(), [](double value) { return std::isfinite(value); });
}

struct Findings {
  bool non_finite = false;
  bool undecided = false;
};

Findings look_for_non_finite(const std::array<WeightedTap, 4>& taps) {
  Findings found;
  for (const WeightedTap& tap : taps) {
    if (finite(*tap.pixel)) continue;
    if (tap.weight > kDoubt)
      found.non_finite = true;
    else
      found.undecided = true;
  }
  return found;
}

struct Resolved {
  Pixel value = {};
  double largest = 0;
  double condition = 0;
  bool non_finite = false;
};

Resolved blend(const std::vector<WeightedTap>& taps) {
  Resolved out;
  double sum = 0;
  const auto brightness = [](const Pixel& pixel) {
    return 1 / std::max({kBright, sanitised(pixel[0]), sanitised(pixel[1]), sanitised(pixel[2])});
  };
  for (const WeightedTap& tap : taps) {
    const double weight = tap.weight * brightness(*tap.pixel);
    sum += weight;
    for (std::size_t c = 0; c < 4; ++c)
      out.value[c] += weight * sanitised((*tap.pixel)[c]);
  }
  for (double& value : out.value)
    value /= sum;
  for (const WeightedTap& tap : taps) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double value = sanitised((*tap.pixel)[c]);
      if (tap.weight > 0) out.largest = std::max(out.largest, std::abs(value));
    }
    double difference = 0;
    for (std::size_t c = 0; c < 4; ++c)
      difference = std::max(difference, std::abs(sanitised((*tap.pixel)[c]) - out.value[c]));
    out.condition += brightness(*tap.pixel) * difference / sum;
  }
  return out;
}

}  // namespace

ReprojectedPicture resolve_reprojected(const Frame& current, const Frame& previous,
                                       const std::vector<Move>& moves, bool reactive, int output_width,
                                       int output_height) {
  ReprojectedPicture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const int column = nearest_texel(x, output_width, current.width, current.jitter_x);
      const int row = nearest_texel(y, output_height, current.height, current.jitter_y);
      const Move& move = moves[static_cast<std::size_t>(row) * static_cast<std::size_t>(current.width) +
                               static_cast<std::size_t>(column)];
      const bool lost = std::isnan(move.trust);
      double trust = lost ? 0 : move.trust;
      if (reactive) {
        trust *= 1 - reactive_at(current, x, y, output_width, output_height);
        trust *= 1 - reactive_at(previous, x, y, output_width, output_height);
      }
      auto before =
          weigh(previous, texel_coordinate(x, output_width, previous.width, previous.jitter_x) + move.x,
                texel_coordinate(y, output_height, previous.height, previous.jitter_y) + move.y, 1,
                output_width, output_height);
      Findings old;
      if (trust > 0) old = look_for_non_finite(before);
      if (old.non_finite) trust = 0;
      const auto now = weigh(current, texel_coordinate(x, output_width, current.width, current.jitter_x),
                             texel_coordinate(y, output_height, current.height, current.jitter_y), trust,
                             output_width, output_height);
      const Findings young = look_for_non_finite(now);
      std::vector<WeightedTap> taps(now.begin(), now.end());
      for (WeightedTap& tap : before) {
        tap.weight *= trust;
        if (trust > 0) taps.push_back(tap);
      }
      Resolved pixel = blend(taps);
      const bool met = lost || old.non_finite || young.non_finite;
      const bool undecided = (old.undecided && !old.non_finite) || young.undecided;
      picture.pixels.push_back(pixel.value);
      picture.largest.push_back(pixel.largest);
      picture.condition.push_back(undecided ? std::numeric_limits<double>::infinity() : pixel.condition);
      picture.move.push_back(std::max(std::abs(move.x), std::abs(move.y)));
      picture.non_finite += met ? 1 : 0;
      picture.undecided += undecided && !met ? 1 : 0;
    }
  }
  return picture;
}

}  // namespace quincunx::reference
