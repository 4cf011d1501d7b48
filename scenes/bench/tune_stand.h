// SPDX-License-Identifier: MIT
// TuneStand: the frames of one case of --tune and the images that they are resolved into; the cases, and how they are
// timed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/harness/measuring.h"
#include "bench/speed_error/contender.h"
#include "bench/tune.h"
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
  // Throws a Failure where a step fails.
  static TuneStand create(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort);

  FrameFeed& feed() { return feed_; }
  const ResolvePlan& plan() const { return plan_; }

  // Returns the milliseconds of the copy, by the clock that the device's passes have.
  double time_copy();

  // Resolves a frame of the feed and waits. Adds the time of each pass to `times`, if not null.
  void resolve(ResolveService& service, FrameInputs inputs, PassTimes* times);

 private:
  TuneStand(Device device, FrameFeed feed, ResolvePlan plan, CopyKernel copy)
      : device_(std::move(device)), feed_(std::move(feed)), plan_(std::move(plan)), copy_(std::move(copy)) {}
  void allocate();

  Device device_;
  FrameFeed feed_;
  ResolvePlan plan_;
  CopyKernel copy_;
  Image linear_, presented_;
  Image other_;  // that is faded from
};

// Returns methods and options that together run every pass but those that seldom run (clear_region, resize_*).
std::vector<TuneCase> tune_cases();

// Returns the cases of these names, or all where there are none. Errors: kInvalidArgument for another name.
Result<std::vector<TuneCase>> tune_cases(const std::vector<std::string>& names);

// Times of one case. All profiles are used in each round, after the copy, another one first each time.
struct CaseTimes {
  Samples copy_ms;
  ShapeTimes shapes;
};

// Times a case by the clock that the device's passes have. One thread, that of the GL context. Throws a Failure, also
// for the first profile; another profile that the device refuses has no times.
CaseTimes time_case(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                    std::span<const DeviceProfile> profiles);

// Measures what it costs that a frame's inputs are images, not buffers, and that history is kept in floats, not in
// halves: of those cases that are a method and nothing else, with the profile. One thread, that of the GL context.
std::vector<TunedStorage> time_storages(const scenes::FrameSource& stage, const std::vector<TuneCase>& cases,
                                        const TuneEffort& effort, const DeviceProfile& profile);

}  // namespace quincunx::bench
