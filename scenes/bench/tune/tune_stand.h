// SPDX-License-Identifier: MIT
// TuneStand: the frames of one case of --tune and the images that they are resolved into; the cases, and how they are
// timed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/harness/copy_kernel.h"
#include "bench/speed_error/contender.h"
#include "bench/tune/tune_choice.h"
#include "frames/frame_source.h"
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
  int frames = 8;  // for each way to resolve
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
  Image linear_, presented_;
  Image other_;  // that is faded from
};

// Methods and options that together run every pass but those that seldom run (clear_region, resize_*).
std::vector<TuneCase> tune_cases();

// Those of these names, or all where there are none. Errors: kInvalidArgument for another name.
Result<std::vector<TuneCase>> tune_cases(const std::vector<std::string>& names);

// All profiles were used in each round, one after the other, each time another one first, after the copy.
struct CaseTimes {
  Samples copy_ms;
  ShapeTimes shapes;
};

// By the clock that the device's passes have. One thread, that of the GL context. Errors: those of the frames, and of
// the first profile; another profile that the device refuses has no times.
Result<CaseTimes> time_case(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                            std::span<const DeviceProfile> profiles);

// Measures what it costs that a frame's inputs are images, not buffers, and that history is kept in floats, not in
// halves: of those cases that are a method and nothing else, with the profile. One thread, that of the GL context.
// Errors: those of the frames and the device.
Result<std::vector<TunedStorage>> time_storages(const scenes::FrameSource& stage,
                                                const std::vector<TuneCase>& cases, const TuneEffort& effort,
                                                const DeviceProfile& profile);

}  // namespace quincunx::bench
