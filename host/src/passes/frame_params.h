// SPDX-License-Identifier: MIT
// How the parameters that several kernels have follow from a frame. Pure.
#pragma once

#include <algorithm>

#include "layers/layer.h"
#include "motion/velocity_params.h"
#include "passes/pass.h"
#include "quincunx/frame.h"
#include "temporal/temporal_params.h"

namespace quincunx {

// Returns where samples lie in the picture whose output has this extent.
FarPlaces far_places(const FrameInputs& inputs, Extent output);

CameraVelocity camera_params(const FrameInputs& inputs);

// Returns the factor from uv to the units of a velocity that `scale` takes to uv; a scale of 0 takes all motion away.
float inverse_scale(double scale);

// From samples of a frame to the texel coordinates in the previous one, for passes that follow motion. The texel
// coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands still:
// (i * step_x + start_x, j * step_y + start_y).
struct PreviousPlaces {
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from the units of velocity to pixels of the previous frame, backwards in time
  float edge_x, edge_y;      // the left and the upper edge of the previous frame, as texel coordinates
};

PreviousPlaces previous_places(const FrameInputs& inputs, const FrameInputs& previous);

// Returns how far a sample reaches in resolve_reprojected, in render pixels, on an axis with `render` samples under
// `output` pixels: the fewer samples, the sharper. Within [0.875, 1]; measured, see docs/pipeline.md.
inline double sample_reach(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

// Returns which samples of a frame are shaded: TemporalParams::parity.
int shaded_parity(const PlanFacts& facts, const FrameInputs& inputs);

// Returns those of resolve_temporal and resolve_layers, without reactive values and a view.
TemporalParams temporal_params(const PassFrame& frame, const WorkShape& shape, const PlanFacts& facts);

// `picture`: where it goes.
TemporalDisplayParams temporal_display_params(const PassFrame& frame, const WorkShape& shape,
                                              Resource picture);

// Returns those of layer_records, turn_records, advect_records and layer_split; items along rows of `extent`.
LayerParams layer_params(const PassFrame& frame, const WorkShape& shape, Extent extent);

// Returns the samples of the last frame in a history of extent `output`, for the kernels that read its layers.
HistorySamples history_samples(const FrameInputs& inputs, Extent output, TexelLayout depth);

}  // namespace quincunx
