// SPDX-License-Identifier: MIT
// ResolveService::Impl: the state of a service, which ResolveService and TwoWay share. Its functions are defined where
// they are used.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "device/opencl.h"
#include "passes/frame_ring.h"
#include "passes/frame_stream.h"
#include "passes/pass_clear_region.h"
#include "passes/two_way.h"
#include "quincunx/resolve_service.h"

namespace quincunx {

// Faults that no frame shows by itself, because each is right for one frame: what the first ones have in common. Each
// is said once, as a warning of the log.
class FrameAdvice {
 public:
  static constexpr int kFrames = 32;  // looked at before anything is said

  explicit FrameAdvice(const ResolvePlan& plan) : looks_at_camera_(plan.reads_camera()) {}

  // Allocates only where it warns. `inputs`: a frame that was dispatched by `plan`.
  void look_at(const ResolvePlan& plan, const FrameInputs& inputs);

 private:
  void look_at_camera(const CameraMotion& camera);
  void look_at_jitter(Extent render, Extent output, Vec2 jitter);

  bool looks_at_camera_;
  int camera_frames_ = 0;
  int jitter_frames_ = 0;
  std::array<Vec2, 8> places_;  // of the jitter; more than fit are enough
  std::size_t place_count_ = 0;
};

struct ResolveService::Impl {
  Impl(const Device& on, const ResolvePlan& to_do, bool two_way = false)
      : device(on),
        picture(on, to_do, two_way),
        advice(to_do),
        counter(on.impl()->context, CL_MEM_READ_WRITE, FrameRing::kFrames * sizeof(cl_uint)),
        ring(pass_timer(on) == PassTimer::kEvents) {
    if (const auto of_focus = to_do.focus_plan()) region.emplace(on, *of_focus);
  }

  void warm_up();
  Status check(const FrameInputs& inputs, const FocusInputs* focus, const FrameOutputs& outputs) const;
  void enqueue(const FrameInputs& inputs, const FocusInputs* focus, const FrameOutputs& outputs,
               FrameRing::Slot& slot);
  void forget();
  FrameReport dispatch(const FrameInputs& inputs, const FocusInputs* focus, const FrameOutputs& outputs,
                       const FrameSync& sync);
  ClearRegionPass* clear_pass(const ImageView& image) const;
  // What TwoWay does, in two_way.cpp.
  FrameReport show(const FrameInputs& inputs, float exposure, const FrameOutputs& outputs,
                   const ImageView& albedo);
  Status write(const KeptHistory& kept, Resource texels, Resource alpha);
  Status read_merged(KeptHistory& kept);

  Device device;
  FrameStream picture;
  FrameAdvice advice;
  std::optional<FocusStream> region;  // of the focus, where the plan has one
  cl::Buffer counter;                 // numbers of non-finite pixels, one uint a slot of the ring
  FrameRing ring;
  FrameObserver observer;  // may be empty
  // For TwoWay: the exposure of another history, with which the next frame's is merged, or 0; whether that is read; the
  // inputs of blur.
  float other_exposure = 0;
  bool keeps = false;
  Image shown_velocity, shown_depth;
};

}  // namespace quincunx
