// SPDX-License-Identifier: MIT
#include "tools/image/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/image/image_io.h"

namespace quincunx::tools {
namespace {

constexpr int kSsimRadius = 5;
constexpr double kSsimSigma = 1.5;

double squared(double value) {
  return value * value;
}

float finite(float value) {
  if (std::isnan(value)) return 0;
  return std::isinf(value) ? std::copysign(kLargestHalf, value) : value;
}

float display_value(float linear) {
  const float light = std::max(linear, 0.0f);
  const float mapped = light / (1 + light);
  return mapped <= 0.0031308f ? mapped * 12.92f : 1.055f * std::pow(mapped, 1 / 2.4f) - 0.055f;
}

double decibels(double mean_squared_error) {
  return -10 * std::log10(mean_squared_error);
}

// Mean squared error of the three tone-mapped values of pixel i.
double pixel_error(const MeasuredPicture& picture, const MeasuredPicture& truth, std::size_t i) {
  double sum = 0;
  for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
    sum += squared(double{picture.tone_mapped()[c]} - double{truth.tone_mapped()[c]});
  return sum / 3;
}

std::size_t pixel_count(const MeasuredPicture& picture) {
  return picture.luma().size();
}

// Local means of luma under the window of SSIM, and of its products: one sum per moment.
struct Moments {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double weight, const Moments& other) {
    x += weight * other.x;
    y += weight * other.y;
    xx += weight * other.xx;
    yy += weight * other.yy;
    xy += weight * other.xy;
  }
};

std::array<double, 2 * kSsimRadius + 1> ssim_window() {
  std::array<double, 2 * kSsimRadius + 1> weights{};
  double sum = 0;
  for (int i = -kSsimRadius; i <= kSsimRadius; ++i) {
    weights[static_cast<std::size_t>(i + kSsimRadius)] = std::exp(-i * i / (2 * kSsimSigma * kSsimSigma));
    sum += weights[static_cast<std::size_t>(i + kSsimRadius)];
  }
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

double similarity(const Moments& m) {
  constexpr double kC1 = 0.01 * 0.01;
  constexpr double kC2 = 0.03 * 0.03;
  const double variance_x = m.xx - m.x * m.x;
  const double variance_y = m.yy - m.y * m.y;
  const double covariance = m.xy - m.x * m.y;
  return (2 * m.x * m.y + kC1) * (2 * covariance + kC2) /
         ((m.x * m.x + m.y * m.y + kC1) * (variance_x + variance_y + kC2));
}

float sample(const MeasuredPicture& picture, float u, float v) {
  const Extent extent = picture.extent();
  const float x =
      std::clamp(u * static_cast<float>(extent.width) - .5f, 0.f, static_cast<float>(extent.width - 1));
  const float y =
      std::clamp(v * static_cast<float>(extent.height) - .5f, 0.f, static_cast<float>(extent.height - 1));
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, extent.width - 1), bottom = std::min(top + 1, extent.height - 1);
  const auto at = [&](int column, int row) {
    return picture.luma()[static_cast<std::size_t>(row) * static_cast<std::size_t>(extent.width) +
                          static_cast<std::size_t>(column)];
  };
  const float across = x - static_cast<float>(left), down = y - static_cast<float>(top);
  return std::lerp(std::lerp(at(left, top), at(right, top), across),
                   std::lerp(at(left, bottom), at(right, bottom), across), down);
}

Vec2 motion_at(const MotionField& motion, float u, float v) {
  const auto x =
      std::min(static_cast<int>(u * static_cast<float>(motion.extent.width)), motion.extent.width - 1);
  const auto y =
      std::min(static_cast<int>(v * static_cast<float>(motion.extent.height)), motion.extent.height - 1);
  return motion.velocity[static_cast<std::size_t>(y) * static_cast<std::size_t>(motion.extent.width) +
                         static_cast<std::size_t>(x)];
}

}  // namespace

MeasuredPicture::MeasuredPicture(Extent extent, std::span<const float> rgba) : extent_(extent) {
  const auto count = static_cast<std::size_t>(extent.area());
  linear_.reserve(3 * count);
  tone_mapped_.reserve(3 * count);
  luma_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto colour = rgba.subspan(4 * i, 3);
    non_finite_ +=
        std::any_of(colour.begin(), colour.end(), [](float value) { return !std::isfinite(value); }) ? 1 : 0;
    for (const float value : colour) {
      linear_.push_back(finite(value));
      tone_mapped_.push_back(display_value(linear_.back()));
    }
    const float* shown = tone_mapped_.data() + 3 * i;
    luma_.push_back(0.2126f * shown[0] + 0.7152f * shown[1] + 0.0722f * shown[2]);
  }
}

MeasuredPicture measured(Extent extent, std::vector<float> rgba, float exposure) {
  constexpr float kGrey = 0.18f;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    for (std::size_t c = i; c < i + 3; ++c)
      rgba[c] = rgba[c] * exposure + kGrey * (1 - rgba[i + 3]);
  }
  return {extent, rgba};
}

double psnr_linear(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.linear().size(); ++i) {
    const float value = std::clamp(picture.linear()[i], 0.0f, 1.0f);
    const float wanted = std::clamp(truth.linear()[i], 0.0f, 1.0f);
    sum += squared(double{value} - double{wanted});
  }
  return decibels(sum / static_cast<double>(picture.linear().size()));
}

double psnr_tone_mapped(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < pixel_count(picture); ++i)
    sum += pixel_error(picture, truth, i);
  return decibels(sum / static_cast<double>(pixel_count(picture)));
}

double ssim(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  const auto weights = ssim_window();
  const auto width = static_cast<std::size_t>(picture.extent().width);
  const auto height = static_cast<std::size_t>(picture.extent().height);
  const std::size_t side = weights.size();
  double sum = 0;
  std::vector<Moments> columns(width);
  for (std::size_t top = 0; top + side <= height; ++top) {
    std::fill(columns.begin(), columns.end(), Moments{});
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t x = 0; x < width; ++x) {
        const double a = picture.luma()[(top + j) * width + x];
        const double b = truth.luma()[(top + j) * width + x];
        columns[x].add(weights[j], {a, b, a * a, b * b, a * b});
      }
    }
    for (std::size_t left = 0; left + side <= width; ++left) {
      Moments window;
      for (std::size_t i = 0; i < side; ++i)
        window.add(weights[i], columns[left + i]);
      sum += similarity(window);
    }
  }
  return sum / static_cast<double>((width - side + 1) * (height - side + 1));
}

double error_p99(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  std::vector<float> errors(picture.tone_mapped().size());
  for (std::size_t i = 0; i < errors.size(); ++i)
    errors[i] = std::abs(picture.tone_mapped()[i] - truth.tone_mapped()[i]);
  const auto rank = errors.begin() + static_cast<std::ptrdiff_t>((errors.size() - 1) * 99 / 100);
  std::nth_element(errors.begin(), rank, errors.end());
  return double{*rank};
}

double relative_error(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  constexpr double kDarkness = 0.01;
  double sum = 0;
  for (std::size_t i = 0; i < picture.linear().size(); ++i) {
    const double wanted = truth.linear()[i];
    sum += squared(double{picture.linear()[i]} - wanted) / (squared(wanted) + kDarkness);
  }
  return sum / static_cast<double>(picture.linear().size());
}

WorstWindow worst_window(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  const Extent extent = picture.extent();
  const int window_width = std::min(kWindowSide, extent.width);
  const int window_height = std::min(kWindowSide, extent.height);
  // sums[y][x]: the errors above and to the left of pixel (x, y).
  const int stride = extent.width + 1;
  std::vector<double> sums(static_cast<std::size_t>(stride) * (extent.height + 1), 0);
  const auto sum = [&](int x, int y) -> double& {
    return sums[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < extent.height; ++y) {
    double row = 0;
    for (int x = 0; x < extent.width; ++x) {
      row += pixel_error(picture, truth, static_cast<std::size_t>(y) * extent.width + x);
      sum(x + 1, y + 1) = sum(x + 1, y) + row;
    }
  }
  WorstWindow worst;
  double largest = -1;
  for (int y = 0; y + window_height <= extent.height; ++y) {
    for (int x = 0; x + window_width <= extent.width; ++x) {
      const double inside = sum(x + window_width, y + window_height) - sum(x, y + window_height) -
                            sum(x + window_width, y) + sum(x, y);
      if (inside <= largest) continue;
      largest = inside;
      worst.x = x;
      worst.y = y;
    }
  }
  worst.error = std::sqrt(std::max(largest, 0.0) / (window_width * window_height));
  return worst;
}

double flicker(const MeasuredPicture& picture, const MeasuredPicture& previous, const MeasuredPicture& truth,
               const MeasuredPicture& previous_truth) {
  double sum = 0;
  for (std::size_t i = 0; i < pixel_count(picture); ++i) {
    const double change = double{picture.luma()[i]} - double{previous.luma()[i]};
    const double wanted = double{truth.luma()[i]} - double{previous_truth.luma()[i]};
    sum += std::abs(change - wanted);
  }
  return sum / static_cast<double>(pixel_count(picture));
}

PictureScores measure(const MeasuredPicture& picture, const MeasuredPicture& truth) {
  return {.psnr_linear = psnr_linear(picture, truth),
          .psnr_tone_mapped = psnr_tone_mapped(picture, truth),
          .ssim = ssim(picture, truth),
          .flip = flip_mean(flip_map(picture.extent(), picture.tone_mapped(), truth.tone_mapped())),
          .error_p99 = error_p99(picture, truth),
          .relative_error = relative_error(picture, truth),
          .worst_window = worst_window(picture, truth),
          .non_finite = picture.non_finite()};
}

std::vector<float> flicker_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                               const MeasuredPicture& truth, const MeasuredPicture& previous_truth) {
  std::vector<float> map(picture.luma().size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const float change = picture.luma()[i] - previous.luma()[i];
    map[i] = std::abs(change - (truth.luma()[i] - previous_truth.luma()[i]));
  }
  return map;
}

std::vector<float> ghost_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                             const MotionField& motion) {
  const Extent extent = picture.extent();
  std::vector<float> map(picture.luma().size(), 0.f);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto width = static_cast<std::size_t>(extent.width);
    const float u = (static_cast<float>(i % width) + .5f) / static_cast<float>(extent.width);
    const float v = (static_cast<float>(i / width) + .5f) / static_cast<float>(extent.height);
    const Vec2 moved = motion_at(motion, u, v);
    const float from_u = u - moved.x, from_v = v - moved.y;
    const bool on_screen = from_u >= 0 && from_u <= 1 && from_v >= 0 && from_v <= 1;  // NaN is not
    if (on_screen) map[i] = std::abs(picture.luma()[i] - sample(previous, from_u, from_v));
  }
  return map;
}

}  // namespace quincunx::tools
