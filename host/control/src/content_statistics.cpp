// SPDX-License-Identifier: MIT
#include "quincunx/advanced/content_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quincunx {

Status check(const ContentStatistics& content) {
  const std::pair<const char*, double> shares[] = {{"moving", content.moving},
                                                   {"apart", content.apart},
                                                   {"thin", content.thin},
                                                   {"light", content.light},
                                                   {"zoom", content.zoom}};
  for (const auto& [name, share] : shares) {
    if (!(share >= 0 && share <= 1)) {
      return Status::invalid(fmt::format("content.{} is {}; it must lie in [0, 1]", name, share));
    }
  }
  if (!(content.speed_px >= 0 && std::isfinite(content.speed_px))) {
    return Status::invalid(
        fmt::format("content.speed_px is {}; it must be finite and at least 0", content.speed_px));
  }
  return {};
}

SceneMix mix_of(const ContentStatistics& content) {
  SceneMix mix;
  double left = 1;
  const auto take = [&](SceneClass scene_class, double share) {
    const double taken = std::min(left, share);
    mix.share[static_cast<std::size_t>(scene_class)] = taken;
    left -= taken;
    return taken;
  };
  take(SceneClass::kLight, content.light);
  double moving = content.moving;
  moving -= take(SceneClass::kThin, content.thin);
  moving -= take(SceneClass::kObjects, std::max(0.0, content.apart - content.thin));
  moving -= take(SceneClass::kZoom, std::clamp(moving, 0.0, content.zoom));
  take(SceneClass::kPan, std::max(0.0, moving));
  take(SceneClass::kStill, left);
  return mix;
}

}  // namespace quincunx
