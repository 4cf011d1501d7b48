// SPDX-License-Identifier: MIT
// EmbeddedFile: a text file that the build made part of the program (cmake/embed.cmake).
#pragma once

#include <string_view>

namespace quincunx {

struct EmbeddedFile {
  std::string_view
      name;  // "sharpen.cl", "temporal/history.h": the path below a root folder, if one was named
  std::string_view text;  // static storage: valid for the whole life of the program, from any thread
};

}  // namespace quincunx
