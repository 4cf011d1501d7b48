// SPDX-License-Identifier: MIT
// current_context: the OpenGL context that is current on this thread, whoever made it.
#pragma once

#include "quincunx_gl/context.h"

namespace quincunx::gl {

struct CurrentContext {
  WindowSystem system = WindowSystem::kEgl;
  void* context = nullptr;  // null: none
  void* display = nullptr;

  friend bool operator==(const CurrentContext&, const CurrentContext&) = default;
};

CurrentContext current_context();

}  // namespace quincunx::gl
