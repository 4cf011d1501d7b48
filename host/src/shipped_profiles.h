// SPDX-License-Identifier: MIT
// The files of host/profiles, embedded at build time.
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx {

// Each as quincunx-bench --tune wrote it, for all devices of its platform and kind.
std::span<const EmbeddedFile> shipped_profile_files();

}  // namespace quincunx
