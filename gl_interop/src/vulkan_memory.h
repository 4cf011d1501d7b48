// SPDX-License-Identifier: MIT
// VulkanDevice: allocates memory, and makes semaphores, that OpenGL and OpenCL can import. Neither can export any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "quincunx/advanced/external.h"
#include "vulkan.h"

namespace quincunx::gl {

// Owns a file descriptor.
class Fd {
 public:
  Fd() = default;
  explicit Fd(int fd) : fd_(fd) {}
  ~Fd();
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;

  int get() const { return fd_; }
  int give_away() { return std::exchange(fd_, -1); }  // to an API that takes it over

 private:
  int fd_ = -1;
};

// Vulkan's device of a UUID, through the loader, or the drivers themselves where no loader is installed. It stays until
// the process ends: with an instance of NVIDIA's (580.159) EGL's display goes, and with that OpenGL's context.
class VulkanDevice {
 public:
  // Opens it once. Throws InteropError, which says what kept it. Thread-safe.
  static const VulkanDevice& open(const DeviceUuid& uuid);
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  class Memory {
   public:
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    std::size_t size() const { return size_; }     // as it was allocated, which importers must be told
    bool dedicated() const { return dedicated_; }  // importers must be told that, too
    void* mapped() const { return mapped_; }       // null where it was not asked for
    Fd fd() const;                                 // another one for each importer

   private:
    friend class VulkanDevice;
    explicit Memory(const VulkanDevice& device) : device_(device) {}
    const VulkanDevice& device_;
    vk::Buffer buffer_ = 0;
    vk::DeviceMemory memory_ = 0;
    std::size_t size_ = 0;
    bool dedicated_ = false;
    void* mapped_ = nullptr;
  };
  enum class Place { kDevice, kMapped };  // kMapped: the host's, and mapped
  // At least `bytes`. Throws InteropError.
  std::unique_ptr<Memory> allocate(std::size_t bytes, Place place) const;

  bool has_semaphores() const { return functions_.GetSemaphoreFd != nullptr; }
  // A binary semaphore, not signalled, for two importers; `kept` outlives both.
  struct SharedSemaphore {
    Fd first, second;
    std::shared_ptr<void> kept;
  };
  SharedSemaphore semaphore() const;  // throws InteropError

 private:
  VulkanDevice() = default;
  std::string open_through(const std::string& library, const char* entry, const DeviceUuid& uuid);
  std::string make_device();
  std::uint32_t memory_type(std::uint32_t allowed, Place place) const;

  vk::Instance instance_ = nullptr;
  vk::PhysicalDevice physical_ = nullptr;
  vk::Device device_ = nullptr;
  vk::InstanceFunctions instance_functions_ = {};
  vk::DeviceFunctions functions_ = {};
};

}  // namespace quincunx::gl
