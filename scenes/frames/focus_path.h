// SPDX-License-Identifier: MIT
// The focus of each frame: its place in the picture (FocusPath), and how its region is drawn (FocusRegion).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frames/frame_sequence.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/status.h"
#include "render/renderer.h"
#include "scene.h"

namespace quincunx::scenes {

inline const std::string kFocusPointer = "pointer";

// The value of --focus.
struct FocusTarget {
  std::optional<Rectangle> rectangle;  // output pixels
  bool pointer = false;
  std::string object;

  // "X,Y,W,H", "pointer", or else the name of an object. Errors: kInvalidArgument for a rectangle that leaves the
  // picture.
  static Result<FocusTarget> parse(const std::string& text, Extent output);
};

// In output pixels: the region that is drawn, and what of it is shown.
struct FocusPlace {
  Rectangle region;
  Rectangle shown;
};

// Scene times: `count` frames from `start` on, one `step` after another.
struct FocusTimes {
  double start = 0;
  double step = 0;
  std::int64_t count = 1;
};

// A rectangle, an object of the scene, or what the pointer is on. Pure.
class FocusPath {
 public:
  // `scene` outlives it. Errors: kInvalidArgument for an object that the scene does not have, or that is not in the
  // picture at any of these times.
  static Result<FocusPath> create(const FocusTarget& target, const Scene& scene, Extent output,
                                  const FocusTimes& times);

  Extent region() const { return region_; }  // extent in every frame; large enough for all of them

  // Nothing where nothing of it is in the picture. `pointer` in output pixels.
  std::optional<FocusPlace> at(double seconds, const std::optional<Vec2>& pointer = std::nullopt) const;

 private:
  struct Part {
    int instance;
    Bounds box;  // bounds of its mesh
  };

  FocusPath(const FocusTarget& target, const Scene& scene, Extent output);
  Status find_object();
  Status fit_region(const FocusTimes& times);
  std::optional<Rectangle> wanted_at(double seconds, const std::optional<Vec2>& pointer) const;
  std::optional<Rectangle> object_at(double seconds) const;

  FocusTarget target_;
  const Scene* scene_;
  Extent output_;
  Extent region_;
  std::vector<Part> parts_;  // parts of the object
};

struct FocusOptions {
  std::optional<FocusTarget> target;  // absent: there is no focus
  float scale = 1;                    // scale of the region, both axes
  bool endless = false;  // the number of frames is open: an object is looked for in all of the scene's time
};

// The region of one frame, as it is drawn.
struct FocusFrame {
  FrameView view;
  FocusPlace place;
  bool reset = false;  // no frame of the region was drawn just before
};

// The frames of a focus's region beside those of the picture. One thread.
class FocusRegion {
 public:
  // `picture`: the frames that the focus lies in; `scene` outlives it. Nothing where the region is empty. Errors: as
  // FocusPath::create().
  static Result<std::optional<FocusRegion>> create(const FocusOptions& options, const Scene& scene,
                                                   const SequenceSettings& picture);

  FocusSettings settings() const {
    return {.extent = sequence_.output(), .target_extent = sequence_.target()};
  }

  void set_pointer(const std::optional<Vec2>& pixel) { pointer_ = pixel; }  // for the next at()

  // Returns how the region of frame `index` is drawn; nothing where it is not in the picture. In the order of frames.
  // `picture`: how the picture is drawn. `reset`: the frame before is not to be used.
  std::optional<FocusFrame> at(std::int64_t index, const FrameView& picture, bool reset);

 private:
  FocusRegion(const FocusPath& path, const FrameSequence& sequence, Extent output)
      : path_(path), sequence_(sequence), output_(output) {}
  ViewWindow window_of(const Rectangle& region) const;

  FocusPath path_;
  FrameSequence sequence_;
  Extent output_;
  std::optional<Vec2> pointer_;
  std::optional<Rectangle> previous_;  // region
};

}  // namespace quincunx::scenes
