// SPDX-License-Identifier: MIT
// The shader sources, embedded at build time. Static storage: valid for the whole life of the program, from
// any thread.
#pragma once

#include <span>
#include <string_view>

namespace quincunx::scenes {

struct EmbeddedFile {
  std::string_view name;  // "surface.frag.glsl": without the folder
  std::string_view text;
};

// Every scenes/shaders/*.glsl.
std::span<const EmbeddedFile> embedded_shader_files();

}  // namespace quincunx::scenes
