// SPDX-License-Identifier: MIT
// Textures of the caller's: whether they are what the bridge takes.
#pragma once

#include <string>
#include <vector>

#include "frame_layout.h"
#include "quincunx_gl/bridge.h"

namespace quincunx::gl {

FrameTextures textures_of(const RenderTargets& targets);
GLuint texture_of(const FrameTextures& textures, PlaneKind kind);

// Whether the texture, which is right for a depth plane, has a depth format; else it is R32F.
bool has_depth_format(GLuint texture);

// Checks the textures of these planes against a viewport. Errors: kInvalidArgument; the message names every fault.
Status check_textures(const std::vector<Plane>& planes, const FrameTextures& textures, Extent render);

// Checks a texture that gets a picture.
Status check_picture_texture(GLuint texture, PixelFormat format, Extent output);

}  // namespace quincunx::gl
