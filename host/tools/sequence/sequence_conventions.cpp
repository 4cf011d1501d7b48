// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_conventions.h"

#include "tools/sequence/exchange_format.h"

namespace quincunx::tools {

const char* name_of(VelocityConvention convention) {
  switch (convention) {
    case VelocityConvention::kNuke:
      return "nuke";
    case VelocityConvention::kBlender:
      return "blender";
    case VelocityConvention::kFsr2:
      return "fsr2";
    case VelocityConvention::kNdc:
      return "ndc";
    case VelocityConvention::kScale:
      return "scale";
  }
  return "unknown";
}

const char* name_of(DepthKind kind) {
  switch (kind) {
    case DepthKind::kLinear:
      return "linear";
    case DepthKind::kDevice:
      return "device";
    case DepthKind::kDeviceReversed:
      return "device-reversed";
  }
  return "unknown";
}

std::optional<DepthKind> depth_kind_named(std::string_view name) {
  for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed}) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

void to_velocity(const VelocityUnits& units, Extent extent, std::span<Vec2> motion) {
  const auto width = static_cast<float>(extent.width);
  const auto height = static_cast<float>(extent.height);
  switch (units.convention) {
    case VelocityConvention::kNuke:
    case VelocityConvention::kBlender:
      for (Vec2& m : motion)
        m = velocity_from_backward(m, extent);
      return;
    case VelocityConvention::kFsr2:
      for (Vec2& m : motion)
        m = {-m.x / width, -m.y / height};
      return;
    case VelocityConvention::kNdc:
      for (Vec2& m : motion)
        m = {m.x * 0.5f, m.y * -0.5f};
      return;
    case VelocityConvention::kScale:
      for (Vec2& m : motion)
        m = {m.x * units.scale.x, m.y * units.scale.y};
      return;
  }
}

void to_reversed_depth(DepthKind kind, float near_plane, std::span<float> depth) {
  switch (kind) {
    case DepthKind::kLinear:
      for (float& d : depth)
        d = d > 0 ? reversed_depth(d, near_plane) : 0;
      return;
    case DepthKind::kDevice:
      for (float& d : depth)
        d = 1 - d;
      return;
    case DepthKind::kDeviceReversed:
      return;
  }
}

float nothing_seen(DepthKind kind) {
  return kind == DepthKind::kDevice ? 1.0f : 0.0f;
}

}  // namespace quincunx::tools
