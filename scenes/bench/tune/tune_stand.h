// SPDX-License-Identifier: MIT
// TuneStand: the frames of one case of --tune, and the images that they are resolved into.
#pragma once

#include <string>

#include "bench/harness/copy_kernel.h"
#include "bench/speed_error/frame_feed.h"
#include "bench/tune/tune_choice.h"
#include "programs/frame_source.h"
#include "quincunx/resolve_service.h"

namespace quincunx::bench {

struct TuneCase {
  std::string name;
  ResolveSettings resolve;
  bool only_camera_moves = false;
  bool has_parts = false;  // particles at half the scale, and a focus
};

struct TuneEffort {
  static constexpr int kWarmUp = 3;  // frames that do not count

  Extent output;
  int frames = 8;  // of each way to resolve
  double fps = 60;
};

// One thread, that of the GL context.
class TuneStand {
 public:
  // Errors: those of the frames and of the device.
  static Result<TuneStand> create(const scenes::FrameSource& stage, const TuneCase& what,
                                  const TuneEffort& effort);

  FrameFeed& feed() { return feed_; }
  const ResolvePlan& plan() const { return plan_; }

  // Milliseconds of the copy, by the clock that the device's passes have.
  Result<double> time_copy();

  // Resolves a frame of the feed and waits. Adds the time of each pass to `times`, if not null.
  Status resolve(ResolveService& service, FrameInputs inputs, PassTimes* times);

 private:
  TuneStand(Device device, FrameFeed feed, ResolvePlan plan, CopyKernel copy)
      : device_(std::move(device)), feed_(std::move(feed)), plan_(std::move(plan)), copy_(std::move(copy)) {}
  Status allocate();

  Device device_;
  FrameFeed feed_;
  ResolvePlan plan_;
  CopyKernel copy_;
  Image resolved_, blurred_, presented_;
  Image other_;  // that is faded from
};

}  // namespace quincunx::bench
