// SPDX-License-Identifier: MIT
// The costs of the last frames: for tables (FrameTrace), and as a live graph.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "window/live_picture.h"

namespace quincunx::scenes {

struct TracePoint {
  double area = 0;          // pixels drawn, part of the output's
  double draw_ms = 0;       // OpenGL
  double opencl_ms = 0;     // all passes
  double cpu_ms = 0;        // the processor's part of drawing
  double interval_ms = 0;   // since the frame before
  int dropped = 0;          // refreshes that this frame missed
  std::string method = {};  // that a controller chose; empty: none did
};

struct PassTime {
  std::string kernel;
  double ms = 0;  // running mean
};

class FrameTrace {
 public:
  static constexpr std::size_t kLength = 240;

  // `method`: that a controller chose; empty: none did.
  void add(const FrameTimes& times, Extent output, double interval_ms, int dropped,
           const std::string& method = {});

  const std::vector<TracePoint>& points() const { return points_; }  // oldest first
  const std::vector<PassTime>& passes() const { return passes_; }    // the last frame's passes, in order
  const TracePoint& mean() const { return mean_; }                   // running
  int dropped() const { return dropped_; }                           // in all

 private:
  std::vector<TracePoint> points_;
  std::vector<PassTime> passes_;
  TracePoint mean_;
  int dropped_ = 0;
};

// Draws resolution above, times below and dropped frames as marks, by Dear ImGui, as wide as its window has room.
// `target_ms` 0: no line for it.
void draw_frame_graph(const FrameTrace& trace, double target_ms);

}  // namespace quincunx::scenes
