// SPDX-License-Identifier: MIT
// RenderOptions: what the command line of quincunx-render asks for, and in it PacingOptions: what it says of resolution
// control.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frames/picture_options.h"
#include "session/frame_pacing.h"
#include "session/paced_loop.h"
#include "tools/program/command_line.h"

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

LadderSettings ladder_for(const PacingOptions& options, Extent output);

// Returns one without a display where no rate is asked for. `front`: for a controller that chooses the method. Errors:
// kInvalidArgument, naming the option; kIoFailure for a calibration file that cannot be read.
Result<FramePacing> frame_pacing_for(const PacingOptions& options, Extent output,
                                     const ErrorFront& front = ErrorFront::built_in());

struct RenderOptions : PictureOptions {
  PacingOptions pacing;

  int truth = 0;       // 0: off; N: N x N samples a pixel
  double shutter = 0;  // part of a frame's time for which truth's shutter is open

  int score = 0;  // 0: off; N: frames are measured against N x N samples a pixel

  std::string why;  // file of a picture of what methods make of the scene, instead of a run; empty: none

  std::string out;              // pattern; empty: no frames are written
  std::string contact_sheet;    // empty: none
  std::int64_t exr_frame = -1;  // this frame's targets are written beside `out`; -1: none
  std::string report;           // base name of .txt and .json; empty: none
  bool overlap = true;
  bool explain = false;
  bool json = false;

  bool window = false;           // show the frames in a window; `frames` 0: until it is closed
  std::string script;            // file of keys for the window; empty: none
  std::string captures = "out";  // folder of the window's screenshots and dumps
  bool show_ui = true;
  bool vsync = true;

  std::string command_line;  // as typed, for the report
};

// Returns the table of options; they write into `options`, which must outlive the parsing.
tools::CommandLine command_line(RenderOptions& options);

// Reads a command line. On --help, --version or an error it prints and gives the exit code instead.
std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options);

}  // namespace quincunx::scenes
