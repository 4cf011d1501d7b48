// SPDX-License-Identifier: MIT
// Stands before Vulkan's loader, as a library of the same name that is loaded first. Processors export semaphores as
// opaque fds (VK_KHR_external_semaphore_fd), which lavapipe does not: they are eventfds. And with a device or an
// instance OpenGL's context goes, as with NVIDIA's.
#include <dlfcn.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "vulkan.h"
#define VK_NO_PROTOTYPES
#if __has_include(<vulkan/vulkan_core.h>)
#include <vulkan/vulkan_core.h>
#endif

using namespace quincunx::gl;

namespace {

constexpr const char* kExtension = "VK_KHR_external_semaphore_fd";

vk::GetInstanceProcAddr real() {
  static const auto found = reinterpret_cast<vk::GetInstanceProcAddr>(
      dlsym(dlopen(QUINCUNX_VULKAN_LOADER, RTLD_NOW | RTLD_LOCAL), "vkGetInstanceProcAddr"));
  return found;
}

vk::Instance g_instance = nullptr;  // of the last question

template <typename Function>
Function* of_instance(const char* name) {
  return reinterpret_cast<Function*>(real()(g_instance, name));
}

std::vector<vk::ExtensionProperties> offered(vk::PhysicalDevice device) {
  using Ask = vk::Result(vk::PhysicalDevice, const char*, std::uint32_t*, vk::ExtensionProperties*);
  auto* const ask = of_instance<Ask>("vkEnumerateDeviceExtensionProperties");
  std::uint32_t count = 0;
  ask(device, nullptr, &count, nullptr);
  std::vector<vk::ExtensionProperties> all(count);
  ask(device, nullptr, &count, all.data());
  return all;
}

// Whether the device gets semaphores of ours: a processor, whatever it has of its own.
bool is_processor(vk::PhysicalDevice device) {
  constexpr std::uint32_t kCpu = 4;  // VK_PHYSICAL_DEVICE_TYPE_CPU
  vk::PhysicalDeviceProperties2 properties = {};
  of_instance<void(vk::PhysicalDevice, vk::PhysicalDeviceProperties2*)>("vkGetPhysicalDeviceProperties2")(
      device, &properties);
  return properties.rest[3] == kCpu;
}

bool g_pretends = false;  // for the device that was made last

vk::Result extensions(vk::PhysicalDevice device, const char*, std::uint32_t* count,
                      vk::ExtensionProperties* to) {
  auto all = offered(device);
  if (is_processor(device)) {
    std::erase_if(all, [](const auto& one) { return std::strcmp(one.name, kExtension) == 0; });
    std::strcpy(all.emplace_back().name, kExtension);
  }
  *count = static_cast<std::uint32_t>(all.size());
  if (to != nullptr) std::copy(all.begin(), all.end(), to);
  return 0;
}

vk::Result create_device(vk::PhysicalDevice physical, const vk::DeviceCreateInfo* info, const void* allocator,
                         vk::Device* to) {
  std::vector<const char*> wanted(info->extensions, info->extensions + info->extension_count);
  g_pretends = is_processor(physical);
  std::erase_if(wanted, [](std::string_view name) { return g_pretends && name == kExtension; });
  vk::DeviceCreateInfo own = *info;
  own.extensions = wanted.data();
  own.extension_count = static_cast<std::uint32_t>(wanted.size());
  return of_instance<decltype(create_device)>("vkCreateDevice")(physical, &own, allocator, to);
}

vk::Result create_semaphore(vk::Device, const vk::SemaphoreCreateInfo*, const void*, vk::Semaphore* to) {
  *to = static_cast<vk::Semaphore>(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  return 0;
}

void destroy_semaphore(vk::Device, vk::Semaphore semaphore, const void*) {
  close(static_cast<int>(semaphore));
}

vk::Result get_semaphore_fd(vk::Device, const vk::SemaphoreGetFdInfo* info, int* to) {
  *to = dup(static_cast<int>(info->semaphore));
  return 0;
}

void end_context() {
  void* const egl = dlopen("libEGL.so.1", RTLD_NOW | RTLD_NOLOAD);
  const auto display = reinterpret_cast<void* (*)()>(dlsym(egl, "eglGetCurrentDisplay"));
  reinterpret_cast<unsigned (*)(void*, void*, void*, void*)>(dlsym(egl, "eglMakeCurrent"))(display(), nullptr,
                                                                                           nullptr, nullptr);
}
void destroy_device(vk::Device, const void*) {
  end_context();
}
void destroy_instance(vk::Instance, const void*) {
  end_context();
}

vk::Device g_device = nullptr;  // of the last question

#if __has_include(<vulkan/vulkan_core.h>)
// Eventfds, which stand behind the caller's own semaphores, are waited for before and signalled after the work.
VkResult queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
  constexpr int kLongestMs = 10'000;
  const auto is_ours = [](VkSemaphore semaphore) {
    return reinterpret_cast<std::uintptr_t>(semaphore) < 65536;
  };
  const auto fd_of = [](VkSemaphore semaphore) {
    return static_cast<int>(reinterpret_cast<std::uintptr_t>(semaphore));
  };
  VkSubmitInfo info = *infos;
  for (; info.waitSemaphoreCount > 0 && is_ours(info.pWaitSemaphores[info.waitSemaphoreCount - 1]);
       --info.waitSemaphoreCount) {
    pollfd ready = {
        .fd = fd_of(info.pWaitSemaphores[info.waitSemaphoreCount - 1]), .events = POLLIN, .revents = 0};
    std::uint64_t value = 0;
    if (poll(&ready, 1, kLongestMs) != 1 || read(ready.fd, &value, sizeof(value)) != sizeof(value))
      return VK_ERROR_DEVICE_LOST;
  }
  while (info.signalSemaphoreCount > 0 && is_ours(info.pSignalSemaphores[info.signalSemaphoreCount - 1]))
    --info.signalSemaphoreCount;
  VkTimelineSemaphoreSubmitInfo timeline;
  if (info.pNext != nullptr) {
    timeline = *static_cast<const VkTimelineSemaphoreSubmitInfo*>(info.pNext);
    timeline.waitSemaphoreValueCount = info.waitSemaphoreCount;
    timeline.signalSemaphoreValueCount = info.signalSemaphoreCount;
    info.pNext = &timeline;
  }
  const auto real_submit =
      reinterpret_cast<PFN_vkQueueSubmit>(of_instance<vk::VoidFunction(vk::Device, const char*)>(
          "vkGetDeviceProcAddr")(g_device, "vkQueueSubmit"));
  const auto wait_idle =
      reinterpret_cast<PFN_vkQueueWaitIdle>(of_instance<vk::VoidFunction(vk::Device, const char*)>(
          "vkGetDeviceProcAddr")(g_device, "vkQueueWaitIdle"));
  const VkResult result = real_submit(queue, count, &info, fence);
  if (info.signalSemaphoreCount < infos->signalSemaphoreCount) wait_idle(queue);
  const std::uint64_t one = 1;
  for (std::uint32_t i = info.signalSemaphoreCount; i < infos->signalSemaphoreCount; ++i) {
    if (write(fd_of(infos->pSignalSemaphores[i]), &one, sizeof(one)) != sizeof(one))
      return VK_ERROR_DEVICE_LOST;
  }
  return result;
}
#endif

vk::VoidFunction of_device(vk::Device device, const char* name) {
  g_device = device;
  const std::string_view wanted = name;
  if (wanted == "vkDestroyDevice") return reinterpret_cast<vk::VoidFunction>(&destroy_device);
  const vk::VoidFunction its_own = of_instance<decltype(of_device)>("vkGetDeviceProcAddr")(device, name);
  if (!g_pretends) return its_own;
  if (wanted == "vkCreateSemaphore") return reinterpret_cast<vk::VoidFunction>(&create_semaphore);
  if (wanted == "vkDestroySemaphore") return reinterpret_cast<vk::VoidFunction>(&destroy_semaphore);
  if (wanted == "vkGetSemaphoreFdKHR") return reinterpret_cast<vk::VoidFunction>(&get_semaphore_fd);
#if __has_include(<vulkan/vulkan_core.h>)
  if (wanted == "vkQueueSubmit") return reinterpret_cast<vk::VoidFunction>(&queue_submit);
#endif
  return its_own;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) vk::VoidFunction vkGetInstanceProcAddr(
    vk::Instance instance, const char* name) {
  g_instance = instance;
  const std::string_view wanted = name;
  if (wanted == "vkDestroyInstance") return reinterpret_cast<vk::VoidFunction>(&destroy_instance);
  if (wanted == "vkEnumerateDeviceExtensionProperties")
    return reinterpret_cast<vk::VoidFunction>(&extensions);
  if (wanted == "vkCreateDevice") return reinterpret_cast<vk::VoidFunction>(&create_device);
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<vk::VoidFunction>(&of_device);
  return real()(instance, name);
}
