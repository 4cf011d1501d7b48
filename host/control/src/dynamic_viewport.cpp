// SPDX-License-Identifier: MIT
#include "quincunx/control/dynamic_viewport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ranges.h"

namespace quincunx {
namespace {

// The rung of the ladder output + k * step nearest to output * scale, within [low, high].
int nearest_rung(int output, double scale, int step, int low, int high) {
  const double rungs_down = std::ceil((low - output) / static_cast<double>(step));
  const double rungs_up = std::floor((high - output) / static_cast<double>(step));
  const double wanted = std::round(output * (scale - 1) / step);
  return output + static_cast<int>(std::clamp(wanted, rungs_down, rungs_up)) * step;
}

}  // namespace

DynamicViewport::DynamicViewport(Extent output, Extent target, int step, Extent min_extent)
    : output_(output), target_(target), min_extent_(min_extent), render_(output), step_(step) {}

Result<DynamicViewport> DynamicViewport::create(Extent output, float max_scale, int step, Extent min_extent) {
  Ranges ranges;
  ranges.sides_of("output", output, kLargestSide);
  ranges.lies_in("max_scale", max_scale, 1, 2);
  ranges.at_least("step", step, 1);
  ranges.sides_of("min_extent", min_extent);
  if (!ranges.status().ok()) return ranges.status();
  const double scale = max_scale;
  const Extent target = {static_cast<int>(std::ceil(output.width * scale)),
                         static_cast<int>(std::ceil(output.height * scale))};
  const Extent reachable = {std::min(min_extent.width, output.width),
                            std::min(min_extent.height, output.height)};
  return DynamicViewport(output, target, step, reachable);
}

Status DynamicViewport::set_scale(float scale_x, float scale_y) {
  const auto usable = [](float scale) { return std::isfinite(scale) && scale > 0; };
  if (!usable(scale_x) || !usable(scale_y)) {
    return Status::invalid(
        fmt::format("scale is {} x {}; both must be positive finite numbers", scale_x, scale_y));
  }
  // Beyond the ends only the direction matters; clamping first keeps the arithmetic in range.
  const double x = std::min(static_cast<double>(scale_x), 4.0);
  const double y = std::min(static_cast<double>(scale_y), 4.0);
  render_ = {nearest_rung(output_.width, x, step_, min_extent_.width, target_.width),
             nearest_rung(output_.height, y, step_, min_extent_.height, target_.height)};
  return {};
}

Status DynamicViewport::set_render(Extent render) {
  if (render.width < 1 || render.height < 1 || render.width > target_.width ||
      render.height > target_.height) {
    return Status::invalid(fmt::format("render is {}x{}; it must lie within 1x1 and the target's {}x{}",
                                       render.width, render.height, target_.width, target_.height));
  }
  render_ = render;
  return {};
}

Vec2 DynamicViewport::ratio() const {
  return {static_cast<float>(render_.width) / static_cast<float>(output_.width),
          static_cast<float>(render_.height) / static_cast<float>(output_.height)};
}

Vec2 DynamicViewport::target_ratio() const {
  return {static_cast<float>(render_.width) / static_cast<float>(target_.width),
          static_cast<float>(render_.height) / static_cast<float>(target_.height)};
}

}  // namespace quincunx
