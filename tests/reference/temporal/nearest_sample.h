// SPDX-License-Identifier: MIT
// The sample of this frame that an output pixel looks at.
#pragma once

#include <algorithm>
#include <cmath>

#include "../temporal.h"

namespace quincunx::reference {

// On one axis, with distances in samples.
template <typename Real>
struct Nearest {
  int sample = 0;
  Real past = 0;  // from the sample to p + R, which may lie beyond the outermost sample
  int left = 0;   // the samples on either side of p + R, clamped to the edge ...
  int right = 0;
  Real fraction = 0;  // ... and how far it lies between them
};

template <typename Real>
Nearest<Real> nearest_sample(int x, int output, int render, double jitter, double phase) {
  const double u = texel_coordinate(x, output, render, jitter);
  const int texel = static_cast<int>(std::floor(u));
  const Real at = u - texel + phase / Real(static_cast<double>(output) / render);  // from that texel on
  const int last = render - 1;
  Nearest<Real> nearest;
  nearest.sample = texel + round_down_within(at, -texel, last - texel);
  nearest.past = at - (nearest.sample - texel);
  nearest.left = texel + floor_within(at, -texel, std::max(last - 1, 0) - texel);
  nearest.right = std::min(nearest.left + 1, last);
  nearest.fraction = clamp(at - (nearest.left - texel), 0, nearest.right - nearest.left);
  return nearest;
}

template <typename Real>
struct Neighbourhood {
  Nearest<Real> x, y;
};

// Returns the samples nearest to pixel (x, y), whose picture lies at its centre + phase. On a checkerboard a sample
// that is not shaded gives way to the next one of its row, on the side of the picture where there is one there.
template <typename Real>
Neighbourhood<Real> nearest_samples(const TemporalInputs& in, int x, int y,
                                    const std::array<double, 2>& phase) {
  Neighbourhood<Real> near = {
      nearest_sample<Real>(x, in.output_width, in.frame.width, in.frame.jitter_x, phase[0]),
      nearest_sample<Real>(y, in.output_height, in.frame.height, in.frame.jitter_y, phase[1])};
  const bool is_shaded = in.parity < 0 || (near.x.sample + near.y.sample) % 2 == in.parity;
  if (is_shaded || in.frame.width == 1) return near;
  int step = near.x.past > 0 ? 1 : -1;
  if (near.x.sample == 0) step = 1;
  if (near.x.sample == in.frame.width - 1) step = -1;
  near.x.sample += step;
  near.x.past = near.x.past - step;
  return near;
}

}  // namespace quincunx::reference
