// SPDX-License-Identifier: MIT
// SceneTruth: what the measured frames of a scene truly look like, and what their pixels show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/regions.h"
#include "render/renderer.h"
#include "tools/image/image_metrics.h"

namespace quincunx::bench {

// One truth for all scales and methods: made once, before anything is timed.
struct SceneTruth {
  std::vector<tools::MeasuredPicture> pictures;  // of each measured frame, exposed
  std::vector<FrameMasks> masks;                 // of each measured frame
  std::optional<double> flicker;                 // mean change of luma from frame to frame
  double disoccluded_part = 0;                   // of all pixels
  RegionFigures region_part;                     // of all pixels
};

// Truth of the measured frames. Pictures are kept on disk, below "truth" in the cache folder of
// cache_folder.h, under a key of all that determines them: scene, seed, time, size, samples, OpenGL driver,
// shaders, and the same moment drawn with one sample a pixel, which tells when a scene has changed.
Result<SceneTruth> make_truth(scenes::Renderer& renderer, const scenes::Scene& scene,
                              const std::string& gl_version, const Conditions& conditions);

}  // namespace quincunx::bench
