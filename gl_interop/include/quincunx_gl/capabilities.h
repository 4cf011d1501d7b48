// SPDX-License-Identifier: MIT
// Abilities of the current OpenGL context beyond those that OpenGL 4.5 and OpenGL ES 3.1 have in common.
#pragma once

#include <string>

#include "quincunx/advanced/export.h"

namespace quincunx::gl {

enum class Api {
  kGl45,  // desktop OpenGL 4.5 core
  kEs3,   // OpenGL ES 3.1 or later
};

QUINCUNX_API const char* name_of(Api api);  // "4.5", "es3"

struct Capabilities {
  Api api = Api::kGl45;
  int version = 0;              // 45, 31, 32
  bool clip_control = false;    // else shaders turn y over and spread depth: CLIP_CONTROL of link_program()
  bool depth_clamp = false;     // else shadow casters before the near plane are moved onto it
  bool persistent_map = false;  // else pixels go through client memory, and GL is waited for
  bool reads_depth = false;     // glReadPixels takes depth; else it is drawn into R32F first
  bool encodes_on_demand = false;  // GL_FRAMEBUFFER_SRGB is a switch; else encoded targets are always encoded
  bool time_queries = false;
  std::string missing;  // needs of the renderer that the context lacks; empty: none
};

// Returns the abilities of the context that is current on this thread; found once for each context.
QUINCUNX_API const Capabilities& capabilities();

// Finds them again, for a new context, which may have the address of one that was destroyed.
QUINCUNX_API const Capabilities& renewed_capabilities();

}  // namespace quincunx::gl
