// SPDX-License-Identifier: MIT
// FrameSource: a scene drawn frame by frame into slots that OpenCL reads: scene, GL context, device, renderer
// and bridge of a program.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frames/focus_path.h"
#include "frames/frame_sequence.h"
#include "frames/part_scales.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "quincunx_gl/bridge.h"
#include "quincunx_gl/context.h"
#include "render/renderer.h"
#include "scene.h"

namespace quincunx::scenes {

struct FrameSourceSettings {
  std::string scene;  // name or file; empty: the default scene
  std::uint64_t seed = 0;
  SequenceSettings sequence;
  PartsSettings parts;
  FocusOptions focus;
  float exposure = 0;  // 0: the scene's own
  std::string device;  // see Device::open
  gl::Interop interop = gl::Interop::kAuto;
  gl::Platform platform = gl::Platform::kAuto;
  gl::Api api = gl::Api::kGl45;
};

// Returns the way of the last frame to OpenCL and back, with the host's time and bytes: "copy: 0.09 ms and 9.2 MB
// there, 0.76 ms and 3.7 MB back".
std::string crossing_text(const gl::Bridge& bridge);

enum class HandOver : std::uint8_t {
  kPlanned,  // the targets that the plan reads; no others are drawn
  kEvery,    // colour, depth, velocity and reactive values
};

// A frame that was drawn and is not released yet.
struct DrawnFrame {
  std::int64_t index = 0;
  Extent output;       // extent of the picture that is made of it
  FrameView view;      // at a cut of the scene with its own time as the previous one: nothing has moved
  bool reset = false;  // the first frame, or the first of a shot
  std::optional<FocusFrame> region = {};  // the focus's region, where the focus is in the picture
  gl::TargetPixels targets = {};          // only where draw() was asked for them
  gl::TargetPixels particles = {};        // the same, where they have targets of their own
  gl::TargetPixels focus = {};            // the same, of the focus's region
};

// One thread, that of the GL context. Frames are drawn, acquired and released in order; of those not released
// there are at most two.
class FrameSource {
 public:
  // Errors: of any part, as that part words them.
  static Result<std::unique_ptr<FrameSource>> create(const FrameSourceSettings& settings);

  // Another sequence of frames from the same scene, context, device and renderer; its parts and focus are as this one's
  // where none are given.
  Result<std::unique_ptr<FrameSource>> another(const SequenceSettings& sequence,
                                               const std::optional<PartsSettings>& parts = {},
                                               const std::optional<FocusOptions>& focus = {}) const;

  // Makes the slots for what the plan of this scene reads, and gives the plan with the storage that they
  // have. Before the first draw(). Extents and `focus` of `resolve` are taken from the sequence.
  Result<ResolvePlan> connect(const ResolveSettings& resolve, HandOver hand_over = HandOver::kPlanned);

  // Does the same for several resolves of the same frames: the slots have what any of their plans reads, and the kind
  // of targets, colour format and tone map that the first one asks for. In their order; at least one.
  Result<std::vector<ResolvePlan>> connect_all(std::vector<ResolveSettings> resolves,
                                               HandOver hand_over = HandOver::kPlanned);

  const Scene& scene() const { return stage_->scene; }
  const Device& device() const { return *stage_->device; }
  const gl::Context& context() const { return *stage_->context; }
  // The factor of linear colour: the option's, else the scene's.
  float exposure() const { return settings_.exposure > 0 ? settings_.exposure : scene().exposure; }
  FrameSequence& sequence() { return *sequence_; }
  const FrameSequence& sequence() const { return *sequence_; }
  Renderer& renderer() { return *stage_->renderer; }

  // Once connected. The picture's bridge; the memory of all frames; the bytes moved for that of the last acquire().
  gl::Bridge& bridge() { return *feeds_.front().bridge; }
  const gl::Bridge& bridge() const { return *feeds_.front().bridge; }
  const PartScales& parts() const { return *parts_; }
  gl::Bridge::Memory memory() const;
  std::uint64_t bytes_in() const;

  Status draw(std::int64_t index, bool keep_targets = false);
  // Draws another view than the sequence's, within its target.
  Status draw(std::int64_t index, const FrameView& view, bool keep_targets = false);

  // Draws the last drawn frame anew, with velocity relative to another scene time. Its targets.
  Result<gl::TargetPixels> draw_relative_to(double seconds);

  // draw() in its two steps, for those who time them: into the slot; to OpenCL.
  Status begin(std::int64_t index, bool keep_targets = false);
  Status begin(std::int64_t index, const FrameView& view, bool keep_targets = false);
  Status submit();

  // The oldest frame that is not released: waits until OpenCL can read it. Its memory stays as it is until
  // the frame after the next is drawn. `reset` is set where DrawnFrame::reset is.
  Result<FrameInputs> acquire();

  // The region of the last acquire(); null where the frame has none.
  const FocusInputs* focus() const { return focus_inputs_ ? &*focus_inputs_ : nullptr; }
  // Sets the pointer's output pixel for the next begin() and a focus that follows it.
  void set_pointer(const std::optional<Vec2>& pixel) {
    if (focus_) focus_->set_pointer(pixel);
  }

  DrawnFrame& oldest() { return drawn_.front(); }
  void release() { drawn_.pop_front(); }

 private:
  struct Stage {
    Scene scene;
    std::optional<gl::Context> context;
    std::optional<Device> device;
    std::optional<Renderer> renderer;
  };

  // Targets of one kind, drawn in the slots of a bridge and handed to OpenCL frame by frame.
  struct Feed {
    enum class Kind : std::uint8_t { kPicture, kParticles, kFocus };

    Kind kind = Kind::kPicture;
    std::unique_ptr<gl::Bridge> bridge;
    const gl::RenderTargets* targets = nullptr;  // last begun frame's; null where that leaves it out

    bool is_in(const DrawnFrame& frame) const { return kind != Kind::kFocus || frame.region; }
    Extent viewport(const DrawnFrame& frame) const;  // where it is in the frame
    int slot(const DrawnFrame& frame) const { return static_cast<int>(frame.index % bridge->slots()); }
  };

  explicit FrameSource(const FrameSourceSettings& settings) : settings_(settings) {}
  Status open_sequence();
  Status open_stage();
  Status open_focus();
  Status open_feed(Feed::Kind kind, const gl::BridgeSettings& bridging);
  Status open_parts(const gl::BridgeSettings& bridging);
  Status open_focus_feed(const gl::BridgeSettings& bridging, const std::vector<ResolvePlan>& plans);
  Extent particle_target() const;
  const gl::RenderTargets* targets_of(Feed::Kind kind) const;  // null: it has none in the frame begun last
  Status keep_targets(DrawnFrame& frame) const;
  void bind(Feed::Kind kind, const gl::SharedFrame& shared, FrameInputs& inputs);

  FrameSourceSettings settings_;
  std::shared_ptr<Stage> stage_;  // outlives what was made in its context
  std::optional<FrameSequence> sequence_;
  std::optional<OutputPath> outputs_;
  std::optional<PartScales> parts_;
  std::optional<FocusRegion> focus_;  // absent: there is none
  std::vector<Feed> feeds_;  // the picture's, then those of particles and of a focus where they have one
  Display display_;          // display for targets with encoded colour
  std::deque<DrawnFrame> drawn_;
  std::optional<FocusInputs> focus_inputs_;
};

}  // namespace quincunx::scenes
