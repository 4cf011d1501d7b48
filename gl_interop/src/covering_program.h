// SPDX-License-Identifier: MIT
// A program whose three vertices, drawn as triangles without any attribute, cover the viewport. GLSL ES 3.10, which
// OpenGL 4.5 takes as well.
#pragma once

#include "quincunx_gl/handle.h"

namespace quincunx::gl {

// `name` stands in the message. A context must be current. Throws InteropError if it does not link.
Program covering_program(const char* fragment_source, const char* name);

}  // namespace quincunx::gl
