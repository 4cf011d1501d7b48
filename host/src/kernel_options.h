// SPDX-License-Identifier: MIT
// The -D options of each kernel variant: rows of kernels/variants.txt. Pure.
#pragma once

#include <string>

#include "filter_table.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// scale_point, scale_bilinear, scale_noise, scale_noise_offset
std::string scale_options(const ResolveSettings& settings);
std::string filter_options(Filter filter, const ResolveSettings& settings, int taps);  // taps 4, or 0: any
std::string velocity_options(const ResolveSettings& settings);
std::string blur_options(const ResolveSettings& settings);  // motion_blur
std::string quincunx_options(const ResolvePlan& plan);
std::string reproject_options(const ResolvePlan& plan);
std::string reprojected_options(const ResolvePlan& plan);  // resolve_reprojected
std::string temporal_tiles_options(const ResolvePlan& plan);
std::string temporal_options(const ResolvePlan& plan);  // resolve_temporal
std::string temporal_display_options(const ResolvePlan& plan);
std::string sharpen_options(const ResolveSettings& settings);
std::string present_options(const ResolveSettings& settings);
std::string clear_options(Storage storage, PixelFormat format);

}  // namespace quincunx
