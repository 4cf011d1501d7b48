// SPDX-License-Identifier: MIT
// The kernel sources, embedded at build time.
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx {

// Every kernels/*.cl and every kernels/include/*.h.
std::span<const EmbeddedFile> embedded_kernel_files();

}  // namespace quincunx
