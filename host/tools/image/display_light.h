// SPDX-License-Identifier: MIT
// Light as the screen shows it: sRGB decoding and the tone curves of the present pass, in host memory. Pure.
#pragma once

#include <span>
#include <vector>

#include "quincunx/advanced/method.h"

namespace quincunx::tools {

// Linear light of an sRGB encoded value, both in [0, 1] (IEC 61966-2-1).
float linear_of_srgb(float encoded);

// Returns the light that a renderer stores in RGBA8 colour, before it is encoded: each colour times `exposure` through
// the curve, in [0, 1]; NaN counts as 0. `rgba`: four values a pixel; alpha stays.
std::vector<float> display_light(std::span<const float> rgba, ToneMap tone_map, float exposure);

// Takes display_light() with ToneMap::kReinhard and exposure 1 back, up to 65504. Alpha stays.
std::vector<float> light_before_reinhard(std::span<const float> rgba);

}  // namespace quincunx::tools
