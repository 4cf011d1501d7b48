// SPDX-License-Identifier: MIT
// The planes of a frame that the bridge hands over, in GL's words.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <vector>

#include "quincunx_gl/bridge.h"

namespace quincunx::gl {

// How GL names the texels of a format, such that a transfer is a plain copy.
struct GlFormat {
  GLenum internal = GL_NONE;
  GLenum format = GL_NONE;
  GLenum type = GL_NONE;
};

GlFormat gl_format(PixelFormat format);  // of the formats that the bridge uses

// The channels of an OpenCL image of a format.
cl_image_format cl_format(PixelFormat format);

enum class PlaneKind { kColour, kDepth, kVelocity, kReactive };

struct Plane {
  PlaneKind kind = PlaneKind::kColour;
  PixelFormat format = PixelFormat::kNone;
  GLenum attachment = GL_NONE;  // of RenderTargets' framebuffer
};

// Colour, and what the settings ask for.
std::vector<Plane> planes_of(const BridgeSettings& settings);

// What one framebuffer of the bridge holds.
TargetNeeds target_needs(const BridgeSettings& settings);

ImageView& view_of(SharedFrame& frame, PlaneKind kind);

}  // namespace quincunx::gl
