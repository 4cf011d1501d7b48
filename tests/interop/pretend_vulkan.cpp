// SPDX-License-Identifier: MIT
// Stands before Vulkan's loader, as a library of the same name that is loaded first: while pretend_semaphores() says
// so, every device exports semaphores as opaque fds (VK_KHR_external_semaphore_fd), which lavapipe does not. They are
// eventfds.
#include <dlfcn.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "vulkan.h"

using namespace quincunx::gl;

namespace {

constexpr const char* kExtension = "VK_KHR_external_semaphore_fd";

bool g_pretends = false;

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

vk::Result extensions(vk::PhysicalDevice device, const char* layer, std::uint32_t* count,
                      vk::ExtensionProperties* to) {
  std::uint32_t known = *count;
  if (to != nullptr) --known;
  const vk::Result code =
      of_instance<decltype(extensions)>("vkEnumerateDeviceExtensionProperties")(device, layer, &known, to);
  if (to != nullptr) std::strcpy(to[known].name, kExtension);
  *count = known + 1;
  return code;
}

vk::Result create_device(vk::PhysicalDevice physical, const vk::DeviceCreateInfo* info, const void* allocator,
                         vk::Device* to) {
  std::vector<const char*> wanted(info->extensions, info->extensions + info->extension_count);
  std::erase_if(wanted, [](std::string_view name) { return name == kExtension; });
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

vk::VoidFunction of_device(vk::Device device, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkCreateSemaphore") return reinterpret_cast<vk::VoidFunction>(&create_semaphore);
  if (wanted == "vkDestroySemaphore") return reinterpret_cast<vk::VoidFunction>(&destroy_semaphore);
  if (wanted == "vkGetSemaphoreFdKHR") return reinterpret_cast<vk::VoidFunction>(&get_semaphore_fd);
  return of_instance<decltype(of_device)>("vkGetDeviceProcAddr")(device, name);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void pretend_semaphores(bool pretends) {
  g_pretends = pretends;
}

extern "C" __attribute__((visibility("default"))) vk::VoidFunction vkGetInstanceProcAddr(
    vk::Instance instance, const char* name) {
  if (!g_pretends) return real()(instance, name);
  g_instance = instance;
  const std::string_view wanted = name;
  if (wanted == "vkEnumerateDeviceExtensionProperties")
    return reinterpret_cast<vk::VoidFunction>(&extensions);
  if (wanted == "vkCreateDevice") return reinterpret_cast<vk::VoidFunction>(&create_device);
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<vk::VoidFunction>(&of_device);
  return real()(instance, name);
}
