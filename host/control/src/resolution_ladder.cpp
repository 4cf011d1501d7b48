// SPDX-License-Identifier: MIT
#include "quincunx/control/resolution_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ranges.h"

namespace quincunx {
namespace {

constexpr double kMaxScale = 2;

struct Range {
  int low = 0;
  int high = 0;
};

// The rungs output + k * step within the scales; where the floor or the step leaves none, the lowest one
// alone.
Range axis_range(int output, double min_scale, double max_scale, int step, int floor) {
  // A scale such as 0.7 of 1000 must reach 700 although 0.7 * 1000 may round to either side of it.
  constexpr double kRounding = 1e-6;
  const double smallest =
      std::max(output * min_scale - kRounding, static_cast<double>(std::min(floor, output)));
  const double largest = output * max_scale + kRounding;
  const int low = output + static_cast<int>(std::ceil((smallest - output) / step)) * step;
  const int high = output + static_cast<int>(std::floor((largest - output) / step)) * step;
  return {low, std::max(low, high)};
}

// Decides which axis moves next; exact, in integers.
class Walk {
 public:
  Walk(const LadderSettings& settings, Range width, Range height)
      : settings_(settings), width_(width), height_(height) {}

  std::vector<Extent> rungs() const {
    const Extent output = settings_.output_extent;
    const Extent start = {std::clamp(output.width, width_.low, width_.high),
                          std::clamp(output.height, height_.low, height_.high)};
    std::vector<Extent> list;
    for (Extent at = start; at.width > width_.low || at.height > height_.low; list.push_back(at))
      at = below(at);
    std::reverse(list.begin(), list.end());
    list.push_back(start);
    for (Extent at = start; at.width < width_.high || at.height < height_.high; list.push_back(at)) {
      at = above(at);
    }
    return list;
  }

 private:
  Extent below(Extent at) const {
    const bool narrower = at.height == height_.low || (at.width > width_.low && width_shrinks_first(at));
    return narrower ? Extent{at.width - settings_.step, at.height}
                    : Extent{at.width, at.height - settings_.step};
  }
  Extent above(Extent at) const {
    const bool wider = at.height == height_.high || (at.width < width_.high && width_grows_first(at));
    return wider ? Extent{at.width + settings_.step, at.height}
                 : Extent{at.width, at.height + settings_.step};
  }
  // Sides times the other axis' output are scales over a common denominator.
  bool width_shrinks_first(Extent at) const {
    const Extent output = settings_.output_extent;
    if (settings_.order == AxisOrder::kBoth) {
      return std::int64_t{at.width} * output.height >= std::int64_t{at.height} * output.width;
    }
    return std::int64_t{4} * (at.width - settings_.step) * output.height >=
           std::int64_t{3} * at.height * output.width;
  }
  bool width_grows_first(Extent at) const {
    const Extent output = settings_.output_extent;
    if (settings_.order == AxisOrder::kBoth) {
      return std::int64_t{at.width} * output.height <= std::int64_t{at.height} * output.width;
    }
    return std::int64_t{3} * (at.width + settings_.step) * output.height <=
           std::int64_t{4} * at.height * output.width;
  }

  const LadderSettings& settings_;
  Range width_;
  Range height_;
};

Status check(const LadderSettings& settings) {
  Ranges ranges;
  ranges.sides_of("output_extent", settings.output_extent, kLargestSide);
  if (!ranges.status().ok()) return ranges.status();
  if (!(settings.min_scale > 0 && settings.min_scale <= kMaxScale)) {
    return Status::invalid(
        fmt::format("min_scale is {}; it must be above 0 and at most {}", settings.min_scale, kMaxScale));
  }
  if (!(settings.max_scale >= settings.min_scale && settings.max_scale <= kMaxScale)) {
    return Status::invalid(fmt::format("max_scale is {}; it must lie in [{}, {}], the first being min_scale",
                                       settings.max_scale, settings.min_scale, kMaxScale));
  }
  if (settings.step < 1 || settings.step > kLargestSide) {
    return Status::invalid(
        fmt::format("step is {}; it must lie in [1, {}] pixels", settings.step, kLargestSide));
  }
  ranges.sides_of("min_extent", settings.min_extent);
  return ranges.status();
}

}  // namespace

ResolutionLadder::ResolutionLadder(Extent output, std::vector<Extent> rungs)
    : output_(output), rungs_(std::move(rungs)) {}

Result<ResolutionLadder> ResolutionLadder::create(const LadderSettings& settings) {
  if (Status status = check(settings); !status.ok()) return status;
  const Extent output = settings.output_extent;
  const Range width = axis_range(output.width, settings.min_scale, settings.max_scale, settings.step,
                                 settings.min_extent.width);
  const Range height = settings.order == AxisOrder::kHorizontalOnly
                           ? Range{output.height, output.height}
                           : axis_range(output.height, settings.min_scale, settings.max_scale, settings.step,
                                        settings.min_extent.height);
  return ResolutionLadder(output, Walk(settings, width, height).rungs());
}

double ResolutionLadder::area_fraction(Extent extent) const {
  return static_cast<double>(extent.area()) / static_cast<double>(output_.area());
}

int ResolutionLadder::max_rung_within(double area_fraction) const {
  // The tolerance keeps a fraction computed from a rung on that rung.
  const double pixels = area_fraction * static_cast<double>(output_.area()) * (1 + 1e-12);
  const auto first_above = std::partition_point(rungs_.begin(), rungs_.end(), [pixels](Extent rung) {
    return static_cast<double>(rung.area()) <= pixels;
  });
  return std::max(0, static_cast<int>(first_above - rungs_.begin()) - 1);
}

}  // namespace quincunx
