// SPDX-License-Identifier: MIT
// Bytes that the passes of one frame read and write, each texel counted once. Pure.
#pragma once

#include <cstdint>

#include "quincunx/resolve_plan.h"

namespace quincunx {

std::uint64_t scale_bytes(const ResolveSettings& settings, Extent render);
std::uint64_t velocity_bytes(const ResolveSettings& settings, Extent render);
std::uint64_t quincunx_bytes(const ResolvePlan& plan, Extent render, Extent previous_render);
std::uint64_t reproject_bytes(const ResolvePlan& plan, Extent render, Extent previous_render);
std::uint64_t reprojected_bytes(const ResolvePlan& plan, Extent render, Extent previous_render);
std::uint64_t temporal_tiles_bytes(const ResolvePlan& plan, Extent render);
std::uint64_t temporal_light_bytes(const ResolvePlan& plan);
std::uint64_t temporal_bytes(const ResolvePlan& plan, Extent render, Extent previous_render);
std::uint64_t temporal_display_bytes(const ResolvePlan& plan, Extent render);
std::uint64_t motion_tiles_bytes(const ResolveSettings& settings, Extent render);
std::uint64_t motion_neighbours_bytes(const ResolveSettings& settings);
std::uint64_t motion_blur_bytes(const ResolveSettings& settings, Extent render);  // where everything moves
std::uint64_t sharpen_bytes(const ResolveSettings& settings);
std::uint64_t present_bytes(const ResolveSettings& settings);

}  // namespace quincunx
