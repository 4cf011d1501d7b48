// SPDX-License-Identifier: MIT
// StreamBuffer: data that changes every frame, in a ring so that writing one frame does not wait for the
// last.
#pragma once

#include <cstddef>

#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"

namespace quincunx::scenes {

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
