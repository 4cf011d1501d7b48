// SPDX-License-Identifier: MIT
// Sequence conventions: what the motion and depth of other renderers' files mean, in the library's terms
// (docs/inputs.md, docs/sequences.md). Pure; thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "quincunx/extent.h"
#include "quincunx/status.h"

namespace quincunx::tools {

enum class VelocityConvention : std::uint8_t {
  kNuke,     // previous - this position, pixels of the image, +u right, +v up: the exchange format
  kBlender,  // of the Vector pass X and Y, which are the same
  kFsr2,     // previous - this position, pixels of the image, y down
  kNdc,      // this - previous position in normalised device coordinates, -1 to 1, y up
  kScale,    // this - previous position in uv, y down, after multiplication by a scale
};

struct VelocityUnits {
  VelocityConvention convention = VelocityConvention::kNuke;
  Vec2 scale = {1, 1};  // of kScale
};

enum class DepthKind : std::uint8_t {
  kLinear,          // distance along the view axis
  kDevice,          // 0 at the near plane, 1 far away
  kDeviceReversed,  // 1 at the near plane, 0 far away: the library's own
};

const char* name_of(VelocityConvention convention);  // "nuke"
const char* name_of(DepthKind kind);                 // "device-reversed"
std::optional<DepthKind> depth_kind_named(std::string_view name);

// In place, to uv velocity (this position - previous position, +y down) of an image of this extent. Each
// value meets one rounding: a division by the extent where pixels are meant.
void to_velocity(const VelocityUnits& units, Extent extent, std::span<Vec2> motion);

// In place, to reversed infinite depth. kDeviceReversed stays bit for bit. `near_plane` counts for kLinear
// only, in the unit of the values; distances that are not positive mean that nothing was seen, as very large
// ones do.
void to_reversed_depth(DepthKind kind, float near_plane, std::span<float> depth);

// What a pixel holds that no file says anything about: infinitely far away.
float nothing_seen(DepthKind kind);

}  // namespace quincunx::tools
