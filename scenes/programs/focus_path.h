// SPDX-License-Identifier: MIT
// FocusPath: what is in focus in each frame: a rectangle, an object of the scene, or what the pointer is on. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quincunx/extent.h"
#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::scenes {

inline const std::string kFocusPointer = "pointer";

// As --focus has it.
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

class FocusPath {
 public:
  // `scene` outlives it. Errors: kInvalidArgument for an object that the scene does not have, or that is not in the
  // picture at any of these times.
  static Result<FocusPath> create(const FocusTarget& target, const Scene& scene, Extent output,
                                  const FocusTimes& times);

  Extent region() const { return region_; }  // of every frame; large enough for all of them

  // Nothing where nothing of it is in the picture. `pointer` in output pixels.
  std::optional<FocusPlace> at(double seconds, const std::optional<Vec2>& pointer = std::nullopt) const;

 private:
  struct Part {
    int instance;
    Bounds box;  // of its mesh
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
  std::vector<Part> parts_;  // of the object
};

}  // namespace quincunx::scenes
