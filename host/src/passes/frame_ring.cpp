// SPDX-License-Identifier: MIT
#include "passes/frame_ring.h"

#include <fmt/format.h>

#include <algorithm>

#include "device/device_impl.h"

namespace quincunx {
namespace {

// Device time of one pass; -1 where its event has none.
double milliseconds(const cl::Event& event) {
  cl_ulong start = 0;
  cl_ulong end = 0;
  const cl_event raw = event();
  if (clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_START, sizeof(start), &start, nullptr) !=
          CL_SUCCESS ||
      clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_END, sizeof(end), &end, nullptr) != CL_SUCCESS) {
    return -1;
  }
  return static_cast<double>(end - start) * 1e-6;
}

// Negative where the command failed, and where a lost device does not even tell.
cl_int execution_status(const cl::Event& event) {
  cl_int state = CL_COMPLETE;
  const cl_int code =
      clGetEventInfo(event(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr);
  return code == CL_SUCCESS ? state : code;
}

}  // namespace

FrameRing::Slot& FrameRing::begin() {
  if (next_ - taken_ == kFrames) {
    Slot& oldest = slots_[taken_ % kFrames];
    // The device may still write its counter.
    if (oldest.done() != nullptr && execution_status(oldest.done) > CL_COMPLETE) wait_for(oldest.done);
    ++taken_;
  }
  Slot& slot = slots_[next_ % kFrames];
  slot.report = {};
  slot.passes.fill({});
  slot.done = {};
  slot.non_finite = 0;
  slot.content = {};
  slot.motion = {};
  return slot;
}

std::optional<FrameReport> FrameRing::next_completed() {
  if (taken_ == next_) return std::nullopt;
  Slot& slot = slots_[taken_ % kFrames];
  const cl_int state = execution_status(slot.done);
  if (state > CL_COMPLETE) return std::nullopt;
  FrameReport report = slot.report;
  if (state < 0) {
    report.status = Status::device(
        fmt::format("frame {} failed on the device: {} ({})", report.frame_index, error_name(state), state));
  } else {
    for (std::size_t i = 0; events_have_times_ && i < report.passes.size(); ++i)
      report.passes[i].ms = milliseconds(slot.passes[i]);
    report.non_finite_pixels = slot.non_finite;
    watch_.add(slot.motion);
    report.motion = watch_.check();
    if (slot.measures_content) report.content = statistics_of(slot.content, report.output_extent);
  }
  ++taken_;
  return report;
}

}  // namespace quincunx
