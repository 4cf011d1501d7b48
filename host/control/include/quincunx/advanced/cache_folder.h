// SPDX-License-Identifier: MIT
// cache_folder: the folder of compiled kernels and other results that are kept between runs.
#pragma once

#include <filesystem>
#include <optional>

#include "quincunx/advanced/export.h"

namespace quincunx {

// Returns $QUINCUNX_CACHE_DIR, else $XDG_CACHE_HOME/quincunx, else ~/.cache/quincunx; nothing if QUINCUNX_CACHE_DIR is
// set to an empty string. The folder may not exist yet. Safe to call from any thread.
QUINCUNX_API std::optional<std::filesystem::path> cache_folder();

}  // namespace quincunx
