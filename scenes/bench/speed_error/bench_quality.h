// SPDX-License-Identifier: MIT
// QualityTally: the errors of one method, gathered frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/regions.h"
#include "render/renderer.h"
#include "tools/image/image_metrics.h"

namespace quincunx::bench {

// One thread at a time.
class QualityTally {
 public:
  // The measured frames in order.
  void add(tools::MeasuredPicture picture, const tools::MeasuredPicture& truth,
           const tools::MeasuredPicture* previous_truth, const FrameMasks& masks);

  // At least one frame.
  Quality quality() const;

  const tools::MeasuredPicture& latest() const { return *latest_; }

 private:
  // The error over some pixels of all frames.
  struct PartError {
    double squares = 0;
    std::int64_t count = 0;

    void add(double squared_error);
    std::optional<double> psnr() const;  // dB; nothing where there is no pixel
    double mean_square() const { return squares / static_cast<double>(count); }
  };

  int frames_ = 0;
  Quality worst_;  // only the fields of the worst window count
  double error_ = 0, error_linear_ = 0, ssim_ = 0, flip_ = 0, p99_ = 0, relative_ = 0, flicker_ = 0;
  PartError disoccluded_;
  PartError focus_, outside_;
  std::array<PartError, kRegions> regions_;
  std::int64_t non_finite_ = 0;
  std::optional<tools::MeasuredPicture> latest_;
};

// The true pictures of a scene's measured frames, and what their pixels show: one truth for all scales and methods.
struct SceneTruth {
  std::vector<tools::MeasuredPicture> pictures;  // one for each measured frame, exposed
  std::vector<FrameMasks> masks;                 // one for each measured frame
  std::optional<double> flicker;                 // mean change of luma from frame to frame
  double disoccluded_part = 0;                   // share of all pixels
  RegionFigures region_part;                     // shares of all pixels
};

// Makes the truth of the measured frames. Pictures are kept below "truth" in the cache folder, under a key of all that
// determines them: scene, seed, time, size, samples, OpenGL driver, shaders, and the same moment drawn with one sample
// a pixel, which differs when a scene has changed. Throws a Failure where a step fails.
SceneTruth make_truth(scenes::Renderer& renderer, const scenes::Scene& scene, const std::string& gl_version,
                      const Conditions& conditions);

}  // namespace quincunx::bench
