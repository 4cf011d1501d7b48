// SPDX-License-Identifier: MIT
// resolve_reprojected: an output pixel from this frame and the previous one, each sample weighted by distance.
//   out = (sum w0 h c0 + g sum w1 h c1) / (sum w0 h + g sum w1 h)
//   w1  of the 2 x 2 previous samples around the place that the nearest sample's surface came from:
//       (1 - d^2 / r^2)^3 on each axis, d and r in render pixels
//   w0  of the 2 x 2 samples around the pixel's centre: g times the same + (1 - g) times bilinear's
//   r   .7 + .35 render / output, within [.875, 1]
//   h   luma weight 1 / max(2, brightest channel)
//   g   trust of the nearest sample, (1 - reactive) of both frames; 0 if a previous sample is not finite
// Source: found by measuring (docs/lab/methods.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "reproject.h"

namespace quincunx::reference {
namespace {

constexpr double kBrightFrom = 2;  // linear light: brighter samples have less weight
// Least distance weight of a sample that counts: a smaller one may be 0 in single precision.
constexpr double kNegligible = 1e-5;

// Render pixels at which a sample's weight reaches 0.
double weight_radius(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

double distance_weight(double distance, double radius) {
  const double rest = std::max(1 - distance * distance / (radius * radius), 0.0);
  return rest * rest * rest;
}

struct WeightedSample {
  const Pixel* pixel = nullptr;
  double weight = 0;
};

// Four samples of a frame around (u, v), weighted `by_distance` part by distance and else bilinearly.
std::array<WeightedSample, 4> weighted_samples(const Frame& frame, double u, double v, double by_distance,
                                               int output_width, int output_height) {
  const Between columns = between_samples(u, frame.width);
  const Between rows = between_samples(v, frame.height);
  const auto weight = [&](double distance, double radius) {
    return by_distance * distance_weight(distance, radius) + (1 - by_distance) * (1 - distance);
  };
  std::array<WeightedSample, 4> samples;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_right = i % 2 == 1;
    const bool is_below = i / 2 == 1;
    samples[i] = {
        &texel_at(frame, is_right ? columns.right : columns.left, is_below ? rows.right : rows.left),
        weight(is_right ? 1 - columns.fraction : columns.fraction, weight_radius(frame.width, output_width)) *
            weight(is_below ? 1 - rows.fraction : rows.fraction, weight_radius(frame.height, output_height))};
  }
  return samples;
}

double luma_weight(const Pixel& pixel) {
  return 1 / std::max({kBrightFrom, sanitised(pixel[0]), sanitised(pixel[1]), sanitised(pixel[2])});
}

Pixel mean(const std::vector<WeightedSample>& samples) {
  Pixel out = {};
  double sum = 0;
  for (const WeightedSample& sample : samples) {
    const double weight = sample.weight * luma_weight(*sample.pixel);
    sum += weight;
    for (std::size_t c = 0; c < 4; ++c)
      out[c] += weight * sanitised((*sample.pixel)[c]);
  }
  for (double& value : out)
    value /= sum;
  return out;
}

// ---- What is not finite.

bool is_finite(const Pixel& pixel) {
  return std::all_of(pixel.begin(), pixel.end(), [](double value) { return std::isfinite(value); });
}

struct NonFinite {
  bool counts = false;       // one with a weight
  bool is_doubtful = false;  // one of which a rounding decides whether it has
};

NonFinite find_non_finite(const std::array<WeightedSample, 4>& samples) {
  NonFinite found;
  for (const WeightedSample& sample : samples) {
    if (is_finite(*sample.pixel)) continue;
    const bool counts = sample.weight > kNegligible;
    found.counts = found.counts || counts;
    found.is_doubtful = found.is_doubtful || !counts;
  }
  return found;
}

// ---- For error bounds, beside the picture.

double largest_tap(const std::vector<WeightedSample>& samples) {
  double largest = 0;
  for (const WeightedSample& sample : samples) {
    for (const double value : *sample.pixel)
      if (sample.weight > 0) largest = std::max(largest, std::abs(sanitised(value)));
  }
  return largest;
}

// By how much a mean changes at most when each weight changes by 1.
double condition_of(const std::vector<WeightedSample>& samples, const Pixel& mean) {
  double sum = 0;
  double change = 0;
  for (const WeightedSample& sample : samples) {
    double difference = 0;
    for (std::size_t c = 0; c < 4; ++c)
      difference = std::max(difference, std::abs(sanitised((*sample.pixel)[c]) - mean[c]));
    change += luma_weight(*sample.pixel) * difference;
    sum += sample.weight * luma_weight(*sample.pixel);
  }
  return change / sum;
}

}  // namespace

ReprojectedPicture resolve_reprojected(const Frame& current, const Frame& previous,
                                       const std::vector<Reprojection>& reprojections, bool reactive,
                                       int output_width, int output_height) {
  ReprojectedPicture picture;
  picture.width = output_width;
  picture.height = output_height;
  const auto column_in = [&](const Frame& frame, int x) {
    return texel_coordinate(x, output_width, frame.width, frame.jitter_x);
  };
  const auto row_in = [&](const Frame& frame, int y) {
    return texel_coordinate(y, output_height, frame.height, frame.jitter_y);
  };
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const int column = nearest_texel(x, output_width, current.width, current.jitter_x);
      const int row = nearest_texel(y, output_height, current.height, current.jitter_y);
      const Reprojection& reprojection = reprojections[index_of(current.width, column, row)];
      const bool is_lost = std::isnan(reprojection.trust);
      double trust = is_lost ? 0 : reprojection.trust;
      if (reactive) {
        trust *= 1 - reactive_at(current, x, y, output_width, output_height);
        trust *= 1 - reactive_at(previous, x, y, output_width, output_height);
      }
      const auto before =
          weighted_samples(previous, column_in(previous, x) + reprojection.x,
                           row_in(previous, y) + reprojection.y, 1, output_width, output_height);
      const NonFinite old = trust > 0 ? find_non_finite(before) : NonFinite{};
      if (old.counts) trust = 0;
      const auto now = weighted_samples(current, column_in(current, x), row_in(current, y), trust,
                                        output_width, output_height);
      const NonFinite young = find_non_finite(now);

      std::vector<WeightedSample> samples(now.begin(), now.end());
      for (const WeightedSample& sample : before) {
        if (trust > 0) samples.push_back({sample.pixel, sample.weight * trust});
      }
      const Pixel out = mean(samples);
      picture.pixels.push_back(out);

      const bool is_counted = is_lost || old.counts || young.counts;
      const bool is_doubtful = (old.is_doubtful && !old.counts) || young.is_doubtful;
      picture.non_finite += is_counted ? 1 : 0;
      picture.undecided += is_doubtful && !is_counted ? 1 : 0;
      picture.largest.push_back(largest_tap(samples));
      picture.condition.push_back(is_doubtful ? std::numeric_limits<double>::infinity()
                                              : condition_of(samples, out));
      picture.motion.push_back(std::max(std::abs(reprojection.x), std::abs(reprojection.y)));
    }
  }
  return picture;
}

}  // namespace quincunx::reference
