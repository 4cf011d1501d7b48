// SPDX-License-Identifier: MIT
// resolve_layers and display_layers, of pixels that may have two layers: the specification. error_bound.h tells what
// `Real` may be.
#pragma once

#include <vector>

#include "layer_history.h"

namespace quincunx::reference {

// The inputs of resolve_layers.
struct ResolveInputs {
  TemporalInputs now;  // its frame with depth; what it holds of history counts for nothing
  std::vector<Tile> tiles;
  std::vector<LayerTile> layers;
  std::vector<double> open_trust;  // one for each sample: trust without a comparison of depths
  std::vector<LayerSplit> splits;  // one for each sample
  LayerHistory past;

  bool has_alpha() const { return !past.alpha.empty(); }
};

// A texel of a layered tile.
template <typename Real>
struct LayeredTexelOf {
  PixelOf<Real> far = {};  // colour and W of the far, or only, layer; -W where there are two
  Real alpha = 1;          // alpha of the far, or only, layer
  PixelOf<Real> near = {};
  std::array<Real, 4> state = {};  // as StoredState
  bool is_split = false;           // else there is no near layer
};

// resolve_layers: the texel of output pixel (x, y), of a layered tile, after this frame.
template <typename Real>
LayeredTexelOf<Real> resolve_layers(const ResolveInputs& in, int x, int y);

// display_layers: output pixel (x, y) after the near layer of `history` has been laid over `picture`, what
// temporal_display has made of the pixel.
template <typename Real>
PixelOf<Real> display_layers(const LayerHistory& history, const Pixel& picture, int x, int y);

}  // namespace quincunx::reference
