// SPDX-License-Identifier: MIT
#include "tools/image/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "tools/image/display_light.h"

namespace quincunx::tools {
namespace {

using std::numbers::pi;

constexpr float kColourExponent = 0.7f;   // q_c of the paper
constexpr float kFeatureExponent = 0.5f;  // q_f
// Colour differences up to kKnee (p_c) of the largest are spread over [0, kKneeValue] (p_t).
constexpr float kKnee = 0.4f;
constexpr float kKneeValue = 0.95f;
constexpr double kFeatureWidth = 0.082;  // degrees, peak to trough of the detector of edges and points

using Colour = std::array<float, 3>;
using Raster = std::vector<float>;

// Linear RGB to XYZ relative to the white of D65: every row sums to 1.
constexpr std::array<std::array<double, 3>, 3> kWhite = [] {
  const double x[3] = {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794};
  const double y[3] = {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897};
  const double z[3] = {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382};
  std::array<std::array<double, 3>, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    rows[0][i] = x[i] / (x[0] + x[1] + x[2]);
    rows[1][i] = y[i] / (y[0] + y[1] + y[2]);
    rows[2][i] = z[i] / (z[0] + z[1] + z[2]);
  }
  return rows;
}();

float dot(const std::array<float, 3>& row, const Colour& colour) {
  return row[0] * colour[0] + row[1] * colour[1] + row[2] * colour[2];
}

struct Matrix {
  std::array<std::array<float, 3>, 3> rows;
  Colour operator*(const Colour& colour) const {
    return {dot(rows[0], colour), dot(rows[1], colour), dot(rows[2], colour)};
  }
};

Matrix to_white() {
  Matrix matrix{};
  for (std::size_t i = 0; i < 9; ++i)
    matrix.rows[i / 3][i % 3] = static_cast<float>(kWhite[i / 3][i % 3]);
  return matrix;
}

Matrix from_white() {
  const auto& m = kWhite;
  const auto minor = [](std::size_t row, std::size_t column) {
    const std::size_t r0 = (row + 1) % 3, r1 = (row + 2) % 3;
    const std::size_t c0 = (column + 1) % 3, c1 = (column + 2) % 3;
    return kWhite[r0][c0] * kWhite[r1][c1] - kWhite[r0][c1] * kWhite[r1][c0];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  Matrix matrix{};
  for (std::size_t i = 0; i < 9; ++i)
    matrix.rows[i / 3][i % 3] = static_cast<float>(minor(i % 3, i / 3) / determinant);
  return matrix;
}

// The opponent space YCxCz without its scales and offset, which every filter here, summing to 1, keeps:
// luminance, red against green and blue against yellow.
struct Opponent {
  Raster y, cx, cz;
};

Opponent opponent(std::span<const float> srgb) {
  const Matrix matrix = to_white();
  Opponent planes;
  for (Raster* plane : {&planes.y, &planes.cx, &planes.cz})
    plane->reserve(srgb.size() / 3);
  for (std::size_t i = 0; i < srgb.size(); i += 3) {
    const Colour xyz =
        matrix * Colour{linear_of_srgb(srgb[i]), linear_of_srgb(srgb[i + 1]), linear_of_srgb(srgb[i + 2])};
    planes.y.push_back(xyz[1]);
    planes.cx.push_back(xyz[0] - xyz[1]);
    planes.cz.push_back(xyz[1] - xyz[2]);
  }
  return planes;
}

// Weights of 2 * radius + 1 neighbours.
using Kernel = std::vector<float>;

// Separable; what lies outside the picture equals its nearest pixel inside.
Raster filtered(const Raster& source, Extent extent, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size() / 2);
  const auto width = static_cast<std::size_t>(extent.width);
  Raster rows(source.size());
  std::vector<float> padded(width + 2 * static_cast<std::size_t>(radius));
  for (std::size_t start = 0; start < source.size(); start += width) {
    const float* row = source.data() + start;
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill_n(padded.end() - radius, radius, row[width - 1]);
    for (std::size_t i = 0; i < across.size(); ++i) {
      for (std::size_t x = 0; x < width; ++x)
        rows[start + x] += across[i] * padded[x + i];
    }
  }
  Raster result(source.size());
  for (int y = 0; y < extent.height; ++y) {
    float* out = result.data() + static_cast<std::size_t>(y) * width;
    for (int i = -radius; i <= radius; ++i) {
      const int clamped = std::clamp(y + i, 0, extent.height - 1);
      const float* row = rows.data() + static_cast<std::size_t>(clamped) * width;
      const float weight = down[static_cast<std::size_t>(i + radius)];
      for (std::size_t x = 0; x < width; ++x)
        out[x] += weight * row[x];
    }
  }
  return result;
}

template <typename Function>
Kernel sampled(int radius, const Function& function) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i)
    kernel.push_back(static_cast<float>(function(static_cast<double>(i))));
  return kernel;
}

float sum_of(const Kernel& kernel) {
  float sum = 0;
  for (const float weight : kernel)
    sum += weight;
  return sum;
}

Kernel scaled(Kernel kernel, float factor) {
  for (float& weight : kernel)
    weight *= factor;
  return kernel;
}

// Contrast sensitivity of the eye: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Gaussian {
  double a, b;
};
constexpr Gaussian kLuminance{1, 0.0047};
constexpr Gaussian kRedGreen{1, 0.0053};
constexpr Gaussian kBlueYellowNarrow{34.1, 0.04};
constexpr Gaussian kBlueYellowWide{13.5, 0.025};

struct Detectors {
  Kernel smooth, edge, point;  // a Gaussian, and its first and second derivative
};

class Viewing {
 public:
  explicit Viewing(double pixels_per_degree) : pixels_per_degree_(pixels_per_degree) {
    const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto bell = [=](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
    detectors_ = {sampled(radius, bell), sampled(radius, [=](double x) { return -x * bell(x); }),
                  sampled(radius, [=](double x) { return (x * x / (deviation * deviation) - 1) * bell(x); })};
    detectors_.smooth = scaled(detectors_.smooth, 1 / sum_of(detectors_.smooth));
    balance(detectors_.edge);
    balance(detectors_.point);
  }

  const Detectors& detectors() const { return detectors_; }

  // Blurs the picture to what the eye still sees of it, in place.
  void blur(Opponent& picture, Extent extent) const {
    picture.y = blurred(picture.y, extent, kLuminance);
    picture.cx = blurred(picture.cx, extent, kRedGreen);
    const float narrow = mass(kBlueYellowNarrow);
    const float wide = mass(kBlueYellowWide);
    const Raster first = blurred(picture.cz, extent, kBlueYellowNarrow);
    picture.cz = blurred(picture.cz, extent, kBlueYellowWide);
    for (std::size_t i = 0; i < first.size(); ++i)
      picture.cz[i] = (narrow * first[i] + wide * picture.cz[i]) / (narrow + wide);
  }

 private:
  // Positive weights sum to 1, negative ones to -1.
  static void balance(Kernel& kernel) {
    float positive = 0, negative = 0;
    for (const float weight : kernel)
      (weight > 0 ? positive : negative) += weight;
    for (float& weight : kernel)
      weight /= weight > 0 ? positive : -negative;
  }

  Kernel bell(const Gaussian& gaussian) const {
    // The same for all, that of the widest.
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(kBlueYellowNarrow.b / (2 * pi * pi)) * pixels_per_degree_));
    return sampled(radius, [&](double x) {
      return std::exp(-pi * pi * (x / pixels_per_degree_) * (x / pixels_per_degree_) / gaussian.b);
    });
  }

  // Sum of the two-dimensional filter before it is normalised.
  float mass(const Gaussian& gaussian) const {
    const float sum = sum_of(bell(gaussian));
    return static_cast<float>(gaussian.a * std::sqrt(pi / gaussian.b)) * sum * sum;
  }

  Raster blurred(const Raster& plane, Extent extent, const Gaussian& gaussian) const {
    const Kernel kernel = bell(gaussian);
    const Kernel unit = scaled(kernel, 1 / sum_of(kernel));
    return filtered(plane, extent, unit, unit);
  }

  double pixels_per_degree_;
  Detectors detectors_;
};

float lab_curve(float value) {
  constexpr float kDelta = 6.0f / 29;
  if (value > kDelta * kDelta * kDelta) return std::cbrt(value);
  return value / (3 * kDelta * kDelta) + 4.0f / 29;
}

// L*, a*, b* of D65 with chroma that grows with lightness, after Hunt.
Colour hunt_lab(const Colour& linear_rgb) {
  static const Matrix matrix = to_white();
  const Colour xyz = matrix * linear_rgb;
  const float x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

// HyAB distance: lightness counts apart from chroma.
float distance(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

Colour seen_colour(const Opponent& picture, std::size_t i) {
  static const Matrix matrix = from_white();
  Colour rgb = matrix * Colour{picture.y[i] + picture.cx[i], picture.y[i], picture.y[i] - picture.cz[i]};
  for (float& value : rgb)
    value = std::clamp(value, 0.0f, 1.0f);
  return hunt_lab(rgb);
}

Raster colour_difference(const Opponent& a, const Opponent& b) {
  const float largest = std::pow(distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourExponent);
  const float knee = kKnee * largest;
  Raster difference(a.y.size());
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const float error = std::pow(distance(seen_colour(a, i), seen_colour(b, i)), kColourExponent);
    difference[i] = error < knee ? kKneeValue / knee * error
                                 : kKneeValue + (error - knee) / (largest - knee) * (1 - kKneeValue);
  }
  return difference;
}

// Length of the response to a detector laid along x and along y.
Raster feature_strength(const Raster& luminance, Extent extent, const Kernel& smooth,
                        const Kernel& detector) {
  Raster strength = filtered(luminance, extent, detector, smooth);
  const Raster down = filtered(luminance, extent, smooth, detector);
  for (std::size_t i = 0; i < strength.size(); ++i)
    strength[i] = std::hypot(strength[i], down[i]);
  return strength;
}

Raster feature_difference(const Raster& a, const Raster& b, Extent extent, const Detectors& detectors) {
  const auto& [smooth, edge, point] = detectors;
  Raster difference = feature_strength(a, extent, smooth, edge);
  const Raster edges = feature_strength(b, extent, smooth, edge);
  const Raster points_a = feature_strength(a, extent, smooth, point);
  const Raster points_b = feature_strength(b, extent, smooth, point);
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const float larger = std::max(std::abs(difference[i] - edges[i]), std::abs(points_a[i] - points_b[i]));
    difference[i] = std::pow(larger / std::numbers::sqrt2_v<float>, kFeatureExponent);
  }
  return difference;
}

}  // namespace

std::vector<float> flip_map(Extent extent, std::span<const float> picture, std::span<const float> truth,
                            double pixels_per_degree) {
  const Viewing viewing(pixels_per_degree);
  Opponent a = opponent(picture);
  Opponent b = opponent(truth);
  const Raster features = feature_difference(a.y, b.y, extent, viewing.detectors());
  viewing.blur(a, extent);
  viewing.blur(b, extent);
  Raster map = colour_difference(a, b);
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i] = std::pow(map[i], 1 - features[i]);
  return map;
}

double flip_mean(std::span<const float> map) {
  double sum = 0;
  for (const float value : map)
    sum += static_cast<double>(value);
  return sum / static_cast<double>(map.size());
}

}  // namespace quincunx::tools
