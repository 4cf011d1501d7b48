// SPDX-License-Identifier: MIT
// VulkanDevice: allocates memory, and makes semaphores, that OpenGL and OpenCL can import. Neither can export any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "quincunx/device.h"
#include "vulkan.h"

namespace quincunx::gl {

// Drivers use host memory in place only where it starts on a page; PoCL's wide loads want 128 bytes. GL promises no
// more than 64.
constexpr std::size_t kPageBytes = 4096;

inline std::size_t bytes_to_page(const void* address) {
  const auto value = reinterpret_cast<std::uintptr_t>(address);
  return (kPageBytes - value % kPageBytes) % kPageBytes;
}

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

class VulkanDevice {
 public:
  // Opens Vulkan's device of a UUID, once, through the loader, or the drivers themselves where no loader is installed.
  // It stays until the process ends: with an instance of NVIDIA's (580.159) EGL's display goes, and with that OpenGL's
  // context. Throws InteropError, which says what kept it. Thread-safe.
  static const VulkanDevice& open(const DeviceUuid& uuid);
  // The caller's, who keeps them for as long. Throws InteropError where they cannot export memory.
  static std::unique_ptr<const VulkanDevice> adopt(vk::GetInstanceProcAddr get, vk::Instance instance,
                                                   vk::PhysicalDevice physical, vk::Device device);
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  class Memory {
   public:
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    vk::Buffer buffer() const { return buffer_; }
    std::size_t size() const { return size_; }        // as it was allocated, which importers must be told
    bool dedicated() const { return dedicated_; }     // importers must be told that, too
    std::uint8_t* mapped() const { return mapped_; }  // a page's start; null where it was not asked for
    std::size_t start() const { return start_; }      // of what is mapped, in the buffer
    Fd fd() const;                                    // another one for each importer
    // `bytes` from start() on, for OpenCL. Throws InteropError.
    SharedMemory import_to(const Device& device, std::size_t bytes) const;

   private:
    friend class VulkanDevice;
    explicit Memory(const VulkanDevice& device) : device_(device) {}
    const VulkanDevice& device_;
    vk::Buffer buffer_ = 0;
    vk::DeviceMemory memory_ = 0;
    std::size_t size_ = 0;
    bool dedicated_ = false;
    std::uint8_t* mapped_ = nullptr;
    std::size_t start_ = 0;
  };
  enum class Place { kDevice, kMapped };  // kMapped: the host's, and mapped
  // At least `bytes` from start() on. Throws InteropError.
  std::unique_ptr<Memory> allocate(std::size_t bytes, Place place) const;

  bool has_semaphores() const { return functions_.GetSemaphoreFd != nullptr; }
  // A binary semaphore, not signalled, for two importers, or one and Vulkan itself; `kept` outlives all uses.
  struct SharedSemaphore {
    Fd first, second;
    std::shared_ptr<void> kept;
    vk::Semaphore semaphore;
  };
  SharedSemaphore semaphore() const;  // throws InteropError

  DeviceUuid uuid() const { return uuid_of(physical_); }
  vk::VoidFunction function(const char* name) const {
    return instance_functions_.DeviceProcAddr(device_, name);
  }

 private:
  VulkanDevice() = default;
  std::string open_through(const std::string& library, const char* entry, const DeviceUuid& uuid);
  std::string find_functions(vk::GetInstanceProcAddr get);  // "" or what is in the way
  std::string make_device();
  std::string find_device_functions();
  DeviceUuid uuid_of(vk::PhysicalDevice device) const;
  std::uint32_t memory_type(std::uint32_t allowed, Place place) const;

  vk::Instance instance_ = nullptr;
  vk::PhysicalDevice physical_ = nullptr;
  vk::Device device_ = nullptr;
  vk::InstanceFunctions instance_functions_ = {};
  vk::DeviceFunctions functions_ = {};
};

}  // namespace quincunx::gl
