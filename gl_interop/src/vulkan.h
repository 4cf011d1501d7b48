// SPDX-License-Identifier: MIT
// As much of Vulkan 1.1 as allocates memory and semaphores that other APIs import, by the numbers and layouts of its
// specification. Declared here, so that nothing of Vulkan is needed to build: of its headers some forty lines are used.
// tests/interop/vulkan_test.cpp compares them with the headers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace quincunx::gl::vk {

using Instance = struct InstanceObject*;
using PhysicalDevice = struct PhysicalDeviceObject*;
using Device = struct DeviceObject*;
using Buffer = std::uint64_t;
using DeviceMemory = std::uint64_t;
using Semaphore = std::uint64_t;

constexpr std::uint32_t kVersion11 = (1u << 22) | (1u << 12);
constexpr std::uint32_t kOpaqueFd = 1;  // of memory and of semaphores
constexpr std::uint32_t kTransferSourceAndTarget = 3, kStorageBuffer = 0x20;
constexpr std::uint32_t kDeviceLocal = 1, kHostVisible = 2, kHostCoherent = 4, kHostCached = 8;
constexpr std::uint32_t kDedicatedOnly = 1, kExportable = 2;
constexpr std::uint64_t kWholeSize = ~std::uint64_t{0};

// The first two fields of every structure.
struct Head {
  std::int32_t type;
  const void* next = nullptr;
};

struct ApplicationInfo {
  Head head = {0};
  const char* name = "quincunx";
  std::uint32_t version = 0;
  const char* engine = nullptr;
  std::uint32_t engine_version = 0;
  std::uint32_t api_version = kVersion11;
};
struct InstanceCreateInfo {
  Head head = {1};
  std::uint32_t flags = 0;
  const ApplicationInfo* application;
  std::uint32_t layer_count = 0;
  const char* const* layers = nullptr;
  std::uint32_t extension_count = 0;
  const char* const* extensions = nullptr;
};
struct DeviceQueueCreateInfo {
  Head head = {2};
  std::uint32_t flags = 0;
  std::uint32_t family = 0;
  std::uint32_t count = 1;
  const float* priorities;
};
struct DeviceCreateInfo {
  Head head = {3};
  std::uint32_t flags = 0;
  std::uint32_t queue_count = 1;
  const DeviceQueueCreateInfo* queues;
  std::uint32_t layer_count = 0;
  const char* const* layers = nullptr;
  std::uint32_t extension_count;
  const char* const* extensions;
  const void* features = nullptr;
};
struct ExtensionProperties {
  char name[256];
  std::uint32_t version;
};
struct IdProperties {
  Head head = {1000071004};
  std::uint8_t device_uuid[16];
  std::uint8_t driver_uuid[16];
  std::uint8_t device_luid[8];
  std::uint32_t node_mask;
  std::uint32_t luid_valid;
};
struct PhysicalDeviceProperties2 {
  Head head = {1000059001};
  std::uint32_t api_version;
  std::uint32_t rest[1023];  // more than VkPhysicalDeviceProperties has
};
struct MemoryProperties {
  std::uint32_t type_count;
  struct {
    std::uint32_t flags;
    std::uint32_t heap;
  } types[32];
  std::uint32_t heap_count;
  struct {
    std::uint64_t size;
    std::uint32_t flags;
  } heaps[16];
};
struct ExternalBufferInfo {
  Head head = {1000071002};
  std::uint32_t flags = 0;
  std::uint32_t usage;
  std::uint32_t handle_type = kOpaqueFd;
};
struct ExternalBufferProperties {
  Head head = {1000071003};
  std::uint32_t features;
  std::uint32_t export_from_imported;
  std::uint32_t compatible;
};
struct ExternalMemoryBufferCreateInfo {
  Head head = {1000072000};
  std::uint32_t handle_types = kOpaqueFd;
};
struct BufferCreateInfo {
  Head head = {12};
  std::uint32_t flags = 0;
  std::uint64_t size;
  std::uint32_t usage;
  std::uint32_t sharing = 0;
  std::uint32_t family_count = 0;
  const std::uint32_t* families = nullptr;
};
struct BufferMemoryRequirementsInfo2 {
  Head head = {1000146000};
  Buffer buffer;
};
struct MemoryDedicatedRequirements {
  Head head = {1000127000};
  std::uint32_t prefers;
  std::uint32_t requires_it;
};
struct MemoryRequirements2 {
  Head head = {1000146003};
  std::uint64_t size;
  std::uint64_t alignment;
  std::uint32_t types;
};
struct ExportMemoryAllocateInfo {
  Head head = {1000072002};
  std::uint32_t handle_types = kOpaqueFd;
};
struct MemoryDedicatedAllocateInfo {
  Head head = {1000127001};
  std::uint64_t image = 0;
  Buffer buffer;
};
struct MemoryAllocateInfo {
  Head head = {5};
  std::uint64_t size;
  std::uint32_t type_index;
};
struct MemoryGetFdInfo {
  Head head = {1000074002};
  DeviceMemory memory;
  std::uint32_t handle_type = kOpaqueFd;
};
struct ExportSemaphoreCreateInfo {
  Head head = {1000077000};
  std::uint32_t handle_types = kOpaqueFd;
};
struct SemaphoreCreateInfo {
  Head head = {9};
  std::uint32_t flags = 0;
};
struct SemaphoreGetFdInfo {
  Head head = {1000079001};
  Semaphore semaphore;
  std::uint32_t handle_type = kOpaqueFd;
};

using Result = std::int32_t;  // 0: success
using VoidFunction = void (*)();
using GetInstanceProcAddr = VoidFunction (*)(Instance, const char*);
using GetDeviceProcAddr = VoidFunction (*)(Device, const char*);

// Functions by their names without "vk".
struct InstanceFunctions {
  Result (*EnumeratePhysicalDevices)(Instance, std::uint32_t*, PhysicalDevice*);
  Result (*EnumerateDeviceExtensionProperties)(PhysicalDevice, const char*, std::uint32_t*,
                                               ExtensionProperties*);
  void (*GetPhysicalDeviceProperties2)(PhysicalDevice, PhysicalDeviceProperties2*);
  void (*GetPhysicalDeviceMemoryProperties)(PhysicalDevice, MemoryProperties*);
  void (*GetPhysicalDeviceExternalBufferProperties)(PhysicalDevice, const ExternalBufferInfo*,
                                                    ExternalBufferProperties*);
  Result (*CreateDevice)(PhysicalDevice, const DeviceCreateInfo*, const void*, Device*);
  GetDeviceProcAddr DeviceProcAddr;  // vkGetDeviceProcAddr
};
struct DeviceFunctions {
  Result (*CreateBuffer)(Device, const BufferCreateInfo*, const void*, Buffer*);
  void (*DestroyBuffer)(Device, Buffer, const void*);
  void (*GetBufferMemoryRequirements2)(Device, const BufferMemoryRequirementsInfo2*, MemoryRequirements2*);
  Result (*AllocateMemory)(Device, const MemoryAllocateInfo*, const void*, DeviceMemory*);
  void (*FreeMemory)(Device, DeviceMemory, const void*);
  Result (*BindBufferMemory)(Device, Buffer, DeviceMemory, std::uint64_t);
  Result (*MapMemory)(Device, DeviceMemory, std::uint64_t, std::uint64_t, std::uint32_t, void**);
  Result (*GetMemoryFd)(Device, const MemoryGetFdInfo*, int*);  // vkGetMemoryFdKHR
  Result (*CreateSemaphore)(Device, const SemaphoreCreateInfo*, const void*, Semaphore*);
  void (*DestroySemaphore)(Device, Semaphore, const void*);
  Result (*GetSemaphoreFd)(Device, const SemaphoreGetFdInfo*,
                           int*);  // vkGetSemaphoreFdKHR; null: not offered
};

}  // namespace quincunx::gl::vk
