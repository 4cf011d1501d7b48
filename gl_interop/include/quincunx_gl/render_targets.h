// SPDX-License-Identifier: MIT
// RenderTargets: the textures that a renderer draws into.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/image.h"
#include "quincunx/status.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {

struct TargetNeeds {
  Extent target_extent = {};  // allocated size, at least the largest viewport
  bool velocity = true;       // RG16F, uv per frame
  bool reactive = true;       // R8
  bool checkerboard = false;  // a stencil whose lowest bit is (x + y) % 2 of each pixel
  PixelFormat colour =
      PixelFormat::kRGBA16F;  // or RGBA8, which GL encodes as sRGB where it writes and blends
};

// One framebuffer with its textures, all of the target extent. The viewport is its part from (0, 0), which
// with glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE) is the top left; texture row 0 is the top row. Move-only.
// Fragment outputs: location 0 colour (linear, premultiplied), 1 velocity, 2 reactive; the draw buffers of
// what was not asked for are GL_NONE. Draw into RGBA8 with GL_FRAMEBUFFER_SRGB enabled.
class QUINCUNX_API RenderTargets {
 public:
  // Errors: kInvalidArgument for an extent that OpenGL has no textures of; kUnsupported where the driver takes no such
  // framebuffer.
  static Result<RenderTargets> create(const TargetNeeds& needs);

  Extent extent() const { return extent_; }
  std::uint64_t bytes() const;  // sum over all textures
  GLuint framebuffer() const { return framebuffer_.get(); }
  GLuint colour() const { return colour_.get(); }
  PixelFormat colour_format() const { return colour_format_; }
  GLuint depth() const { return depth_.get(); }        // DEPTH_COMPONENT32F, or DEPTH32F_STENCIL8
  GLuint velocity() const { return velocity_.get(); }  // 0: not planned
  GLuint reactive() const { return reactive_.get(); }  // 0: not planned
  bool has_checkerboard() const { return has_checkerboard_; }

  // Clears the viewport's part of colour, velocity and reactive (scissored, to 0), and depth whole (to 0:
  // infinity). Keeps the stencil and all state.
  void clear(Extent render) const;

 private:
  explicit RenderTargets(const TargetNeeds& needs);

  Extent extent_ = {};
  PixelFormat colour_format_;
  bool has_checkerboard_ = false;
  Framebuffer framebuffer_;
  Texture colour_;
  Texture depth_;
  Texture velocity_;
  Texture reactive_;
};

// The top left `render_extent` of each target, tightly packed, top row first; empty for missing targets.
struct TargetPixels {
  Extent render_extent;
  std::vector<std::uint16_t> colour;    // RGBA, half; empty where the targets encode it
  std::vector<std::uint8_t> codes;      // RGBA8, sRGB encoded; empty where they do not
  std::vector<float> depth;             // reversed infinite
  std::vector<std::uint16_t> velocity;  // RG, half, uv
  std::vector<std::uint8_t> reactive;
};

// Reads targets into host memory, for files and tests: waits for GL. Errors: kInvalidArgument where `render` leaves the
// targets; kUnsupported where an OpenGL ES driver has no way to read depth.
QUINCUNX_API Result<TargetPixels> read_targets(const RenderTargets& targets, Extent render);

}  // namespace quincunx::gl
