// SPDX-License-Identifier: MIT
// The -D options of each kernel variant: rows of kernels/variants.txt. Pure.
#pragma once

#include <string>

#include "quincunx/resolve_plan.h"

namespace quincunx {

std::string scale_options(const ResolveSettings& settings);  // scale_point, scale_bilinear
std::string velocity_options(const ResolveSettings& settings);
std::string quincunx_options(const ResolvePlan& plan);
std::string present_options(const ResolveSettings& settings);
std::string clear_options(Storage storage, PixelFormat format);

}  // namespace quincunx
