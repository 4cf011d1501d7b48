// SPDX-License-Identifier: MIT
// resolve_layers and display_layers on inputs that are made: the same on the device and for the references.
#pragma once

#include <vector>

#include "../reference/resolve_layers.h"
#include "pass_rig.h"
#include "temporal_fixture.h"

namespace quincunx::testing {

// The inputs of the passes. Some tiles are layered, in either frame. Values that no kernel stores are poison: near
// colours of texels of one layer, and states of tiles that are not layered.
struct LayerStageInputs {
  StageInputs stage;
  reference::ResolveInputs reference;
  FrameInputs previous;        // with depth
  std::vector<Pixel> picture;  // far layer of the previous history
};

std::vector<LayerTile> to_kernel(const std::vector<reference::LayerTile>& tiles);
std::vector<TileReprojection> reprojections_of(const std::vector<reference::Tile>& tiles);
std::vector<TileLight> lights_of(const std::vector<reference::Tile>& tiles);
cl::Buffer states_to_device(const std::vector<reference::StoredState>& states);
ImageView view_of(const cl::Buffer& buffer);

class LayerStages {
 public:
  explicit LayerStages(const StageVariant& variant, TemporalPreset preset = TemporalPreset::kBalanced);

  LayerStageInputs inputs(Rig& rig, const StageSpec& spec) const;

  // Bytes were 0x7f before.
  struct Resolved {
    std::vector<unsigned char> far, near, states;
    std::vector<unsigned char> alpha;  // only from variants that have it
    std::int64_t non_finite = 0;
  };
  Resolved run_resolve(Rig& rig, const LayerStageInputs& in);

  // The picture after the near layer of the previous history has been laid over it.
  std::vector<Pixel> run_display(Rig& rig, const LayerStageInputs& in);

 private:
  StageVariant variant_;
  TemporalStages stages_;
  PassRig resolve_;
  PassRig display_;
};

}  // namespace quincunx::testing
