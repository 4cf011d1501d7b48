// SPDX-License-Identifier: MIT
// The fixed-function state of each part of a frame, and the buffers that it streams.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "quincunx/advanced/extent.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::scenes {

// Rows top-down, depth from 0 to 1, for the life of the guard; then GL's defaults for all that a frame
// changes.
class DrawState {
 public:
  DrawState();
  ~DrawState();
  DrawState(const DrawState&) = delete;
  DrawState& operator=(const DrawState&) = delete;
};

// Sets which triangles are seen from the front: those that run counter-clockwise, or with `mirrored` the others.
void set_winding(bool mirrored);

// Depth whole to infinity and the viewport's part of the reactive values to 0. Colour and velocity need no
// clear: surfaces and sky cover every pixel. Leaves the scissor on the viewport.
void clear_for_frame(const gl::RenderTargets& targets, Extent render);

// Makes the viewport of particles transparent black and unmarked. Leaves the scissor on it, and the stencil test off.
void clear_particles(const gl::RenderTargets& targets, Extent viewport);

// Gives a block of the colour target, `corner` its upper left pixel, one value in R, G and B, and alpha 1.
void fill_colour(const gl::RenderTargets& targets, glm::ivec2 corner, glm::ivec2 size, float value);

// From here on pixels with (x + y) % 2 == parity alone are drawn, where the targets have a checkerboard. Nothing writes
// the stencil, so a driver may test it before it shades.
void draw_checkerboard(int parity);

void set_opaque_state();      // writes colour, velocity, depth
void set_sky_state();         // colour and velocity where nothing was drawn
void set_depth_only_state();  // writes depth, whatever was there
void set_blended_state();     // blends premultiplied colour, accumulates reactive values

// Data that changes every frame, in a ring so that writing one frame does not wait for the last.
class StreamBuffer {
 public:
  StreamBuffer() = default;
  // `frame_bytes`: the most that one frame writes. Allocates once.
  explicit StreamBuffer(std::size_t frame_bytes)
      : buffer_(gl::Buffer::create()),
        frame_bytes_((frame_bytes + kAlignment - 1) / kAlignment * kAlignment) {
    gl::buffer_storage(buffer_.get(), static_cast<GLsizeiptr>(kFrames * frame_bytes_ + kAlignment));
  }

  // Moves to the next frame's part and writes its start; returns the offset in the buffer.
  GLintptr write(const void* data, std::size_t bytes) {
    frame_ = (frame_ + 1) % kFrames;
    const auto offset = static_cast<GLintptr>(frame_ * frame_bytes_);
    if (bytes > 0) gl::buffer_write(buffer_.get(), offset, static_cast<GLsizeiptr>(bytes), data);
    return offset;
  }

  GLuint get() const { return buffer_.get(); }
  std::size_t frame_bytes() const { return frame_bytes_; }

 private:
  static constexpr std::size_t kFrames = 3;
  static constexpr std::size_t kAlignment = 256;  // the largest uniform buffer alignment in use

  gl::Buffer buffer_;
  std::size_t frame_bytes_ = 0;
  std::size_t frame_ = 0;
};

}  // namespace quincunx::scenes
