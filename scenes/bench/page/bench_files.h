// SPDX-License-Identifier: MIT
// The pages of quincunx-bench and their scripts.
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx::bench {

std::span<const EmbeddedFile> embedded_bench_files();

}  // namespace quincunx::bench
