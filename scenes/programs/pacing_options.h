// SPDX-License-Identifier: MIT
// PacingOptions: what a command line says of resolution control.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "programs/frame_meter.h"
#include "programs/frame_pacing.h"

namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::scenes {

struct PacingOptions {
  double target_fps = 0;  // 0: no resolution control
  ControllerKind controller = ControllerKind::kPredictive;
  double min_scale = 0.5;
  double max_scale = 1;
  AxisOrder order = AxisOrder::kHorizontalFirst;
  int buffers = 3;
  double headroom = 0;
  FrameCost cost = FrameCost::kAuto;
  CpuBound cpu_bound = CpuBound::kHold;
  bool blur_aware = false;
  bool detail_follows = false;
  std::string calibration;             // file that --calibrate wrote; empty: none
  std::string calibrate;               // file to write instead of a run; empty: none
  double truth_seconds = 4;            // with it: the longest that truth may take
  std::vector<float> compared_scales;  // the same frames again, each at one of these

  bool on() const { return target_fps > 0; }
  bool controls() const { return on() && controller != ControllerKind::kFixed; }
  bool chooses_method() const { return on() && controller == ControllerKind::kQuality; }
  bool has_ladder() const { return controls() || !calibrate.empty(); }  // else the scale is given
};

// After --scale and --scale-path, with which they are checked.
void add_pacing_options(tools::CommandLine& app, PacingOptions& options);

// Errors: kInvalidArgument, naming the option.
Result<LadderSettings> ladder_for(const PacingOptions& options, Extent output);

// Nothing where no rate is asked for. `front`: for a controller that chooses the method. Errors: kInvalidArgument,
// naming the option; kIoFailure for a calibration file that cannot be read.
Result<std::optional<FramePacing>> frame_pacing_for(const PacingOptions& options, Extent output,
                                                    const ErrorFront& front = ErrorFront::built_in());

}  // namespace quincunx::scenes
