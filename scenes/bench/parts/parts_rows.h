// SPDX-License-Identifier: MIT
// One row of quincunx-bench --parts: frames of one scale of the picture and of its parts.
#pragma once

#include <string>

#include "bench/parts/parts_command.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_quality.h"
#include "frames/frame_source.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct PartScene {
  const scenes::FrameSource& stage;
  const BenchPlan& plan;  // its first method counts
  const SceneTruth& truth;
};

struct PartCase {
  std::string part;
  std::string label;
  double scale = 1;  // scale of the picture
  scenes::PartsSettings parts;
};

// Frames one after the other, so that the shadow map keeps its size from one to the next; the measured ones are those
// of the truth, after the plan's warm-up. One thread, that of the GL context.
Result<PartRow> measure_row(const PartScene& scene, const PartCase& wanted);

}  // namespace quincunx::bench
