// SPDX-License-Identifier: MIT
// The default resolution controller: predicts the next frame's time, and uses the slack of the display's queue.
//
// Its model has three parts:
//   a level: the time that a frame would take at the output resolution;
//   the part of that which does not scale with the pixels;
//   the backlog: the device's distance behind the display, from 0 (it waits for a free buffer) to the slack
//   that the buffers give (beyond it a refresh is missed).
// It aims just below the target while the backlog is small, lower in proportion to the backlog, and never so high that
// one more frame like the worst one seen would use up the slack. A single slow frame changes nothing while there is
// slack; two in a row count as a step and are answered at once. docs/control.md has the algorithm, and
// docs/lab/control.md its figures.
//
// It uses the following, if known: interval_ms or queued (else the backlog is only computed), next_frame
// (timers that come back late), missed_vsyncs (surprises make it careful until the queue is seen full again),
// cpu_ms, blur_px.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "quincunx/advanced/export.h"
#include "quincunx/control/cost_table.h"
#include "quincunx/control/resolution_controller.h"

namespace quincunx {

enum class CpuBound : std::uint8_t {
  kHold,    // while the processor needs longer than target and device, the resolution never rises
  kFollow,  // instead, the median of its last five times, at most twice the target, becomes the target
};

// Motion blur hides detail: the longer its streaks, the lower the resolution may be. Off unless asked for.
struct BlurAware {
  bool enabled = false;
  double start_px = 4;      // mean streak, output pixels, from which it counts
  double full_px = 24;      // from which min_scale is the limit; above start_px
  double min_scale = 0.71;  // per axis, in (0, 1]; figure 10 of Binks 2012
};

struct PredictiveSettings {
  LadderSettings ladder = {};
  double target_ms = 1000.0 / 60;
  // Buffers of the swap chain, the one on the screen and the one drawn included; in [2, 8]. With 2 there is no slack:
  // every frame has to fit, and recurring slow frames lower the resolution.
  int buffers = 3;
  double fixed_part = 0.25;  // first guess of the part that does not scale, in [0, 0.9]
  std::optional<CostTable> calibration = std::nullopt;  // replaces that guess, if it spans enough resolutions
  CpuBound cpu_bound = CpuBound::kHold;
  BlurAware blur_aware = {};
};

// Makes the controller. Errors: kInvalidArgument for a field outside its range.
QUINCUNX_API Result<std::unique_ptr<ResolutionController>> make_predictive_controller(
    const PredictiveSettings& settings);

}  // namespace quincunx
