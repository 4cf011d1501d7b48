// SPDX-License-Identifier: MIT
#include "predictive_settings.h"

#include <fmt/format.h>

#include <cmath>

namespace quincunx {

Status check(const PredictiveSettings& settings) {
  if (settings.buffers < 2 || settings.buffers > 8) {
    return Status::invalid(fmt::format("buffers is {}; it must lie in [2, 8]", settings.buffers));
  }
  if (!(settings.fixed_part >= 0 && settings.fixed_part <= 0.9)) {
    return Status::invalid(fmt::format("fixed_part is {}; it must lie in [0, 0.9]", settings.fixed_part));
  }
  const BlurAware& blur = settings.blur_aware;
  if (!(blur.start_px >= 0 && blur.full_px > blur.start_px && std::isfinite(blur.full_px))) {
    return Status::invalid(
        fmt::format("blur_aware is {} to {} px; the first must be at least 0 and below the second",
                    blur.start_px, blur.full_px));
  }
  if (!(blur.lowest_scale > 0 && blur.lowest_scale <= 1)) {
    return Status::invalid(
        fmt::format("blur_aware.lowest_scale is {}; it must lie in (0, 1]", blur.lowest_scale));
  }
  return {};
}

}  // namespace quincunx
