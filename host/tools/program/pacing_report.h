// SPDX-License-Identifier: MIT
// PacingRun: how the frames of a run met a display's refreshes, frame by frame and in figures.
//
// Plain data and pure functions of it; no device and no clock. Times are milliseconds from the run's first
// refresh, at which its first frame is shown; times before it are negative.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/content_statistics.h"
#include "quincunx/advanced/extent.h"

namespace quincunx::tools {

struct PacedFrame {
  std::int64_t index = 0;
  Extent render = {};
  double start_ms = 0;     // work on it began: it was begun and the frame before it was finished
  double finished_ms = 0;  // its picture was complete
  double shown_ms = 0;     // the refresh that showed it
  double busy_ms = 0;      // what it cost, as the controller was told
  double blur_px = 0;      // mean streak of its motion blur, as the controller was told
  int detail = 0;          // level that was left out where detail follows the resolution; 0: none
  double cpu_ms = 0;       // what the processor needed to prepare it; 0: not known
  int queued = 0;          // frames finished and not yet shown when it was finished, itself included
  int missed = 0;          // refreshes without a new frame just before it was shown: dropped frames
  // Where a controller chooses the method, too; else empty.
  std::string method = {};       // the picture was made with
  std::string fading_from = {};  // and with this, of which the picture has the rest; empty: nothing
  double weight = 1;             // weight of `method` in the picture, [0, 1]
  double resolve_ms = 0;         // part of busy_ms that the method's passes took; 0: not known
  std::optional<ContentStatistics> content = {};  // what the frame showed, as the controller was told
};

// A frame before which the controller has changed the method.
struct MethodChange {
  std::int64_t frame = 0;
  std::string from;
  std::string to;
  std::string why;  // lines of text
};

struct PacingRun {
  std::string controller;   // "predictive", "fixed"
  std::string measured_by;  // what busy_ms is, one clause
  double target_fps = 0;
  int buffers = 3;
  Extent output = {};
  std::vector<PacedFrame> frames = {};  // in order
  // Where the controller chooses the method, too: in order, and why it keeps the last one.
  std::vector<MethodChange> method_changes = {};
  std::string reasons = {};
};

struct PacingSummary {
  double achieved_fps = 0;   // frames shown a second, from the first to the last; 0 for a single frame
  int dropped = 0;           // refreshes without a new frame
  int dropped_at_start = 0;  // those in the first second: a controller comes down from the top
  double mean_busy_ms = 0;
  double median_busy_ms = 0;
  double p95_busy_ms = 0;
  int over_target = 0;   // frames whose busy time exceeds a refresh interval
  double mean_area = 0;  // pixels drawn over pixels of the output
  double least_area = 0;
  double largest_area = 0;
  double changes_per_second = 0;  // changes of the render extent, in display time
  double method_changes_per_second = 0;
};

PacingSummary summary_of(const PacingRun& run);

// The run of interest, then those it is compared with: one line each with its figures and, for the others,
// how much faster than them it was; then graphs of the scale and of the busy time of the first. For no runs,
// none.
std::string pacing_text(const std::vector<PacingRun>& runs);

// Draws a run's render ratio as a graph of at most 80 columns by 9 rows, each line ending in a newline: one mark for
// each column of frames at their mean, the axis from the lowest to the highest mean, labelled. Pure. Empty for no
// values.
std::string ratio_graph(std::span<const double> ratios);

}  // namespace quincunx::tools
