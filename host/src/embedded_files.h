// SPDX-License-Identifier: MIT
// The files that are compiled in; their sources are generated (cmake/embed.cmake).
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx {

// The front that is built in.
std::span<const EmbeddedFile> embedded_front_file();

// The files of host/profiles, each as quincunx-bench --tune wrote it, for all devices of its platform and kind.
std::span<const EmbeddedFile> shipped_profile_files();

}  // namespace quincunx
