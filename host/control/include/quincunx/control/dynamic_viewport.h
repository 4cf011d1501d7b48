// SPDX-License-Identifier: MIT
// DynamicViewport: turns a wanted scale into the integer viewport that is drawn, and that into the true ratio.
//
// Pure arithmetic: no device, no clock. A value; any thread may use its own copy. After Binks, "Dynamic
// Resolution Rendering", 2012: the ratio that shaders and kernels use is recomputed from the integer
// viewport, never the one asked for.
#pragma once

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"

namespace quincunx {

class QUINCUNX_API DynamicViewport {
 public:
  // Creates a viewport of scale 1. Target extent = ceil(output * max_scale). Viewports of set_scale() are the output
  // extent plus a multiple of `step` pixels on each axis, so that scale 1 is exactly the output, whatever its parity;
  // no side falls below `min_extent` (or the output where that is smaller) nor exceeds the target. Errors:
  // kInvalidArgument for an empty output, a max_scale outside [1, 2] or not finite, a step below 1, a min_extent below
  // 1.
  static Result<DynamicViewport> create(Extent output, float max_scale = 1.0f, int step = 2,
                                        Extent min_extent = {8, 8});

  // Takes the viewport nearest to output * scale on each axis. Values beyond the range are clamped. Errors:
  // kInvalidArgument for a scale that is not a positive finite number; the viewport then stays as it was.
  Status set_scale(float scale_x, float scale_y);

  // Takes any integer viewport from 1x1 to the target extent; it need not be on the ladder. Errors:
  // kInvalidArgument.
  Status set_render(Extent render);

  Extent render() const { return render_; }
  Extent output() const { return output_; }
  Extent target() const { return target_; }
  Vec2 ratio() const;         // render / output per axis: the true scale
  Vec2 target_ratio() const;  // render / target per axis: the part of the target in use

 private:
  DynamicViewport(Extent output, Extent target, int step, Extent min_extent);

  Extent output_;
  Extent target_;
  Extent min_extent_;
  Extent render_;
  int step_;
};

}  // namespace quincunx
