// SPDX-License-Identifier: MIT
// The shader sources, embedded at build time.
#pragma once

#include <span>

#include "embedded_file.h"

namespace quincunx::scenes {

// Every scenes/render/shaders/*.glsl.
std::span<const EmbeddedFile> embedded_shader_files();

}  // namespace quincunx::scenes
