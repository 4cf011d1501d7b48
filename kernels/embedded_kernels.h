// SPDX-License-Identifier: MIT
// The kernel sources, embedded at build time.
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx {

// Every kernel and every header, named by its path below kernels/ or kernels/include/: "reproject.cl",
// "temporal/temporal_light.cl", "temporal/history.h".
std::span<const EmbeddedFile> embedded_kernel_files();

}  // namespace quincunx
