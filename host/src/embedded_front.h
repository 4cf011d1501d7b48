// SPDX-License-Identifier: MIT
// The file of host/data that is compiled in; its source is generated (cmake/embed.cmake).
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx {

std::span<const EmbeddedFile> embedded_front_file();  // one

}  // namespace quincunx
