// SPDX-License-Identifier: MIT
// Plays OpenGL and Vulkan drivers that share semaphores as opaque fds (GL_EXT_semaphore_fd), which no driver of a
// processor does: eventfds. A wait holds the host, which a real one does not. The protocol of binary semaphores is
// checked.
#pragma once

namespace quincunx::gl::testing {

class PretendSemaphores {
 public:
  enum class Flaw {
    kNone,
    kNeverSignalled,  // what OpenGL signals never arrives
  };
  explicit PretendSemaphores(Flaw flaw = Flaw::kNone);
  ~PretendSemaphores();
  PretendSemaphores(const PretendSemaphores&) = delete;
  PretendSemaphores& operator=(const PretendSemaphores&) = delete;

  static bool works();  // false: this build has no stand-in for Vulkan's loader
  int uses() const;     // signals and waits of OpenGL
  int faults() const;   // signals of one that is signalled, and waits that nobody ends
};

// Signals an eventfd, and notes where it was signalled already.
void signal_event(int fd);

}  // namespace quincunx::gl::testing
