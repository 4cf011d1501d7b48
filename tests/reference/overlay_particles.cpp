// SPDX-License-Identifier: MIT
// overlay_particles: particles of a viewport of their own, laid over a frame.
//   c, a, r   colour, coverage and reactive value of the particles: the mean of the four texels around the pixel's
//             centre by weight w = (bilinear weight) * clamp(1 - (g - h) / (.05 + h)), h the least g of the four
//   g         gap |z' - z| / max(z', z, 1e-30) of the texel's depth z' and the pixel's z; 1 where one is not finite.
//             A texel whose colour is not finite is none
//   colour    c + clamp(1 - a) b of the frame's colour b; reactive value r + (1 - r) q of the frame's q
// Where no weight is above 0, the first texel of the least gap in the order upper left, upper right, lower left, lower
// right stands for all. A centre on that of a texel has this texel on both sides.
#include "overlay_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace quincunx::reference {
namespace {

constexpr double kSameSurface = .05;
constexpr double kLeastDepth = 1e-30f;

// The texels on either side of a pixel's centre on an axis; the fraction is (2 i + 1) texels / (2 pixels) - 1/2 less
// its whole part, in whole numbers.
template <typename Real>
struct Sides {
  int low = 0, high = 0;
  Real fraction = 0;
};

template <typename Real>
Sides<Real> sides_of(long pixel, long pixels, long texels) {
  const long step = 2 * pixels;
  const long along = (2 * pixel + 1) * texels - pixels;
  const long whole = along < 0 ? -1 : along / step;
  const long rest = along - whole * step;
  const auto within = [texels](long at) { return static_cast<int>(std::clamp(at, 0L, texels - 1)); };
  return {within(whole), within(whole + (rest > 0 ? 1 : 0)),
          Real(static_cast<double>(rest)) / static_cast<double>(step)};
}

bool is_finite(const Pixel& pixel) {
  return std::all_of(pixel.begin(), pixel.end(), [](double value) { return std::isfinite(value); });
}

template <typename Real>
Real gap_of(double own, double other) {
  if (!std::isfinite(own) || !std::isfinite(other)) return 1;
  return min(abs(Real(other) - own) / std::max({other, own, kLeastDepth}), 1);
}

template <typename Real>
struct WeightedTexel {
  std::size_t texel = 0;
  Real weight = 0;  // bilinear; then the whole one
  Real gap = 0;
};

template <typename Real>
std::array<WeightedTexel<Real>, 4> taps_of(const Frame& frame, const Frame& particles, int x, int y) {
  const Sides<Real> columns = sides_of<Real>(x, frame.width, particles.width);
  const Sides<Real> rows = sides_of<Real>(y, frame.height, particles.height);
  const double own = frame.depth[index_of(frame.width, x, y)];
  const auto tap = [&](int column, int row, const Real& weight) {
    const std::size_t texel = index_of(particles.width, column, row);
    return WeightedTexel<Real>{texel, weight, gap_of<Real>(own, particles.depth[texel])};
  };
  const Real right = columns.fraction, left = 1 - right, below = rows.fraction, above = 1 - below;
  return {tap(columns.low, rows.low, left * above), tap(columns.high, rows.low, right * above),
          tap(columns.low, rows.high, left * below), tap(columns.high, rows.high, right * below)};
}

}  // namespace

template <typename Real>
OverlaidPixel<Real> overlay_particles(const Frame& frame, const Frame& particles, int x, int y) {
  std::vector<WeightedTexel<Real>> taps;
  for (const WeightedTexel<Real>& tap : taps_of<Real>(frame, particles, x, y)) {
    if (is_finite(particles.colour[tap.texel])) taps.push_back(tap);
  }
  const std::size_t pixel = index_of(frame.width, x, y);
  const Pixel& bare = frame.colour[pixel];
  const double mark = frame.reactive.empty() ? 0 : frame.reactive[pixel];
  OverlaidPixel<Real> result{.colour = {bare[0], bare[1], bare[2], bare[3]}, .reactive = mark};
  if (taps.empty()) return result;

  Real least = taps[0].gap;
  for (const WeightedTexel<Real>& tap : taps)
    least = min(least, tap.gap);
  Real total = 0;
  for (WeightedTexel<Real>& tap : taps) {
    tap.weight *= clamp(1 - (tap.gap - least) / (Real(kSameSurface) + least), 0, 1);
    total += tap.weight;
  }
  if (!(total > 0)) {
    bool found = false;
    for (WeightedTexel<Real>& tap : taps) {
      const bool is_first = !found && !(tap.gap > least);
      tap.weight = is_first ? 1 : 0;
      found = found || is_first;
    }
    total = 1;
  }

  PixelOf<Real> over = {};
  Real over_mark = 0;
  for (const WeightedTexel<Real>& tap : taps) {
    for (std::size_t c = 0; c < 4; ++c)
      over[c] += tap.weight / total * particles.colour[tap.texel][c];
    if (!particles.reactive.empty()) over_mark += tap.weight / total * particles.reactive[tap.texel];
  }
  result.has_particles = true;
  result.reactive = over_mark + (1 - over_mark) * mark;
  result.keeps_colour = !is_finite(bare);
  if (result.keeps_colour) return result;
  const Real through = clamp(1 - over[3], 0, 1);
  for (std::size_t c = 0; c < 4; ++c)
    result.colour[c] = over[c] + through * bare[c];
  return result;
}

template OverlaidPixel<double> overlay_particles(const Frame&, const Frame&, int, int);
template OverlaidPixel<Bounded> overlay_particles(const Frame&, const Frame&, int, int);

}  // namespace quincunx::reference
