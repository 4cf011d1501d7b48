// SPDX-License-Identifier: MIT
#include "quincunx/detail_follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx {

Result<DetailFollower> DetailFollower::create(const DetailSettings& settings) {
  if (settings.levels < 2 || settings.levels > 64) {
    return Status::invalid(fmt::format("levels is {}; it must lie in [2, 64]", settings.levels));
  }
  if (!(settings.full_area > 0 && settings.full_area <= 4)) {
    return Status::invalid(fmt::format("full_area is {}; it must lie in (0, 4]", settings.full_area));
  }
  if (!(settings.least_area > 0 && settings.least_area < settings.full_area)) {
    return Status::invalid(fmt::format("least_area is {}; it must lie in (0, {}), below full_area",
                                       settings.least_area, settings.full_area));
  }
  if (!(settings.hysteresis >= 0 && settings.hysteresis <= 1)) {
    return Status::invalid(fmt::format("hysteresis is {}; it must lie in [0, 1]", settings.hysteresis));
  }
  if (settings.rest_frames < 0) {
    return Status::invalid(fmt::format("rest_frames is {}; it must be at least 0", settings.rest_frames));
  }
  return DetailFollower(settings);
}

int DetailFollower::observe(double area_fraction) {
  if (!(area_fraction > 0) || !std::isfinite(area_fraction)) return level_;
  if (since_ < settings_.rest_frames) {
    ++since_;
    return level_;
  }
  // In levels: level k is meant for [k - 1/2, k + 1/2].
  const double wanted = (settings_.levels - 1) * (settings_.full_area - area_fraction) /
                        (settings_.full_area - settings_.least_area);
  const double margin = 0.5 + settings_.hysteresis;
  int next = level_;
  if (wanted > level_ + margin) ++next;
  if (wanted < level_ - margin) --next;
  next = std::clamp(next, 0, settings_.levels - 1);
  if (next != level_) since_ = 0;
  level_ = next;
  return level_;
}

Result<Extent> dual_output(const ResolutionLadder& outputs, Extent render, double most_filled) {
  if (render.width < 1 || render.height < 1) {
    return Status::invalid(
        fmt::format("render is {}x{}; both sides must be at least 1", render.width, render.height));
  }
  if (!(most_filled > 0 && most_filled <= 1)) {
    return Status::invalid(fmt::format("most_filled is {}; it must lie in (0, 1]", most_filled));
  }
  const double needed = outputs.area_fraction(render) / most_filled;
  const int below = outputs.highest_within(needed);
  return outputs[std::min(outputs.top(),
                          outputs.area_fraction(below) < needed * (1 - 1e-12) ? below + 1 : below)];
}

}  // namespace quincunx
