// SPDX-License-Identifier: MIT
// DetailFollower and OutputFollower: detail and the output's resolution follow the controller's choice.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "quincunx/control/detail_follower.h"
#include "quincunx/control/output_follower.h"
#include "ranges.h"

namespace quincunx {

Result<DetailFollower> DetailFollower::create(const DetailSettings& settings) {
  Ranges ranges;
  ranges.lies_in("levels", settings.levels, 2, 64);
  ranges.lies_in("full_area", settings.full_area, 0, 4, Ends::kOpenLow);
  if (!ranges.status().ok()) return ranges.status();
  if (!(settings.min_area > 0 && settings.min_area < settings.full_area)) {
    return Status::invalid(fmt::format("min_area is {}; it must lie in (0, {}), below full_area",
                                       settings.min_area, settings.full_area));
  }
  ranges.lies_in("hysteresis", settings.hysteresis, 0, 1);
  ranges.at_least("rest_frames", settings.rest_frames, 0);
  if (!ranges.status().ok()) return ranges.status();
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
                        (settings_.full_area - settings_.min_area);
  const double margin = 0.5 + settings_.hysteresis;
  int next = level_;
  if (wanted > level_ + margin) ++next;
  if (wanted < level_ - margin) --next;
  next = std::clamp(next, 0, settings_.levels - 1);
  if (next != level_) since_ = 0;
  level_ = next;
  return level_;
}

Result<Extent> dual_output(const ResolutionLadder& outputs, Extent render, double max_filled) {
  Ranges ranges;
  ranges.sides_of("render", render);
  ranges.lies_in("max_filled", max_filled, 0, 1, Ends::kOpenLow);
  if (!ranges.status().ok()) return ranges.status();
  const double needed = outputs.area_fraction(render) / max_filled;
  const int below = outputs.max_rung_within(needed);
  return outputs[std::min(outputs.top(),
                          outputs.area_fraction(below) < needed * (1 - 1e-12) ? below + 1 : below)];
}

namespace {

// So many pixels that the longer way, of the width or the height, has that many steps; even, as those of viewports.
int step_of(const OutputSettings& settings) {
  const double longest = std::max(settings.display.width, settings.display.height) * (1 - settings.min_scale);
  return std::max(2, static_cast<int>(longest / settings.steps / 2 + 0.5) * 2);
}

Status check(const OutputSettings& settings) {
  Ranges ranges;
  ranges.lies_in("min_scale", settings.min_scale, 0, 1, Ends::kOpenLow);
  ranges.at_least("steps", settings.steps, 1);
  ranges.lies_in("max_filled", settings.max_filled, 0, 1, Ends::kOpenLow);
  ranges.lies_in("hysteresis", settings.hysteresis, 0, 1, Ends::kOpenHigh);
  ranges.at_least("rest_frames", settings.rest_frames, 0);
  return ranges.status();
}

}  // namespace

OutputFollower::OutputFollower(const OutputSettings& settings, ResolutionLadder outputs)
    : settings_(settings),
      outputs_(std::move(outputs)),
      output_(outputs_[outputs_.top()]),
      since_(settings.rest_frames) {}

Result<OutputFollower> OutputFollower::create(const OutputSettings& settings) {
  if (Status status = check(settings); !status.ok()) return status;
  auto outputs = ResolutionLadder::create({.output_extent = settings.display,
                                           .min_scale = settings.min_scale,
                                           .order = AxisOrder::kBoth,
                                           .step = step_of(settings),
                                           .min_extent = {1, 1}});
  if (!outputs.ok()) return outputs.status();
  return OutputFollower(settings, std::move(outputs).value());
}

Extent OutputFollower::observe(Extent render) {
  const Result<Extent> wanted = dual_output(outputs_, render, settings_.max_filled);
  if (!wanted.ok()) return output_;
  const bool is_outgrown = render.area() > output_.area();
  if (since_ < settings_.rest_frames && !is_outgrown) {
    ++since_;
    return output_;
  }
  // An output falls to what a larger viewport would want.
  const Extent lower =
      dual_output(outputs_, render, settings_.max_filled * (1 - settings_.hysteresis)).value();
  Extent next = output_;
  if (wanted->area() > output_.area()) next = wanted.value();
  if (lower.area() < output_.area()) next = lower;
  if (next != output_) since_ = 0;
  output_ = next;
  return output_;
}

}  // namespace quincunx
