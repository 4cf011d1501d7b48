// SPDX-License-Identifier: MIT
// FocusFeed: the region of a focus, drawn frame by frame into slots of its own that OpenCL reads.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "programs/focus_path.h"
#include "programs/frame_sequence.h"
#include "quincunx/focus.h"
#include "quincunx/resolve_plan.h"
#include "quincunx_gl/bridge.h"
#include "quincunx_gl/target_readback.h"
#include "render/renderer.h"

namespace quincunx::scenes {

struct FocusOptions {
  std::optional<FocusTarget> target;  // absent: there is no focus
  float scale = 1;                    // of the region, both axes
  bool endless = false;  // the number of frames is open: an object is looked for in all of the scene's time
};

// One thread, that of the GL context. Frames are drawn, acquired and released in order.
class FocusFeed {
 public:
  // `picture`: the frames that the focus lies in; `scene` outlives it. Errors: as FocusPath::create().
  static Result<std::unique_ptr<FocusFeed>> create(const FocusOptions& options, const Scene& scene,
                                                   const SequenceSettings& picture);

  FocusSettings settings() const { return {.extent = sequence_.output(), .target = sequence_.target()}; }

  // Makes the slots. `picture`: how the picture's were made. `plans` of the picture have this focus.
  Status connect(const gl::EglContext& context, const Device& device, gl::BridgeSettings picture,
                 const std::vector<ResolvePlan>& plans);

  void set_pointer(const std::optional<Vec2>& pixel) { pointer_ = pixel; }  // of the next begin()

  // Draws the region of a frame where it is in the picture. `view`: the picture's. `targets`, if not null, gets what
  // was drawn.
  Status begin(Renderer& renderer, std::int64_t index, const FrameView& view, bool reset,
               gl::TargetPixels* targets);
  Status submit();
  // The oldest frame that is not released: waits until OpenCL can read it.
  Status acquire(const Renderer& renderer);
  // Of the last acquire(); null where that frame has none.
  const FocusInputs* inputs() const { return inputs_ ? &*inputs_ : nullptr; }
  void release() { drawn_.pop_front(); }

  const gl::Bridge& bridge() const { return *bridge_; }

 private:
  struct Drawn {
    int slot;
    FrameView view;
    FocusPlace place;
    bool reset;  // no frame of the region was drawn just before
  };

  FocusFeed(const FocusPath& path, const FrameSequence& sequence, Extent output)
      : path_(path), sequence_(sequence), output_(output) {}
  ViewWindow window_of(const Rectangle& region) const;

  FocusPath path_;
  FrameSequence sequence_;
  Extent output_;
  std::unique_ptr<gl::Bridge> bridge_;
  std::optional<Vec2> pointer_;
  std::optional<Rectangle> previous_;  // region
  std::deque<std::optional<Drawn>> drawn_;
  std::optional<FocusInputs> inputs_;
};

}  // namespace quincunx::scenes
