// SPDX-License-Identifier: MIT
// A history whose texels may have two layers, and reading it: the specification of kernels/include/layers/layer.h and
// fetch_layers.h. Depths are reversed: the nearer, the larger.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "history_sampling.h"
#include "layers.h"

namespace quincunx::reference {

// A texel of a layered tile, besides its colours, as it is stored: depths as their fourth roots.
struct StoredState {
  double far_root = 0, near_root = 0, near_confidence = 0;
  double near_alpha = 0;  // alpha of the near layer, times its coverage; 0 where the history has no alpha
};

template <typename Real>
struct LayerStateOf {
  Real far_depth = 0;   // depth of the far layer, or of the only one
  Real near_depth = 0;  // 0: there is one layer
  Real near_confidence = 0;
  Real near_alpha = 0;

  bool has_two() const { return near_depth > 0; }
  Real between() const { return .5 * (far_depth + near_depth); }
};

// All that a frame leaves to the next, and its samples.
struct LayerHistory {
  int width = 0;  // width of the output
  int height = 0;
  std::vector<Pixel> far;     // colour and confidence W of the far, or only, layer; -W where there are two
  std::vector<double> alpha;  // alpha of the far, or only, layer; empty: 1
  std::vector<Pixel> near;    // colour, times coverage, and coverage, where there are two
  std::vector<StoredState> states;  // in layered tiles
  std::vector<Tile> tiles;
  std::vector<LayerTile> layers;
  Frame frame;  // its extent, jitter and depth

  std::size_t texel(int x, int y) const { return index_of(width, x, y); }
  std::size_t tile(int x, int y) const;  // returns the texel's tile
  bool has_two(int x, int y) const;      // whether the texel has two layers
  double spacing(int axis) const {       // output pixels between neighbouring samples
    return axis == 0 ? static_cast<double>(width) / frame.width : static_cast<double>(height) / frame.height;
  }
};

// Returns the state of a texel. Where none is stored it has one layer, of the depth of the sample nearest to its
// picture.
template <typename Real>
LayerStateOf<Real> state_at(const LayerHistory& history, int x, int y);

// Coverage from which a near layer may stand for a surface alone.
constexpr double kNearCoverageMin = .3;
constexpr double kShownCoverageMin = .02;  // from which a near layer has a colour, and an alpha

// A texel of a layer.
template <typename Real>
struct LayerTap {
  PixelOf<Real> value = {};  // colour, times coverage, and coverage
  Real confidence = 0;
  Real alpha = 0;        // alpha, times coverage
  bool is_valid = true;  // false: the texel shows another surface
};

// A texel as the near layer before depth `between` has it. A texel of one layer counts as its colour and 1 if it is
// nearer than that, else as 0.
template <typename Real>
LayerTap<Real> near_texel(const LayerHistory& history, const Real& between, int x, int y) {
  const std::size_t texel = history.texel(x, y);
  const auto state = state_at<Real>(history, x, y);
  const bool is_opaque = history.alpha.empty();
  if (history.has_two(x, y)) {
    const PixelOf<Real> near = as<Real>(history.near[texel]);
    return {near, 0, is_opaque ? near[3] : state.near_alpha};
  }
  if (!(state.far_depth > between)) return {};
  const Pixel& alone = history.far[texel];
  return {{alone[0], alone[1], alone[2], 1}, 0, is_opaque ? 1 : history.alpha[texel]};
}

template <typename Real>
struct BlendedTaps {
  PixelOf<Real> value = {};
  Real confidence = 0;
  Real alpha = 0;
  bool is_known = false;
};

// Parts of 1: of all taps' weights, below which they are no cubic any more; of the middle four's, below which nothing
// is known.
constexpr double kCubicWeightMin = .5;
constexpr double kBilinearWeightMin = 1e-3;

// Keys' cubic at texel (x, y) + fraction, with his parameter `a`, over those of the 4 x 4 texels that are valid, in the
// range of the middle four of those. Confidence is bilinear, 0 where a texel is not valid. `tap`: LayerTap of a texel.
template <typename Real, typename Taps>
BlendedTaps<Real> blend_taps(const LayerHistory& history, const std::array<int, 2>& texel,
                             const std::array<Real, 2>& fraction, double a, Taps tap) {
  const std::array<Real, 4> wx = cubic_weights(fraction[0], a);
  const std::array<Real, 4> wy = cubic_weights(fraction[1], a);
  using Channels = std::array<Real, 5>;  // those of a pixel, and alpha
  Channels sum = {}, middle = {}, low = {}, high = {};
  Real weights = 0, middle_weights = 0;
  BlendedTaps<Real> blended;
  bool is_first = true;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const LayerTap<Real> at = tap(std::clamp(texel[0] + column - 1, 0, history.width - 1),
                                    std::clamp(texel[1] + row - 1, 0, history.height - 1));
      if (!at.is_valid) continue;
      const Real weight = wx[static_cast<std::size_t>(column)] * wy[static_cast<std::size_t>(row)];
      weights += weight;
      const Channels value = {at.value[0], at.value[1], at.value[2], at.value[3], at.alpha};
      for (std::size_t c = 0; c < 5; ++c)
        sum[c] += value[c] * weight;
      if (row % 3 == 0 || column % 3 == 0) continue;
      const Real share =
          (column == 1 ? 1 - fraction[0] : fraction[0]) * (row == 1 ? 1 - fraction[1] : fraction[1]);
      middle_weights += share;
      blended.confidence += at.confidence * share;
      for (std::size_t c = 0; c < 5; ++c) {
        middle[c] += value[c] * share;
        low[c] = is_first ? value[c] : min(low[c], value[c]);
        high[c] = is_first ? value[c] : max(high[c], value[c]);
      }
      is_first = false;
    }
  }
  if (is_first || middle_weights < kBilinearWeightMin) return {};
  blended.is_known = true;
  const bool is_cubic = weights >= kCubicWeightMin;
  for (std::size_t c = 0; c < 5; ++c) {
    Real& channel = c < 4 ? blended.value[c] : blended.alpha;
    channel = is_cubic ? clamp(sum[c] / weights, low[c], high[c]) : middle[c] / middle_weights;
  }
  return blended;
}

// The kinds of layers that a pixel asks history for.
enum class Layer {
  kOnly,  // a surface of depth near_depth, alone
  kFar,   // the one of depth far_depth behind another
  kNear,  // the one of depth near_depth before another
};
struct LayerWish {
  Layer layer = Layer::kOnly;
  double near_depth = 0, far_depth = 0;
  bool may_cross = false;  // for kNear: another near layer of the tile may cross it
  // With kOnly: texels of one layer must not be nearer. Set by fetch_layer where the texel there has two, as then no
  // trust tells.
  bool tests_depth = false;
};

template <typename Real>
struct FetchedLayer {
  PixelOf<Real> value = {};  // colour, times coverage, and coverage
  Real confidence = 0;       // 0: nothing is known
  Real alpha = 0;            // alpha, times coverage
  Real between = 0;          // as of FetchedHistory
  std::array<int, 2> texel = {};
  bool was_split = false;  // the texel at that place has two layers
};

// Returns the layer of history at `place`, output pixels of the previous frame; `is_rigid`: the layer that wishes.
template <typename Real>
FetchedLayer<Real> fetch_layer(const LayerHistory& history, LayerWish wish, const std::array<Real, 2>& place,
                               bool is_rigid);

}  // namespace quincunx::reference
