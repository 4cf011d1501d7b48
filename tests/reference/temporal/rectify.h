// SPDX-License-Identifier: MIT
// Rectification: history towards the range of this frame's samples.
#pragma once

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

}  // namespace quincunx::reference
