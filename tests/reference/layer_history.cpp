// SPDX-License-Identifier: MIT
#include "layer_history.h"

#include <algorithm>
#include <cmath>

#include "temporal/limit_confidence.h"

namespace quincunx::reference {
namespace {

// Texels: a place of a rigid layer that is this near to a texel is that texel.
constexpr double kCopiedOffsetMax = .06;
// Parts of the larger depth: a near layer of another depth is another thing's; a far one may be seen at a slant.
constexpr double kNearDepthStepMax = .1;
constexpr double kFarDepthStepMax = .2;
constexpr double kCrossingDepthStepMax = .05;  // the same of near layers that may cross
constexpr double kEmptyConfidenceMax = 1;  // confidence that there is no near layer where there was but one
constexpr double kFarthestPlace = 65536;

template <typename Real>
bool are_alike(const Real& a, const Real& b, double tolerance) {
  return abs(a - b) <= tolerance * max(a, b);
}

// The far, or only, layer of a texel.
template <typename Real>
LayerTap<Real> far_of(const LayerHistory& history, int x, int y) {
  const Pixel& texel = history.far[history.texel(x, y)];
  const double alpha = history.alpha.empty() ? 1 : history.alpha[history.texel(x, y)];
  return {{texel[0], texel[1], texel[2], 1}, std::clamp(std::abs(texel[3]), 0.0, kConfidenceMax), alpha};
}

// A surface that stands alone now: of two layers of a texel the one that has its depth.
template <typename Real>
LayerTap<Real> only_tap(const LayerHistory& history, const LayerWish& wish, int x, int y) {
  const auto state = state_at<Real>(history, x, y);
  LayerTap<Real> tap = far_of<Real>(history, x, y);
  if (!state.has_two()) {
    tap.is_valid = !wish.tests_depth || state.far_depth <= Real(wish.near_depth) * (1 + kFarDepthStepMax);
    return tap;
  }
  if (wish.near_depth > state.between()) {
    tap.value = as<Real>(history.near[history.texel(x, y)]);
    tap.confidence = state.near_confidence * tap.value[3];
    tap.alpha = state.near_alpha;
    tap.is_valid = are_alike<Real>(state.near_depth, wish.near_depth, kNearDepthStepMax);
  } else {
    tap.is_valid = tap.confidence > 0 && are_alike<Real>(state.far_depth, wish.near_depth, kFarDepthStepMax);
  }
  return tap;
}

// A surface that another one partly hides now.
template <typename Real>
LayerTap<Real> far_tap(const LayerHistory& history, const LayerWish& wish, int x, int y) {
  const auto state = state_at<Real>(history, x, y);
  const Real least = Real(wish.far_depth) * (1 - kFarDepthStepMax);
  const Real most = .5 * (Real(wish.near_depth) + wish.far_depth);
  if (state.has_two() && wish.far_depth > state.between()) {  // it was the near layer
    const Pixel& near = history.near[history.texel(x, y)];
    const Real coverage = near[3];
    const Real divisor = max(coverage, kNearCoverageMin);
    return {{near[0] / divisor, near[1] / divisor, near[2] / divisor, 1},
            state.near_confidence * coverage,
            state.near_alpha / divisor,
            coverage >= kNearCoverageMin && state.near_depth >= least && state.near_depth <= most};
  }
  LayerTap<Real> tap = far_of<Real>(history, x, y);
  tap.is_valid = tap.confidence > 0 && state.far_depth >= least && state.far_depth <= most;
  return tap;
}

// A surface before another one. Where history shows what lies behind it, there was nothing of it.
template <typename Real>
LayerTap<Real> near_tap(const LayerHistory& history, const LayerWish& wish, int x, int y) {
  const auto state = state_at<Real>(history, x, y);
  const Real between = .5 * (Real(wish.near_depth) + wish.far_depth);
  const bool was_near = state.has_two() && wish.near_depth > state.between();
  const Real shown = was_near ? state.near_depth : state.far_depth;
  LayerTap<Real> tap = far_of<Real>(history, x, y);
  const double nearer = wish.may_cross ? kCrossingDepthStepMax : kNearDepthStepMax;
  const bool is_behind = wish.may_cross && !(shown >= Real(wish.near_depth) * (1 - kCrossingDepthStepMax));
  if (!(shown <= Real(wish.near_depth) * (1 + nearer))) {  // something hid it, or has no depth
    tap.is_valid = false;
  } else if (is_behind || !(shown > between)) {
    tap.value = {};
    tap.alpha = 0;
    tap.confidence = min(tap.confidence, kEmptyConfidenceMax);
  } else if (was_near) {
    tap.value = as<Real>(history.near[history.texel(x, y)]);
    tap.alpha = state.near_alpha;
    tap.confidence = state.near_confidence;
  } else if (state.has_two()) {
    tap.confidence = min(tap.confidence, kEmptyConfidenceMax);
  }
  return tap;
}

template <typename Real>
LayerTap<Real> tap_of(const LayerHistory& history, const LayerWish& wish, int x, int y) {
  if (wish.layer == Layer::kOnly) return only_tap<Real>(history, wish, x, y);
  if (wish.layer == Layer::kFar) return far_tap<Real>(history, wish, x, y);
  return near_tap<Real>(history, wish, x, y);
}

// Whether one of the 4 x 4 texels around texel (x, y) + fraction has two layers.
bool is_any_split(const LayerHistory& history, int x, int y) {
  for (int row = y - 1; row <= y + 2; ++row) {
    for (int column = x - 1; column <= x + 2; ++column) {
      if (history.has_two(std::clamp(column, 0, history.width - 1), std::clamp(row, 0, history.height - 1)))
        return true;
    }
  }
  return false;
}

template <typename Real>
Real fourth_power(double root) {
  const Real square = Real(root) * root;
  return square * square;
}

}  // namespace

std::size_t LayerHistory::tile(int x, int y) const {
  return index_of((width + kTile - 1) / kTile, x / kTile, y / kTile);
}

bool LayerHistory::has_two(int x, int y) const {
  return std::signbit(far[texel(x, y)][3]);
}

template <typename Real>
LayerStateOf<Real> state_at(const LayerHistory& history, int x, int y) {
  const std::size_t tile = history.tile(x, y);
  if (history.layers[tile].is_layered) {
    const StoredState& stored = history.states[history.texel(x, y)];
    return {fourth_power<Real>(stored.far_root), fourth_power<Real>(stored.near_root), stored.near_confidence,
            stored.near_alpha};
  }
  const Frame& frame = history.frame;
  const auto nearest = [&](int texel, int axis, double jitter, int size) {
    const double phase = history.tiles[tile].reprojection.phase[static_cast<std::size_t>(axis)];
    const Real spacing = history.spacing(axis);
    const Real start = Real(.5 + jitter) * spacing;
    return floor_within((Real(texel + .5) + phase - start) / spacing + .5, 0, size - 1);
  };
  const int column = nearest(x, 0, frame.jitter_x, frame.width);
  const int row = nearest(y, 1, frame.jitter_y, frame.height);
  return {frame.depth[index_of(frame.width, column, row)]};
}

template <typename Real>
FetchedLayer<Real> fetch_layer(const LayerHistory& history, LayerWish wish, const std::array<Real, 2>& place,
                               bool is_rigid) {
  const std::array<int, 2> size = {history.width, history.height};
  // The texels there hold their picture at a phase of their own: the near layer's where it is what is wanted.
  std::array<Real, 2> at;
  std::array<int, 2> inside;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    at[axis] = clamp(place[axis], -kFarthestPlace, kFarthestPlace);
    inside[axis] = floor_within(at[axis], 0, size[axis] - 1);
  }
  const std::size_t tile = history.tile(inside[0], inside[1]);
  const std::array<double, 2>& far_phase = history.tiles[tile].reprojection.phase;
  const std::array<double, 2>& near_phase = history.layers[tile].phase;
  const std::array<double, 2>& first_phase = wish.layer == Layer::kNear ? near_phase : far_phase;
  std::array<int, 2> texel;
  for (std::size_t axis = 0; axis < 2; ++axis)
    texel[axis] = truncate_within(at[axis] - first_phase[axis], 0, size[axis] - 1);
  const bool was_split = history.has_two(texel[0], texel[1]);
  bool takes_near = was_split && wish.layer == Layer::kNear;
  if (was_split && wish.layer == Layer::kOnly)
    takes_near = wish.near_depth > state_at<Real>(history, texel[0], texel[1]).between();
  wish.tests_depth = was_split;
  const std::array<double, 2>& phase = takes_near ? near_phase : far_phase;

  FetchedLayer<Real> fetched;
  std::array<Real, 2> from;  // 0 on the first texel
  for (std::size_t axis = 0; axis < 2; ++axis) {
    from[axis] = at[axis] - phase[axis] - .5;
    if (from[axis] < -.5 || from[axis] > size[axis] - .5) return fetched;
  }
  fetched.was_split = was_split;
  if (is_rigid) {
    std::array<int, 2> nearest;
    bool is_copied = true;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      nearest[axis] = floor_within(from[axis] + .5, 0, size[axis]);
      is_copied = is_copied && abs(from[axis] - nearest[axis]) < kCopiedOffsetMax;
    }
    if (is_copied) {
      fetched.texel = nearest;
      const auto tap =
          tap_of<Real>(history, wish, std::min(nearest[0], size[0] - 1), std::min(nearest[1], size[1] - 1));
      if (tap.is_valid) fetched.value = tap.value;
      if (tap.is_valid) fetched.confidence = tap.confidence;
      if (tap.is_valid) fetched.alpha = tap.alpha;
      return fetched;
    }
  }
  std::array<Real, 2> fraction;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Split<Real> parts = split(from[axis]);
    texel[axis] = parts.whole;
    fraction[axis] = parts.fraction;
    fetched.texel[axis] = parts.whole + (parts.fraction >= .5 ? 1 : 0);
  }
  if (wish.layer == Layer::kOnly && !is_any_split(history, texel[0], texel[1])) {
    // As in resolve_temporal: confidence is resampled like colours.
    const auto blended = blend_taps(history, texel, fraction, kHistorySharpness, [&](int x, int y) {
      return LayerTap<Real>{as<Real>(history.far[history.texel(x, y)]), 0, far_of<Real>(history, x, y).alpha};
    });
    fetched.value = blended.value;
    fetched.alpha = blended.alpha;
    fetched.confidence = clamp(blended.value[3], 0, kConfidenceMax);
    fetched.value[3] = 1;
  } else {
    const auto blended = blend_taps(history, texel, fraction, kHistorySharpness,
                                    [&](int x, int y) { return tap_of<Real>(history, wish, x, y); });
    fetched.value = blended.value;
    fetched.confidence = blended.confidence;
    fetched.alpha = blended.alpha;
  }
  fetched.between = between_texels(fraction);
  return fetched;
}

template LayerStateOf<double> state_at(const LayerHistory&, int, int);
template LayerStateOf<Bounded> state_at(const LayerHistory&, int, int);
template FetchedLayer<double> fetch_layer(const LayerHistory&, LayerWish, const std::array<double, 2>&, bool);
template FetchedLayer<Bounded> fetch_layer(const LayerHistory&, LayerWish, const std::array<Bounded, 2>&,
                                           bool);

}  // namespace quincunx::reference
