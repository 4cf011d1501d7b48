// SPDX-License-Identifier: MIT
// Supersampled truth from the same renderer: a box of n x n samples a pixel at output size, optionally
// integrated over the shutter.
#pragma once

#include <vector>

#include "render/renderer.h"

namespace quincunx::scenes {

struct TruthSettings {
  Extent output;
  int samples = 8;             // n: n * n samples a pixel, >= 1
  double shutter_seconds = 0;  // the shutter is open from seconds - shutter_seconds to seconds; 0: an instant
  ViewWindow window = {};      // the part of the picture that `output` is
  float aspect = 0;            // aspect of the whole picture, width / height; 0: that of `output`
};

// Linear RGBA, output extent, tightly packed, top row first. Textures are filtered for the sample spacing
// (LOD bias -log2 n). Sub-samples differ in place and, with a shutter, in time (stratified in both, fixed
// pattern). Errors as Renderer::draw.
Result<std::vector<float>> render_truth(Renderer& renderer, const TruthSettings& settings, double seconds);

}  // namespace quincunx::scenes
