// SPDX-License-Identifier: MIT
#include "tools/image/display_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::tools {
namespace {

constexpr float kLargestHalf = 65504;

float curve(ToneMap tone_map, float light) {
  const float x = std::isnan(light) ? 0.0f : std::clamp(light, 0.0f, kLargestHalf);
  switch (tone_map) {
    case ToneMap::kReinhard:
      return x / (1 + x);
    case ToneMap::kAces:
      return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
    case ToneMap::kClamp:
      break;
  }
  return std::min(x, 1.0f);
}

template <typename Function>
std::vector<float> with_colours(std::span<const float> rgba, const Function& function) {
  std::vector<float> result(rgba.begin(), rgba.end());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (i % 4 != 3) result[i] = function(result[i]);
  }
  return result;
}

}  // namespace

float linear_of_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::vector<float> display_light(std::span<const float> rgba, ToneMap tone_map, float exposure) {
  return with_colours(rgba, [&](float light) { return curve(tone_map, light * exposure); });
}

std::vector<float> light_before_reinhard(std::span<const float> rgba) {
  return with_colours(rgba, [](float shown) {
    const float x = std::clamp(shown, 0.0f, kLargestHalf / (1 + kLargestHalf));
    return x / (1 - x);
  });
}

}  // namespace quincunx::tools
