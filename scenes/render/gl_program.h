// SPDX-License-Identifier: MIT
// Compiles and links the embedded shaders. The GL context is current; one thread.
#pragma once

#include <string>
#include <vector>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"

namespace quincunx::scenes {

// Links `vertex` and `fragment`: names of embedded files. Each is preceded by the version that the context has, CLIP(),
// which every gl_Position goes through, and one `#define` a line of `defines` ("NAME" or "NAME value").
// `#include "file.glsl"` on a line of its own inserts that embedded file, once a stage. Errors: kDeviceFailure with
// files, defines and the driver's log.
Result<gl::Program> link_program(const std::string& vertex, const std::string& fragment,
                                 const std::vector<std::string>& defines);

}  // namespace quincunx::scenes
