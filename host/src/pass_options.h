// SPDX-License-Identifier: MIT
// The -D options that several kernels share. An image carries its format with it, so the options name it for
// buffers only.
#pragma once

#include <string>

#include "quincunx/resolve_plan.h"

namespace quincunx {

const char* precision_of(PixelFormat format);          // "HALF" or "FLOAT"
const char* storage_option(Storage storage);           // "IMAGE" or "BUFFER"
std::size_t alpha_bytes(const ResolveSettings&);       // of a value of the history's alpha
std::string colour_options(const ResolveSettings&);    // SOURCE_STORAGE, SOURCE_FORMAT
std::string scale_options(const ResolveSettings&);     // the same and OUTPUT_FORMAT
std::string velocity_options(const ResolveSettings&);  // SOURCE_STORAGE, VELOCITY_FORMAT

}  // namespace quincunx
