// SPDX-License-Identifier: MIT
// PresentationBacklog: how far the device is behind the display, in ms.
//
// At 0 it finished in time for the refresh before the one it has to meet, and now waits for a free buffer; the
// queue is full. At slack() it finished just in time. Beyond that a refresh is missed, and the backlog starts
// again one refresh lower. Each frame adds its time and takes away one refresh interval. As the phase of the
// display is not known, the backlog is taken for the worst until the queue is seen full, and again after a
// missed refresh that was not expected.
#pragma once

namespace quincunx {

class PresentationBacklog {
 public:
  explicit PresentationBacklog(int buffers) : buffers_(buffers) {}

  struct Frame {
    double gpu_ms;
    double cpu_ms;
    double interval_ms;
    int queued;
    int missed_vsyncs;
  };
  void observe(const Frame& frame, double refresh_ms);

  double now() const { return backlog_; }
  double slack(double refresh_ms) const { return (buffers_ - 2) * refresh_ms; }

 private:
  int buffers_;
  double backlog_ = 0;
  double last_gpu_ms_ = 0;
  bool certain_ = false;
};

}  // namespace quincunx
