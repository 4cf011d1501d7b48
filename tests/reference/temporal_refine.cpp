// SPDX-License-Identifier: MIT
#include "temporal_refine.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

constexpr double kFiniteHalfMax = 65504;
constexpr double kSharpening = .05;     // with one layer where all is known
constexpr double kSharpeningNew = .35;  // and more, divided by the confidence and kSharpeningNewConfidence
constexpr double kSharpeningNewConfidence = .6;
constexpr double kEdgeSmoothing = .03;
constexpr double kEdgeSmoothingNew = .5;  // divided by the confidence and kEdgeSmoothingNewConfidence
constexpr double kEdgeSmoothingNewConfidence = .15;
constexpr double kEdgeSmoothingLayered = .2;  // with two layers
constexpr double kEdgeSharpeningLayered = -.12;
constexpr double kEdgeGradientFloor = 1e-3;
constexpr double kToneRestMin = 0x1p-16;  // least 1 - tone, against a division by 0 on the way back

double cleaned(double value) {
  return std::isnan(value) ? 0 : std::clamp(value, -kFiniteHalfMax, kFiniteHalfMax);
}

template <typename Real>
class TonePicture {
 public:
  explicit TonePicture(const Picture& picture) : picture_(picture) {}

  // Clamped to the edge.
  PixelOf<Real> at(int x, int y) const {
    const int column = std::clamp(x, 0, picture_.width - 1);
    const int row = std::clamp(y, 0, picture_.height - 1);
    const Pixel& pixel = picture_.pixels[index_of(picture_.width, column, row)];
    PixelOf<Real> colour = {};
    double brightest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      colour[c] = cleaned(pixel[c]);
      brightest = std::max(brightest, cleaned(pixel[c]));
    }
    const Real scale = 1 / (1 + Real(brightest));
    return {colour[0] * scale, colour[1] * scale, colour[2] * scale, 0};
  }

  Real luma(int x, int y) const {
    const PixelOf<Real> tone = at(x, y);
    return .25 * (tone[0] + tone[2]) + .5 * tone[1];
  }

 private:
  const Picture& picture_;
};

// K cos 2a, K sin 2a and K, with a the direction across the edge.
template <typename Real>
struct Edge {
  Real cosine = 0, sine = 0, coherence = 0;
};

template <typename Real>
Edge<Real> edge_at(const TonePicture<Real>& tone, int x, int y) {
  Real xx = 0, yy = 0, xy = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const int column = x + i, row = y + j;
      const Real gx = .5 * (tone.luma(column + 1, row) - tone.luma(column - 1, row));
      const Real gy = .5 * (tone.luma(column, row + 1) - tone.luma(column, row - 1));
      const double weight = (2 - std::abs(i)) * (2 - std::abs(j)) / 16.0;
      xx += weight * (gx * gx);
      yy += weight * (gy * gy);
      xy += weight * (gx * gy);
    }
  }
  const Real scale = 1 / (xx + yy + kEdgeGradientFloor);
  Edge<Real> edge = {(xx - yy) * scale, 2 * xy * scale, 0};
  edge.coherence = sqrt(edge.cosine * edge.cosine + edge.sine * edge.sine);
  return edge;
}

template <typename Real>
struct Strengths {
  Real sharpening = 0, along = 0, across = 0;
};

// Returns the strengths for a pixel of a confidence as history stores it: even -0 tells of two layers.
template <typename Real>
Strengths<Real> strengths_of(double confidence) {
  if (std::signbit(confidence)) return {0, kEdgeSmoothingLayered, kEdgeSharpeningLayered};
  return {kSharpening + kSharpeningNew / (Real(confidence) + kSharpeningNewConfidence),
          kEdgeSmoothing + kEdgeSmoothingNew / (Real(confidence) + kEdgeSmoothingNewConfidence), 0};
}

// Channel c of the pixel, in tone space.
template <typename Real>
Real refined(const TonePicture<Real>& tone, const Edge<Real>& edge, const Strengths<Real>& by, int x, int y,
             std::size_t c) {
  const auto at = [&](int i, int j) { return tone.at(x + i, y + j)[c]; };
  const Real own = at(0, 0);
  Real sum = 0, least = own, most = own;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      sum += at(i, j);
      least = min(least, at(i, j));
      most = max(most, at(i, j));
    }
  }
  const Real xx = at(-1, 0) + at(1, 0) - 2 * own, yy = at(0, -1) + at(0, 1) - 2 * own;
  const Real xy = .25 * (at(1, 1) - at(1, -1) - (at(-1, 1) - at(-1, -1)));
  const Real both = edge.coherence * (xx + yy);                          // K (D_n + D_t)
  const Real difference = edge.cosine * (xx - yy) + 2 * edge.sine * xy;  // K (D_n - D_t)
  const Real moved = own + by.sharpening * (own - sum * (1 / 9.0)) + .5 * (by.along + by.across) * both -
                     .5 * (by.along - by.across) * difference;
  return min(max(moved, least), most);
}

}  // namespace

template <typename Real>
PixelOf<Real> temporal_refine(const Picture& picture, const std::vector<double>& confidences, int x, int y) {
  const TonePicture<Real> tone(picture);
  const Edge<Real> edge = edge_at(tone, x, y);
  const auto by = strengths_of<Real>(confidences[index_of(picture.width, x, y)]);
  PixelOf<Real> out = {};
  Real brightest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = refined(tone, edge, by, x, y, c);
    brightest = max(brightest, out[c]);
  }
  const Real scale = 1 / max(1 - brightest, kToneRestMin);
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = min(max(out[c] * scale, -kFiniteHalfMax), kFiniteHalfMax);
  out[3] = picture.pixels[index_of(picture.width, x, y)][3];
  return out;
}

template PixelOf<double> temporal_refine(const Picture&, const std::vector<double>&, int, int);
template PixelOf<Bounded> temporal_refine(const Picture&, const std::vector<double>&, int, int);

}  // namespace quincunx::reference
