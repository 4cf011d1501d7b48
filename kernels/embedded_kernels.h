// SPDX-License-Identifier: MIT
// The kernel sources, embedded at build time. Static storage: valid for the whole life of the program, from any
// thread.
#pragma once

#include <span>
#include <string_view>

namespace quincunx {

struct EmbeddedFile {
  std::string_view name;  // "resolve_quincunx.cl", "params.h": without the folder
  std::string_view text;
};

// Every kernels/*.cl and every kernels/include/*.h.
std::span<const EmbeddedFile> embedded_kernel_files();

}  // namespace quincunx
