// SPDX-License-Identifier: MIT
// The planes of a frame that the bridge hands over, in GL's words, and where they lie in the memory of a slot.
// Arithmetic only.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <vector>

#include "quincunx_gl/bridge.h"

namespace quincunx::gl {

// GL's names for the texels of a format, such that a transfer is a plain copy.
struct GlFormat {
  GLenum internal = GL_NONE;
  GLenum format = GL_NONE;
  GLenum type = GL_NONE;
};

// What OpenGL and OpenCL call a format.
struct FormatNames {
  PixelFormat format = PixelFormat::kNone;
  GlFormat gl;
  cl_image_format cl;
  std::array<GLint, 4> bits;  // of red, green, blue and alpha, as OpenGL counts them
  GLint type;                 // of red: GL_UNSIGNED_NORMALIZED or GL_FLOAT
};
const FormatNames& names_of(PixelFormat format);

inline GlFormat gl_format(PixelFormat format) {
  return names_of(format).gl;
}
inline cl_image_format cl_format(PixelFormat format) {
  return names_of(format).cl;
}

enum class PlaneKind { kColour, kDepth, kVelocity, kReactive };

struct Plane {
  PlaneKind kind = PlaneKind::kColour;
  PixelFormat format = PixelFormat::kNone;
  GLenum attachment = GL_NONE;  // attachment point of RenderTargets' framebuffer
};

// Lists colour and the planes that the settings ask for.
std::vector<Plane> planes_of(const BridgeSettings& settings);

// Returns the needs of one framebuffer of the bridge.
TargetNeeds target_needs(const BridgeSettings& settings);

ImageView& view_of(SharedFrame& frame, PlaneKind kind);

// The place of each plane in the memory of a slot.
//
// The planes lie one behind the other, in regions that are sized for the largest viewport and never move. With
// Targets::kViewport a region is one image of that size. With Targets::kPlaced it holds an image of just the frame's
// viewport, whose rows follow each other without a gap, as far as `row_texels` allows.
struct FrameLayout {
  SharedFrame views;  // images of the largest viewport, in buffers, without memory
  std::size_t bytes = 0;
};

// Lays the planes out. `row_texels`: rows of placed images start at multiples of so many texels, at least 1.
FrameLayout lay_out(std::vector<Plane> planes, Extent target, Targets targets, int row_texels);

// Makes a placed image one of the viewport `render`, which is at most the largest: the same memory, another pitch.
void place(ImageView& view, Extent render, int row_texels);

}  // namespace quincunx::gl
