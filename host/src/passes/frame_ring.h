// SPDX-License-Identifier: MIT
// FrameRing: the frames that are in flight, with their events, until their reports are taken.
//
// Everything is allocated at creation. begin() waits only where all kFrames frames are still at work.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "device/opencl.h"
#include "passes/pass_measure.h"
#include "picture_params.h"
#include "quincunx/frame.h"

namespace quincunx {

class FrameRing {
 public:
  static constexpr int kFrames = 64;

  struct Slot {
    FrameReport report;
    std::array<cl::Event, PassReports::max_size()> passes;
    cl::Event done;                // last command of the frame
    std::uint32_t non_finite = 0;  // this and the sums: written by non-blocking reads that `done` covers
    ContentSums content = {};
    bool measures_content = false;
    MotionSums motion = {};
  };

  // Whether the passes' events have their times; where not, reports keep those that they have.
  explicit FrameRing(bool events_have_times) : events_have_times_(events_have_times) {}

  // The slot of a new frame, empty; where the ring is full the oldest report is dropped. The frame is in the
  // ring only after commit().
  Slot& begin();
  void commit() { ++next_; }

  int index_of(const Slot& slot) const { return static_cast<int>(&slot - slots_.data()); }  // in [0, kFrames)

  // The oldest finished frame that was not taken yet.
  std::optional<FrameReport> next_completed();

 private:
  bool events_have_times_;
  MotionWatch watch_;
  std::array<Slot, kFrames> slots_;
  std::uint64_t next_ = 0;   // frames begun and committed
  std::uint64_t taken_ = 0;  // how many of those were taken or dropped
};

}  // namespace quincunx
