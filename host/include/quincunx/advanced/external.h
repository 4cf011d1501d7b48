// SPDX-License-Identifier: MIT
// SharedMemory, Semaphore: memory and semaphores of another API, Vulkan's for example, that OpenCL uses where they are.
//
//   SharedMemory memory = device.import_memory({.fd = fd, .bytes = bytes, .device = uuid}).value();
//   Semaphore drawn = device.import_semaphore(fd_of_drawn).value();
//   drawn.wait(), memory.acquire();
//   service.dispatch({.colour = {.memory = memory.memory(), .format = ...}, ...}, ...);
//   memory.release(), resolved.signal();
//
// Each call enqueues on the device's queue, which is in-order, and does not wait. Both are used by the thread that uses
// the queue, and may be destroyed when the work that uses them is done.
#pragma once

#include <CL/cl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/status.h"

namespace quincunx {

// The number by which APIs identify a device (VkPhysicalDeviceIDProperties::deviceUUID); zeros: unknown.
using DeviceUuid = std::array<std::uint8_t, 16>;

// Returns its 32 hexadecimal digits.
QUINCUNX_API std::string uuid_text(const DeviceUuid& uuid);

enum class MemoryHandle : std::uint8_t {
  kOpaqueFd,  // VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, GL_HANDLE_TYPE_OPAQUE_FD_EXT
  kDmaBuf,    // Linux's, of any driver
  kMapped,    // a pointer to the memory, for devices that share the host's (DeviceInfo::host_unified_memory)
};

// Memory that another API allocated, as a whole: where an image begins in it is ImageView::offset.
struct ExternalMemory {
  MemoryHandle handle = MemoryHandle::kOpaqueFd;
  int fd = -1;             // stays the caller's, who may close it after the import
  void* mapped = nullptr;  // kMapped: outlives the import; at least 128 bytes aligned
  std::size_t bytes = 0;   // at most the size that was allocated; not all drivers check it
  DeviceUuid device = {};  // the device that it was allocated on; zeros: not checked. Not read with kMapped
};

// Memory that changes sides. The other API owns it first, and again after release(): neither side touches it while it
// is the other's. Move-only; OpenCL keeps the memory until its last command is done.
class QUINCUNX_API SharedMemory {
 public:
  ~SharedMemory();
  SharedMemory(SharedMemory&&) noexcept;
  SharedMemory& operator=(SharedMemory&&) noexcept;

  cl_mem memory() const;  // a buffer, for ImageView::memory
  std::size_t bytes() const;
  bool acquired() const;  // OpenCL owns it

  // Enqueues the change of owner to OpenCL: later commands see what the other API wrote before. Does nothing if OpenCL
  // owns the memory already. The other API must be done: a Semaphore or the host has waited for it.
  Status acquire();
  // Enqueues the change back. `done`, if not null, receives an event of that, which the caller releases; null if
  // nothing had to change.
  Status release(cl_event* done = nullptr);

 private:
  friend class Device;
  struct QUINCUNX_HIDDEN Impl;
  explicit SharedMemory(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// A binary semaphore of another API: each signal of one side lets one wait of the other go on. One that is never
// signalled blocks the queue, as OpenCL has no time-out: once a wait was enqueued, calls that wait for the queue, such
// as ResolveService::finish(), return kDeviceFailure after 30 s. Move-only.
class QUINCUNX_API Semaphore {
 public:
  ~Semaphore();
  Semaphore(Semaphore&&) noexcept;
  Semaphore& operator=(Semaphore&&) noexcept;

  Status wait();    // later commands begin when it was signalled
  Status signal();  // when earlier commands are done; flushes the queue, so that the other side may wait
  cl_command_queue queue() const;  // the device's

 private:
  friend class Device;
  struct QUINCUNX_HIDDEN Impl;
  explicit Semaphore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx
