// SPDX-License-Identifier: MIT
#include "temporal_refine.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

constexpr double kSharpening = .05;     // with one layer where all is known
constexpr double kSharpeningNew = .35;  // and more, divided by the confidence and kSharpeningNewConfidence
constexpr double kSharpeningNewConfidence = .6;
constexpr double kEdgeSmoothing = .03;
constexpr double kEdgeSmoothingNew = .5;  // divided by the confidence and kEdgeSmoothingNewConfidence
constexpr double kEdgeSmoothingNewConfidence = .15;
constexpr double kEdgeSmoothingLayered = .2;  // with two layers
constexpr double kEdgeSharpeningLayered = -.12;
constexpr double kEdgeGradientFloor = 1e-3;

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
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = refined(tone, edge, by, x, y, c);
  return light_of(out, picture, x, y);
}

template PixelOf<double> temporal_refine(const Picture&, const std::vector<double>&, int, int);
template PixelOf<Bounded> temporal_refine(const Picture&, const std::vector<double>&, int, int);

}  // namespace quincunx::reference
