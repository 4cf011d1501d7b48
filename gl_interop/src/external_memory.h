// SPDX-License-Identifier: MIT
// Memory that Vulkan allocates and OpenGL and OpenCL import, and semaphores that order the two. A frame then never
// leaves the device: OpenGL reads its viewport into a buffer that OpenCL's kernels read where it is.
//
// A CPU's OpenCL takes the pointer at which Vulkan maps the memory, as lavapipe does.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "quincunx/advanced/external.h"
#include "quincunx/device.h"
#include "quincunx_gl/handle.h"
#include "vulkan_memory.h"

namespace quincunx::gl {

struct MemoryObjectTraits {
  static GLuint create();
  static void destroy(GLuint name) { glDeleteMemoryObjectsEXT(1, &name); }
};
struct GlSemaphoreTraits {
  static GLuint create();
  static void destroy(GLuint name) { glDeleteSemaphoresEXT(1, &name); }
};

// Memory that all three know. The last member is freed first.
struct ExternalBuffer {
  std::unique_ptr<VulkanDevice::Memory> memory;
  Handle<MemoryObjectTraits> memory_object;
  Buffer gl;
  std::size_t start = 0;          // OpenCL's byte 0 in OpenGL's buffer
  std::uint8_t* bytes = nullptr;  // the host's view of it, where it is mapped
  std::optional<SharedMemory> cl;
};

// The order of OpenGL's and OpenCL's work on one buffer, kept by the device: two semaphores, one for each direction.
// Nothing waits on the host. Functions throw InteropError.
class DeviceOrder {
 public:
  DeviceOrder(const VulkanDevice& vulkan, const Device& device);

  void gl_done(
      GLuint buffer);  // what OpenGL was told so far comes before what OpenCL is told after cl_waits()
  void cl_waits();
  void cl_done();
  void gl_waits(GLuint buffer);

 private:
  struct Direction {
    std::shared_ptr<void> kept;
    Handle<GlSemaphoreTraits> gl;
    std::optional<Semaphore> cl;
    bool signalled = false;  // and not waited for yet
  };
  static Direction make(const VulkanDevice& vulkan, const Device& device);

  Device device_;
  Direction to_cl_;
  Direction to_gl_;
};

// What makes them for the current OpenGL context and an OpenCL device.
class Exporter {
 public:
  // Opens Vulkan's device and has a pattern carried both ways, which must arrive byte for byte. Throws InteropError:
  // one clause that says what is in the way. `semaphores`: false leaves them out, and the host waits. Within an
  // ErrorScope of the caller's, as all that follows.
  static std::shared_ptr<const Exporter> create(const Device& device, bool semaphores = true);

  ExternalBuffer allocate(const Device& device, std::size_t bytes) const;
  std::optional<DeviceOrder> order(const Device& device) const;  // nothing: the host waits
  const std::string& reason() const { return reason_; }          // one sentence: how it works here

 private:
  Exporter() = default;
  void probe(const Device& device) const;

  const VulkanDevice* vulkan_ = nullptr;
  bool mapped_ = false;
  bool semaphores_ = false;
  std::string reason_;
};

// Returns the UUID of OpenGL's device; zeros where the driver does not tell.
DeviceUuid gl_device_uuid();

// Reads a buffer of OpenGL's that cannot be mapped.
class BufferReader {
 public:
  // Returns `bytes` from `offset`, valid until the next call or release().
  const std::uint8_t* read(GLuint buffer, std::size_t offset, std::size_t bytes);
  void release();

 private:
  Buffer staging_;
  std::size_t size_ = 0;
  bool mapped_ = false;
};

}  // namespace quincunx::gl
