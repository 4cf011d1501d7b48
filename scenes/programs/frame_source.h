// SPDX-License-Identifier: MIT
// FrameSource: a scene drawn frame by frame into slots that OpenCL reads: scene, GL context, device, renderer
// and bridge of a program.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "frame_sequence.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "quincunx_gl/bridge.h"
#include "quincunx_gl/egl_context.h"
#include "quincunx_gl/target_readback.h"
#include "renderer.h"
#include "scene.h"

namespace quincunx::scenes {

struct FrameSourceSettings {
  std::string scene;  // name or file; empty: the default scene
  std::uint64_t seed = 0;
  SequenceSettings sequence;
  float exposure = 0;  // 0: the scene's own
  std::string device;  // see Device::open
  gl::Interop interop = gl::Interop::kAuto;
  gl::Platform platform = gl::Platform::kAuto;
};

enum class HandOver : std::uint8_t {
  kPlanned,  // the targets that the plan reads; no others are drawn
  kEvery,    // colour, depth, velocity and reactive values
};

// A frame that was drawn and is not released yet.
struct DrawnFrame {
  std::int64_t index = 0;
  FrameView view;
  gl::TargetPixels targets = {};  // only where draw() was asked for them
};

// One thread, that of the GL context. Frames are drawn, acquired and released in order; of those not released
// there are at most two.
class FrameSource {
 public:
  // Errors: of any part, as that part words them.
  static Result<std::unique_ptr<FrameSource>> create(const FrameSourceSettings& settings);

  // Makes the slots for what the plan of this scene reads, and gives the plan with the storage that they
  // have. Before the first draw(). `resolve.output` and `target` are taken from the sequence.
  Result<ResolvePlan> connect(ResolveSettings resolve, HandOver hand_over = HandOver::kPlanned);

  const Scene& scene() const { return scene_; }
  const Device& device() const { return *device_; }
  const gl::EglContext& context() const { return *context_; }
  const FrameSequence& sequence() const { return *sequence_; }
  Renderer& renderer() { return *renderer_; }
  gl::Bridge& bridge() { return *bridge_; }
  const gl::Bridge& bridge() const { return *bridge_; }

  Status draw(std::int64_t index, bool keep_targets = false);

  // The oldest frame that is not released: waits until OpenCL can read it. Its memory stays as it is until
  // the frame after the next is drawn.
  Result<FrameInputs> acquire();

  DrawnFrame& oldest() { return drawn_.front(); }
  void release() { drawn_.pop_front(); }

 private:
  explicit FrameSource(const FrameSourceSettings& settings) : settings_(settings) {}
  Status open();

  FrameSourceSettings settings_;
  Scene scene_;
  std::optional<gl::EglContext> context_;
  std::optional<Device> device_;
  std::optional<FrameSequence> sequence_;
  std::optional<Renderer> renderer_;
  std::unique_ptr<gl::Bridge> bridge_;
  std::deque<DrawnFrame> drawn_;
};

}  // namespace quincunx::scenes
