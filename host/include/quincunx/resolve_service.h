// SPDX-License-Identifier: MIT
// ResolveService: one object, one call a frame.
//
//   auto device = quincunx::Device::open();
//   auto plan = quincunx::plan_for(needs, settings);
//   auto service = quincunx::ResolveService::create(device.value(), plan.value());
//   FrameReport report = service.value().dispatch({.colour = ..., .render_extent = ...}, {.presented = ...});
//
// create() compiles (or loads from the program cache), allocates and warms up. After it a frame allocates nothing,
// compiles nothing and does not wait for the device (exceptions: docs/pipeline.md#time). Calls on one service come from
// one thread at a time, and so do all calls on services of one device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/advanced/pass_timer.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx {

// Checks every field of a frame against a plan without a device. The message names every bad field, what it
// holds and what would be right. Pure; thread-safe.
QUINCUNX_API Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FrameOutputs& outputs);
QUINCUNX_API Status validate(const ResolvePlan& plan, const FrameInputs& inputs, const FocusInputs& focus,
                             const FrameOutputs& outputs);

// How each tile of the output, of 32 x 32 pixels, was blurred: 0 copied (nothing moves there), 1 colour alone
// (everything moves alike), 2 with depth and velocity of each sample.
struct TileKinds {
  Extent tiles;
  std::vector<std::uint8_t> kinds;  // row by row
};

// The order of a frame's work among that of other queues of the device's context.
struct FrameSync {
  std::span<const cl_event> wait_for = {};  // the frame's work begins when all of these are complete
  // Semaphores of another API (advanced/external.h), imported by the service's device. The frame's work begins when all
  // of the former are signalled; it signals all of the latter when it is done, unless the frame was refused or failed.
  // For memory that changes sides call Semaphore::wait() before SharedMemory::acquire(), and signal() after release().
  std::span<Semaphore* const> wait_semaphores = {};
  std::span<Semaphore* const> signal_semaphores = {};
  // If not null, receives an event that is complete when the frame's work is, and that the caller releases; null if the
  // frame was refused or failed.
  cl_event* done = nullptr;
};

// Called with a frame that dispatch() has accepted, before its work is enqueued. The images are complete when
// everything on the device's queue is done. `focus` is null where there is none. Returns whether it wants to see the
// next one, too. It must not dispatch.
using FrameObserver = std::function<bool(const FrameInputs& inputs, const FocusInputs* focus)>;

// Pictures on the way to the finished one.
enum class PictureStage : std::uint8_t {
  kResolved,  // sharpened as planned, without motion blur
  kBlurred,   // with it
};

class QUINCUNX_API ResolveService {
 public:
  // Creates the service of a plan. Errors: kUnsupported when the device lacks what the plan needs, kDeviceFailure with
  // the build's options and log when a kernel does not compile.
  static Result<ResolveService> create(const Device& device, const ResolvePlan& plan);

  // The destructor and the assignment wait for the frames that are under way.
  ~ResolveService();
  ResolveService(ResolveService&&) noexcept;
  ResolveService& operator=(ResolveService&&) noexcept;

  // Enqueues the frame's passes on the device's queue and flushes it. A bad frame is refused whole: the
  // report's status says why, nothing is enqueued, and the history stays. next_completed() will know the times.
  FrameReport dispatch(const FrameInputs& inputs, const FrameOutputs& outputs, const FrameSync& sync = {});

  // Enqueues the same with a focus laid over the finished picture. Nothing outside of its rectangles changes by one
  // bit. A frame without a focus ends the focus's history.
  FrameReport dispatch(const FrameInputs& inputs, const FocusInputs& focus, const FrameOutputs& outputs,
                       const FrameSync& sync = {});

  // Returns the oldest finished frame's report that was not yet taken, with its times and counts; nothing while there
  // is none. Never waits. Reports are kept for the last 64 frames.
  std::optional<FrameReport> next_completed();

  // Allows dispatch() to wait for the end of each pass, so that the host's clock times it. Off at first. It has an
  // effect only on devices whose events have wrong times (PassTimer::kHostClock), where passes have no times otherwise.
  void allow_timing_waits(bool allow);

  // Fills the top left `render` of an image with one value (unused channels ignored; of RGBA8 the encoded one):
  // the partial clear. Enqueued like a frame. Errors: kInvalidArgument when the rectangle is empty or leaves the image.
  Status clear(const ImageView& image, Extent render, const float value[4]);

  // Returns the last frame's picture at a stage, for inspection: as FrameOutputs::linear, in the top left part that is
  // the frame's output extent. Empty where there was no such stage or it gave the finished picture, which the caller
  // has. The service owns the memory; the next dispatch overwrites it.
  ImageView picture(PictureStage stage) const;

  // Returns the last frame's kinds of tiles, for inspection: waits for that frame. Errors: kInvalidArgument where the
  // plan does not blur.
  Result<TileKinds> tile_kinds() const;

  // Returns the history that kTemporal's next frame finds, for inspection: R, G, B, linear, and as alpha the
  // confidence, which is the weight of all samples in it. It has the last frame's output extent and the format
  // settings.temporal.history. Empty where there is none: before the first frame, and after one whose samples are so
  // dense that it keeps none. The service owns the memory; the next dispatch but one overwrites it. Errors:
  // kInvalidArgument where the plan does not accumulate.
  Result<ImageView> history() const;

  // Shows every frame from the next one on to `observer`, which replaces the previous observer; an empty one ends this.
  // The next frame begins without history, so that the pictures follow from the plan and the frames seen alone.
  void observe(FrameObserver observer);

  Status finish();  // waits until every dispatched frame is done

  const ResolvePlan& plan() const;
  const Device& device() const;

 private:
  friend class TwoWay;
  struct QUINCUNX_HIDDEN Impl;
  static Result<ResolveService> create(const Device& device, const ResolvePlan& plan, bool two_way);
  explicit ResolveService(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx
