// SPDX-License-Identifier: MIT
// Rectification: history towards the range of this frame's samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "frame_samples.h"
#include "limit_confidence.h"

namespace quincunx::reference {

// Half the size of the box that history is clamped to, in standard deviations of the samples in a cross.
constexpr double kBoxSize = .75;
// Tone-mapped colour: added to the box's size where a distance is compared with it.
constexpr double kBoxMargin = .02;
constexpr double kToneRestMin = 0x1p-16;  // least 1 - tone, against a division by 0 on the way back

// Differences as the eye has them, rather than as light.
template <typename Real>
PixelOf<Real> to_tone(const PixelOf<Real>& colour) {
  const Real scale = 1 + brightest(colour);
  return {colour[0] / scale, colour[1] / scale, colour[2] / scale, 0};
}

template <typename Real>
PixelOf<Real> from_tone(const PixelOf<Real>& tone) {
  const Real rest = max(1 - brightest(tone), kToneRestMin);
  return {tone[0] / rest, tone[1] / rest, tone[2] / rest, 0};
}

// The range that the samples around a pixel allow, in tone space.
template <typename Real>
struct Box {
  PixelOf<Real> mean = {};
  PixelOf<Real> deviation = {};  // times kBoxSize
  bool is_known = false;         // there is a valid sample
};

// Returns the box of the sample (x, y) and its four neighbours.
template <typename Real>
Box<Real> box_around(const Frame& frame, int x, int y) {
  const int cross[][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  // Sums of the differences to the first sample: their squares lose no digits.
  PixelOf<Real> first = {}, sum = {}, squares = {};
  int count = 0;
  for (const auto& step : cross) {
    const Pixel& sample = texel_clamped(frame, x + step[0], y + step[1]);
    if (!is_valid(sample)) continue;
    const PixelOf<Real> tone = to_tone(as<Real>(sample));
    if (count == 0) first = tone;
    for (std::size_t c = 0; c < 3 && count > 0; ++c) {
      const Real difference = tone[c] - first[c];
      sum[c] += difference;
      squares[c] += difference * difference;
    }
    ++count;
  }
  Box<Real> box;
  box.is_known = count > 0;
  for (std::size_t c = 0; c < 3 && count > 0; ++c) {
    const Real mean = sum[c] / count;
    box.mean[c] = first[c] + mean;
    box.deviation[c] = kBoxSize * sqrt(max(squares[c] / count - mean * mean, 0));
  }
  return box;
}

// Towards what the surroundings allow; confidence falls by how wrong history was.
template <typename Real>
void rectify(const Box<Real>& box, Known<Real>& known) {
  if (!box.is_known) return;
  PixelOf<Real> tone = to_tone(known.colour);
  Real distance = 0;
  Real spread = 0;
  bool is_outside = false;
  for (std::size_t c = 0; c < 3; ++c) {
    const Real low = box.mean[c] - box.deviation[c];
    const Real high = box.mean[c] + box.deviation[c];
    spread += box.deviation[c];
    if (seamless(tone[c] < low) || seamless(tone[c] > high)) {
      const Real step = clamp(tone[c], low, high) - tone[c];
      distance += abs(step);
      tone[c] += step * known.rejection;
      is_outside = true;
    }
  }
  known.confidence *= 1 - known.rejection * min(1, distance / (spread + kBoxMargin));
  if (is_outside) known.colour = from_tone(tone);
}

// Alpha, towards that of the valid ones of the same samples. It is no light: no tone curve.
template <typename Real>
void rectify_alpha(const Frame& frame, int x, int y, Known<Real>& known) {
  const int cross[][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  Real first = 0, sum = 0, squares = 0;
  int count = 0;
  for (const auto& step : cross) {
    const Pixel& sample = texel_clamped(frame, x + step[0], y + step[1]);
    if (!is_valid(sample)) continue;
    if (count == 0) first = sample[3];
    const Real difference = sample[3] - first;
    sum += difference;
    squares += difference * difference;
    ++count;
  }
  if (count == 0) return;
  const Real mean = sum / count;
  const Real deviation = kBoxSize * sqrt(max(squares / count - mean * mean, 0));
  const Real middle = first + mean;
  known.alpha += (clamp(known.alpha, middle - deviation, middle + deviation) - known.alpha) * known.rejection;
}

// ---- Alpha that fades, or moves unlike the surfaces.

// Alpha: history that varies by more over 3x3 texels is at an edge.
constexpr double kEvenAlphaMax = .03125;

struct AlphaRange {
  double least = 0, most = 0;
  bool is_known = false;

  void add(double alpha) {
    least = is_known ? std::min(least, alpha) : alpha;
    most = is_known ? std::max(most, alpha) : alpha;
    is_known = true;
  }
};

// Moves history's alpha into the range of this frame's, but for what it varies by around: samples may have missed that.
// Those of cut-outs, which are 0 or 1, move only history that is even. `uneven()`: what it varies by.
template <typename Real, typename Uneven>
void follow_alpha(const AlphaRange& range, const Uneven& uneven, Real& alpha) {
  if (!range.is_known) return;
  const bool is_below = alpha<range.least, is_above = alpha> range.most;
  if (!is_below && !is_above) return;
  const double around = uneven();
  const bool is_soft = range.least > 0 && range.most < 1;
  if (!is_soft && around > kEvenAlphaMax) return;
  const Real step = is_below ? range.least - alpha : alpha - range.most;
  const Real moved = max(step - around, 0);
  alpha = is_below ? alpha + moved : alpha - moved;
}

// The range of the valid ones of the 3x3 samples around (x, y) that `counts(column, row)`.
template <typename Counts>
AlphaRange alphas_around(const Frame& frame, int x, int y, const Counts& counts) {
  AlphaRange range;
  for (int row = y - 1; row <= y + 1; ++row) {
    for (int column = x - 1; column <= x + 1; ++column) {
      const Pixel& sample = texel_clamped(frame, column, row);
      if (is_valid(sample) && counts(column, row)) range.add(sample[3]);
    }
  }
  return range;
}

// Lets the alpha of a pixel of one layer follow. `alpha_at(x, y)`, `has_two(x, y)`: of a texel, clamped to the edge.
template <typename Real, typename AlphaAt, typename HasTwo>
void follow_alpha_of_one(const Frame& frame, int x, int y, const std::array<int, 2>& texel,
                         const AlphaAt& alpha_at, const HasTwo& has_two, Real& alpha) {
  const auto uneven = [&] {
    AlphaRange range;
    for (int row = texel[1] - 1; row <= texel[1] + 1; ++row) {
      for (int column = texel[0] - 1; column <= texel[0] + 1; ++column) {
        if (has_two(column, row) == has_two(texel[0], texel[1])) range.add(alpha_at(column, row));
      }
    }
    return range.most - range.least;
  };
  follow_alpha(alphas_around(frame, x, y, [](int, int) { return true; }), uneven, alpha);
}

}  // namespace quincunx::reference
