// SPDX-License-Identifier: MIT
// cache_folder: where compiled kernels, and what else is worth keeping between runs, are kept.
#pragma once

#include <filesystem>
#include <optional>

#include "quincunx/advanced/export.h"

namespace quincunx {

// $QUINCUNX_CACHE_DIR, else $XDG_CACHE_HOME/quincunx, else ~/.cache/quincunx. Nothing where the user wants none:
// QUINCUNX_CACHE_DIR set to an empty string. The folder may not exist yet. Safe to call from any thread.
QUINCUNX_API std::optional<std::filesystem::path> cache_folder();

}  // namespace quincunx
