// SPDX-License-Identifier: MIT
// ResolutionLadder: the render extents that a resolution controller may choose, from smallest to largest.
//
// Pure arithmetic, immutable after creation; any thread may read it. Every rung is the output extent plus a
// multiple of `step` pixels on each axis (the rungs of DynamicViewport), and differs from its neighbour by
// one step on one axis. Areas therefore rise strictly from rung to rung, in steps as fine as the order of the
// axes allows. Source: "Dynamic Resolution Scaling Implementation Best Practice", section 3 (2 pixel
// increments; horizontal only, or horizontal first).
#pragma once

#include <cstdint>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"

namespace quincunx {

enum class AxisOrder : std::uint8_t {
  kHorizontalFirst,  // the width, until it lies at .75 of the height's scale; from there on both in turns
  kHorizontalOnly,   // the width; the height stays the output's
  kBoth,             // both in turns, always at nearly the same scale
};

struct LadderSettings {
  Extent output_extent = {};  // both sides in [1, 32768]
  double min_scale = 0.5;     // per axis, of the output; in (0, 2]
  double max_scale = 1;       // in [min_scale, 2]
  AxisOrder order = AxisOrder::kHorizontalFirst;
  int step = 2;                // pixels, at least 1
  Extent min_extent = {8, 8};  // no side is smaller (or than the output, where that is smaller)
};

class QUINCUNX_API ResolutionLadder {
 public:
  // Creates a ladder. The output is a rung whenever [min_scale, max_scale] holds 1; a range narrower than a step holds
  // one rung on that axis. Errors: kInvalidArgument for a field outside the bounds above or min_scale > max_scale.
  static Result<ResolutionLadder> create(const LadderSettings& settings);

  int size() const { return static_cast<int>(rungs_.size()); }  // at least 1
  int top() const { return size() - 1; }
  Extent operator[](int rung) const { return rungs_[static_cast<std::size_t>(rung)]; }
  Extent output() const { return output_; }

  // Returns the pixels of an extent over those of the output.
  double area_fraction(Extent extent) const;
  double area_fraction(int rung) const { return area_fraction((*this)[rung]); }

  // Returns the largest rung of at most this area fraction; the lowest one where all are larger or it is NaN.
  int max_rung_within(double area_fraction) const;
  // Returns the same for a scale of both axes: area fraction = scale squared.
  int max_rung_within_scale(double scale) const { return max_rung_within(scale * scale); }

 private:
  ResolutionLadder(Extent output, std::vector<Extent> rungs);

  Extent output_;
  std::vector<Extent> rungs_;
};

}  // namespace quincunx
