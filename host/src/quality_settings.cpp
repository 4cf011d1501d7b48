// SPDX-License-Identifier: MIT
#include "quality_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "predictive_settings.h"

namespace quincunx {
namespace {

Status check_methods(const QualitySettings& settings) {
  const auto known = settings.front.methods();
  for (const FrontMethod& method : settings.methods) {
    if (std::find(known.begin(), known.end(), method) == known.end()) {
      return Status::invalid(
          fmt::format("methods has {}, of which the front has no points", name_of(method)));
    }
  }
  return {};
}

}  // namespace

Status check(const QualitySettings& settings) {
  if (Status status = check(settings.pacing); !status.ok()) return status;
  if (Status status = check_methods(settings); !status.ok()) return status;
  if (!(settings.hysteresis >= 0 && settings.hysteresis < 1)) {
    return Status::invalid(fmt::format("hysteresis is {}; it must lie in [0, 1)", settings.hysteresis));
  }
  if (!(settings.rest_seconds >= 0 && settings.rest_seconds <= 60)) {
    return Status::invalid(fmt::format("rest_seconds is {}; it must lie in [0, 60]", settings.rest_seconds));
  }
  if (settings.fade_frames < 0 || settings.fade_frames > 60) {
    return Status::invalid(fmt::format("fade_frames is {}; it must lie in [0, 60]", settings.fade_frames));
  }
  return {};
}

}  // namespace quincunx
