// SPDX-License-Identifier: MIT
// The declarations of gl_interop/src/vulkan.h against Vulkan's own headers, and memory that Vulkan allocates.
#include "vulkan.h"

#include <gtest/gtest.h>

#if __has_include(<vulkan/vulkan_core.h>)
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

namespace quincunx::gl::testing {
namespace {

#define SAME_PLACE(ours, field, theirs, their_field)                          \
  static_assert(offsetof(vk::ours, field) == offsetof(theirs, their_field) && \
                sizeof(vk::ours::field) == sizeof(theirs::their_field))

static_assert(sizeof(vk::ApplicationInfo) == sizeof(VkApplicationInfo));
SAME_PLACE(ApplicationInfo, api_version, VkApplicationInfo, apiVersion);
static_assert(sizeof(vk::InstanceCreateInfo) == sizeof(VkInstanceCreateInfo));
SAME_PLACE(InstanceCreateInfo, application, VkInstanceCreateInfo, pApplicationInfo);
static_assert(sizeof(vk::DeviceQueueCreateInfo) == sizeof(VkDeviceQueueCreateInfo));
SAME_PLACE(DeviceQueueCreateInfo, count, VkDeviceQueueCreateInfo, queueCount);
SAME_PLACE(DeviceQueueCreateInfo, priorities, VkDeviceQueueCreateInfo, pQueuePriorities);
static_assert(sizeof(vk::DeviceCreateInfo) == sizeof(VkDeviceCreateInfo));
SAME_PLACE(DeviceCreateInfo, queues, VkDeviceCreateInfo, pQueueCreateInfos);
SAME_PLACE(DeviceCreateInfo, extension_count, VkDeviceCreateInfo, enabledExtensionCount);
SAME_PLACE(DeviceCreateInfo, extensions, VkDeviceCreateInfo, ppEnabledExtensionNames);
static_assert(sizeof(vk::ExtensionProperties) == sizeof(VkExtensionProperties));
static_assert(sizeof(vk::IdProperties) == sizeof(VkPhysicalDeviceIDProperties));
SAME_PLACE(IdProperties, device_uuid, VkPhysicalDeviceIDProperties, deviceUUID);
static_assert(sizeof(vk::PhysicalDeviceProperties2) >= sizeof(VkPhysicalDeviceProperties2));
static_assert(sizeof(vk::MemoryProperties) == sizeof(VkPhysicalDeviceMemoryProperties));
SAME_PLACE(MemoryProperties, types, VkPhysicalDeviceMemoryProperties, memoryTypes);
static_assert(sizeof(vk::ExternalBufferInfo) == sizeof(VkPhysicalDeviceExternalBufferInfo));
SAME_PLACE(ExternalBufferInfo, usage, VkPhysicalDeviceExternalBufferInfo, usage);
SAME_PLACE(ExternalBufferInfo, handle_type, VkPhysicalDeviceExternalBufferInfo, handleType);
static_assert(sizeof(vk::ExternalBufferProperties) == sizeof(VkExternalBufferProperties));
SAME_PLACE(ExternalBufferProperties, features, VkExternalBufferProperties,
           externalMemoryProperties.externalMemoryFeatures);
static_assert(sizeof(vk::ExternalMemoryBufferCreateInfo) == sizeof(VkExternalMemoryBufferCreateInfo));
static_assert(sizeof(vk::BufferCreateInfo) == sizeof(VkBufferCreateInfo));
SAME_PLACE(BufferCreateInfo, size, VkBufferCreateInfo, size);
SAME_PLACE(BufferCreateInfo, usage, VkBufferCreateInfo, usage);
static_assert(sizeof(vk::BufferMemoryRequirementsInfo2) == sizeof(VkBufferMemoryRequirementsInfo2));
static_assert(sizeof(vk::MemoryDedicatedRequirements) == sizeof(VkMemoryDedicatedRequirements));
SAME_PLACE(MemoryDedicatedRequirements, requires_it, VkMemoryDedicatedRequirements,
           requiresDedicatedAllocation);
static_assert(sizeof(vk::MemoryRequirements2) == sizeof(VkMemoryRequirements2));
SAME_PLACE(MemoryRequirements2, types, VkMemoryRequirements2, memoryRequirements.memoryTypeBits);
static_assert(sizeof(vk::ExportMemoryAllocateInfo) == sizeof(VkExportMemoryAllocateInfo));
static_assert(sizeof(vk::MemoryDedicatedAllocateInfo) == sizeof(VkMemoryDedicatedAllocateInfo));
SAME_PLACE(MemoryDedicatedAllocateInfo, buffer, VkMemoryDedicatedAllocateInfo, buffer);
static_assert(sizeof(vk::MemoryAllocateInfo) == sizeof(VkMemoryAllocateInfo));
SAME_PLACE(MemoryAllocateInfo, type_index, VkMemoryAllocateInfo, memoryTypeIndex);
static_assert(sizeof(vk::MemoryGetFdInfo) == sizeof(VkMemoryGetFdInfoKHR));
SAME_PLACE(MemoryGetFdInfo, handle_type, VkMemoryGetFdInfoKHR, handleType);
static_assert(sizeof(vk::ExportSemaphoreCreateInfo) == sizeof(VkExportSemaphoreCreateInfo));
static_assert(sizeof(vk::SemaphoreCreateInfo) == sizeof(VkSemaphoreCreateInfo));
static_assert(sizeof(vk::SemaphoreGetFdInfo) == sizeof(VkSemaphoreGetFdInfoKHR));
SAME_PLACE(SemaphoreGetFdInfo, handle_type, VkSemaphoreGetFdInfoKHR, handleType);
#undef SAME_PLACE

TEST(VulkanDeclarations, AreThoseOfTheHeaders) {
  EXPECT_EQ(vk::ApplicationInfo{}.head.type, VK_STRUCTURE_TYPE_APPLICATION_INFO);
  EXPECT_EQ(vk::ApplicationInfo{}.api_version, VK_API_VERSION_1_1);
  EXPECT_EQ(vk::InstanceCreateInfo{}.head.type, VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  EXPECT_EQ(vk::DeviceQueueCreateInfo{}.head.type, VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  EXPECT_EQ(vk::DeviceCreateInfo{}.head.type, VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  EXPECT_EQ(vk::IdProperties{}.head.type, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
  EXPECT_EQ(vk::PhysicalDeviceProperties2{}.head.type, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  EXPECT_EQ(vk::ExternalBufferInfo{}.head.type, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO);
  EXPECT_EQ(vk::ExternalBufferProperties{}.head.type, VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES);
  EXPECT_EQ(vk::ExternalMemoryBufferCreateInfo{}.head.type,
            VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
  EXPECT_EQ(vk::BufferCreateInfo{}.head.type, VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  EXPECT_EQ(vk::BufferMemoryRequirementsInfo2{}.head.type,
            VK_STRUCTURE_TYPE_BUFFER_MEMORY_REQUIREMENTS_INFO_2);
  EXPECT_EQ(vk::MemoryDedicatedRequirements{}.head.type, VK_STRUCTURE_TYPE_MEMORY_DEDICATED_REQUIREMENTS);
  EXPECT_EQ(vk::MemoryRequirements2{}.head.type, VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2);
  EXPECT_EQ(vk::ExportMemoryAllocateInfo{}.head.type, VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
  EXPECT_EQ(vk::MemoryDedicatedAllocateInfo{}.head.type, VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
  EXPECT_EQ(vk::MemoryAllocateInfo{}.head.type, VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  EXPECT_EQ(vk::MemoryGetFdInfo{}.head.type, VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
  EXPECT_EQ(vk::ExportSemaphoreCreateInfo{}.head.type, VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
  EXPECT_EQ(vk::SemaphoreCreateInfo{}.head.type, VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  EXPECT_EQ(vk::SemaphoreGetFdInfo{}.head.type, VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR);
  EXPECT_EQ(vk::kOpaqueFd, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
  EXPECT_EQ(vk::kOpaqueFd, VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT);
  EXPECT_EQ(vk::kTransferSourceAndTarget,
            VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  EXPECT_EQ(vk::kStorageBuffer, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  EXPECT_EQ(vk::kDeviceLocal, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  EXPECT_EQ(vk::kHostVisible, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
  EXPECT_EQ(vk::kHostCoherent, VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  EXPECT_EQ(vk::kHostCached, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  EXPECT_EQ(vk::kDedicatedOnly, VK_EXTERNAL_MEMORY_FEATURE_DEDICATED_ONLY_BIT);
  EXPECT_EQ(vk::kExportable, VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT);
  EXPECT_EQ(vk::kWholeSize, VK_WHOLE_SIZE);
}

}  // namespace
}  // namespace quincunx::gl::testing
#endif
