// SPDX-License-Identifier: MIT
// The measurements of quincunx-bench --resize: the cost of targets of another size, by each way to have them, and whole
// frames with viewport targets and with placed ones, beside each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/resize/resize_command.h"
#include "bench/speed_error/bench_plan.h"
#include "frames/frame_source.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct ResizeSettings {
  Extent largest;
  int resizes = 0;  // counted ones for each way
  std::uint64_t seed = 0;
};

// Host times with nothing else at work: GL is waited for before each resize. The context of `stage` is current.
Result<std::vector<ResizeCost>> measure_resizes(const scenes::FrameSource& stage,
                                                const ResizeSettings& settings);

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
