// SPDX-License-Identifier: MIT
// Whole frames with viewport targets and with placed ones, beside each other.
#pragma once

#include <string>
#include <vector>

#include "bench/resize/resize_result.h"
#include "bench/speed_error/bench_plan.h"
#include "programs/frame_source.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct TargetFramesSettings {
  Extent output;
  BenchMethod method;
  std::string scale_path;  // as ScalePath::parse() takes it; empty: `scale`
  double scale = 1;
  int warm_up = 0;
  int frames = 0;
  std::uint64_t seed = 0;
  double fps = 60;
};

// The same frames with both kinds, viewport targets first; in each frame the kinds take turns in going first. On the
// device of `stage`, whose context is current.
Result<std::vector<TargetFrames>> measure_frames(const scenes::FrameSource& stage,
                                                 const TargetFramesSettings& settings);

}  // namespace quincunx::bench
