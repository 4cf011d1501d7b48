// SPDX-License-Identifier: MIT
// Waiting for GL (Fence), and how long something took (Stopwatch).
#pragma once

#include <epoxy/gl.h>

#include <chrono>
#include <utility>

#include "cl_handle.h"

namespace quincunx::gl {

// Waits until the GL commands issued before it are done.
class Fence {
 public:
  Fence() = default;  // nothing to wait for
  ~Fence() { reset(); }
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;

  // Sets the fence behind what was issued so far and sends it off.
  void set() {
    reset();
    sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
  }

  // Returns whether all of it is done; does not wait. Nothing to wait for is done.
  bool done() const {
    if (sync_ == nullptr) return true;
    const GLenum result = glClientWaitSync(sync_, 0, 0);
    if (result == GL_WAIT_FAILED) throw InteropError("glClientWaitSync failed; the GL context may be lost");
    return result != GL_TIMEOUT_EXPIRED;
  }

  // Throws InteropError when the GPU has hung.
  void wait() {
    if (sync_ == nullptr) return;
    const GLenum result = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kTimeoutNs);
    reset();
    if (result == GL_TIMEOUT_EXPIRED) throw InteropError("OpenGL did not finish the frame within 30 s");
    if (result == GL_WAIT_FAILED) throw InteropError("glClientWaitSync failed; the GL context may be lost");
  }

 private:
  static constexpr GLuint64 kTimeoutNs = 30'000'000'000;

  void reset() {
    if (sync_ != nullptr) glDeleteSync(std::exchange(sync_, nullptr));
  }

  GLsync sync_ = nullptr;
};

// Host time since it was made.
class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace quincunx::gl
