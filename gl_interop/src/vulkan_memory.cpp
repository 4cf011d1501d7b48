// SPDX-License-Identifier: MIT
#include "vulkan_memory.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>
#include <vector>

#include "cl_handle.h"

namespace quincunx::gl {
namespace {

constexpr std::uint32_t kBufferUsage = vk::kTransferSourceAndTarget | vk::kStorageBuffer;
// llvmpipe imports no buffer that is as large as its memory, and says that it is out of memory.
constexpr std::size_t kSlack = 64 * 1024;

void check_vk(vk::Result code, const char* call) {
  if (code != 0) throw InteropError(fmt::format("{} failed: Vulkan error {}", call, code));
}

template <typename Function>
bool find(vk::VoidFunction found, Function* to) {
  *to = reinterpret_cast<Function>(found);
  return found != nullptr;
}

// The files in which drivers describe themselves to Vulkan's loader.
std::vector<std::filesystem::path> driver_files() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    const char* const named = std::getenv(variable);
    if (named == nullptr) continue;
    std::istringstream list(named);
    for (std::string file; std::getline(list, file, ':');)
      files.emplace_back(file);
    return files;
  }
  for (const char* folder :
       {"/etc/vulkan/icd.d", "/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"}) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Returns "library_path" of such a file, "" where it has none.
std::string library_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto key = text.find("\"library_path\"");
  const auto begin = key == std::string::npos ? key : text.find('"', text.find(':', key));
  const auto end = begin == std::string::npos ? begin : text.find('"', begin + 1);
  return end == std::string::npos ? "" : text.substr(begin + 1, end - begin - 1);
}

// NVIDIA's driver without a display server is whole in its EGL library, where the file names the one for X.
std::vector<std::string> driver_libraries() {
  std::vector<std::string> libraries;
  for (const auto& file : driver_files()) {
    if (std::string library = library_of(file); !library.empty()) libraries.push_back(std::move(library));
  }
  libraries.emplace_back("libEGL_nvidia.so.0");
  return libraries;
}

}  // namespace

Fd::~Fd() {
  if (fd_ >= 0) ::close(fd_);
}

const VulkanDevice& VulkanDevice::open(const DeviceUuid& uuid) {
  struct Known {
    std::unique_ptr<VulkanDevice> device;
    std::string why_not;
  };
  static std::mutex mutex;
  static auto* const known = new std::map<DeviceUuid, Known>;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = known->try_emplace(uuid);
  Known& its = entry->second;
  const auto try_through = [&](const std::string& library, const char* symbol) {
    if (its.device) return;
    // Left as it is where it fails, for the same reason.
    auto* const device = new VulkanDevice;
    const std::string why = device->open_through(library, symbol, uuid);
    if (why.empty()) its.device.reset(device);
    if (!why.empty()) its.why_not += fmt::format("{}{}: {}", its.why_not.empty() ? "" : "; ", library, why);
  };
  if (is_new) {
    try_through("libvulkan.so.1", "vkGetInstanceProcAddr");
    for (const std::string& library : driver_libraries())
      try_through(library, "vk_icdGetInstanceProcAddr");
  }
  if (its.device) return *its.device;
  throw InteropError(
      fmt::format("Vulkan, which allocates such memory, has no device that suits ({})", its.why_not));
}

// Returns "" or what is in the way.
std::string VulkanDevice::open_through(const std::string& library, const char* entry,
                                       const DeviceUuid& uuid) {
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);  // never closed: drivers leave threads
  if (handle == nullptr) return "it cannot be loaded";
  using Negotiate = vk::Result (*)(std::uint32_t*);
  if (const auto negotiate =
          reinterpret_cast<Negotiate>(dlsym(handle, "vk_icdNegotiateLoaderICDInterfaceVersion"))) {
    std::uint32_t version = 5;
    negotiate(&version);
  }
  const auto get = reinterpret_cast<vk::GetInstanceProcAddr>(dlsym(handle, entry));
  if (get == nullptr) return fmt::format("it has no {}", entry);
  vk::Result (*create)(const vk::InstanceCreateInfo*, const void*, vk::Instance*) = nullptr;
  if (!find(get(nullptr, "vkCreateInstance"), &create)) return "it has no vkCreateInstance";
  const vk::ApplicationInfo application;
  const vk::InstanceCreateInfo info = {.application = &application};
  if (const vk::Result code = create(&info, nullptr, &instance_); code != 0) {
    instance_ = nullptr;
    return fmt::format("vkCreateInstance failed: Vulkan error {}", code);
  }
  if (std::string why = find_functions(get); !why.empty()) return why;
  const vk::InstanceFunctions& f = instance_functions_;

  std::uint32_t count = 0;
  f.EnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<vk::PhysicalDevice> devices(count);
  if (f.EnumeratePhysicalDevices(instance_, &count, devices.data()) < 0) count = 0;
  for (std::uint32_t i = 0; i < count && physical_ == nullptr; ++i) {
    if (uuid_of(devices[i]) == uuid) physical_ = devices[i];
  }
  if (physical_ == nullptr) return fmt::format("none of its {} devices is OpenGL's", count);
  return make_device();
}

std::string VulkanDevice::find_functions(vk::GetInstanceProcAddr get) {
  vk::InstanceFunctions& f = instance_functions_;
  const bool whole =
      find(get(instance_, "vkEnumeratePhysicalDevices"), &f.EnumeratePhysicalDevices) &&
      find(get(instance_, "vkEnumerateDeviceExtensionProperties"), &f.EnumerateDeviceExtensionProperties) &&
      find(get(instance_, "vkGetPhysicalDeviceProperties2"), &f.GetPhysicalDeviceProperties2) &&
      find(get(instance_, "vkGetPhysicalDeviceMemoryProperties"), &f.GetPhysicalDeviceMemoryProperties) &&
      find(get(instance_, "vkGetPhysicalDeviceExternalBufferProperties"),
           &f.GetPhysicalDeviceExternalBufferProperties) &&
      find(get(instance_, "vkCreateDevice"), &f.CreateDevice) &&
      find(get(instance_, "vkGetDeviceProcAddr"), &f.DeviceProcAddr);
  return whole ? "" : "it is older than Vulkan 1.1";
}

DeviceUuid VulkanDevice::uuid_of(vk::PhysicalDevice device) const {
  vk::IdProperties id = {};
  vk::PhysicalDeviceProperties2 properties = {};
  properties.head.next = &id;
  instance_functions_.GetPhysicalDeviceProperties2(device, &properties);
  DeviceUuid uuid;
  std::copy_n(id.device_uuid, uuid.size(), uuid.begin());
  return uuid;
}

std::unique_ptr<const VulkanDevice> VulkanDevice::adopt(vk::GetInstanceProcAddr get, vk::Instance instance,
                                                        vk::PhysicalDevice physical, vk::Device device) {
  std::unique_ptr<VulkanDevice> adopted(new VulkanDevice);
  adopted->instance_ = instance;
  adopted->physical_ = physical;
  adopted->device_ = device;
  std::string why = adopted->find_functions(get);
  if (why.empty()) why = adopted->find_device_functions();
  if (!why.empty()) throw InteropError(fmt::format("Vulkan cannot be used: {}", why));
  return adopted;
}

std::string VulkanDevice::make_device() {
  std::uint32_t count = 0;
  instance_functions_.EnumerateDeviceExtensionProperties(physical_, nullptr, &count, nullptr);
  std::vector<vk::ExtensionProperties> offered(count);
  instance_functions_.EnumerateDeviceExtensionProperties(physical_, nullptr, &count, offered.data());
  const auto offers = [&](const char* name) {
    return std::any_of(offered.begin(), offered.end(),
                       [&](const auto& one) { return std::strcmp(one.name, name) == 0; });
  };
  constexpr const char* kMemory = "VK_KHR_external_memory_fd";
  constexpr const char* kSemaphore = "VK_KHR_external_semaphore_fd";
  if (!offers(kMemory)) return fmt::format("its device does not offer {}", kMemory);
  std::vector<const char*> wanted = {kMemory};
  if (offers(kSemaphore)) wanted.push_back(kSemaphore);
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue = {.priorities = &priority};
  const vk::DeviceCreateInfo info = {.queues = &queue,
                                     .extension_count = static_cast<std::uint32_t>(wanted.size()),
                                     .extensions = wanted.data()};
  if (const vk::Result code = instance_functions_.CreateDevice(physical_, &info, nullptr, &device_);
      code != 0) {
    device_ = nullptr;
    return fmt::format("vkCreateDevice failed: Vulkan error {}", code);
  }
  return find_device_functions();
}

std::string VulkanDevice::find_device_functions() {
  const auto get = [&](const char* name) { return function(name); };
  vk::DeviceFunctions& f = functions_;
  const bool whole =
      find(get("vkCreateBuffer"), &f.CreateBuffer) && find(get("vkDestroyBuffer"), &f.DestroyBuffer) &&
      find(get("vkGetBufferMemoryRequirements2"), &f.GetBufferMemoryRequirements2) &&
      find(get("vkAllocateMemory"), &f.AllocateMemory) && find(get("vkFreeMemory"), &f.FreeMemory) &&
      find(get("vkBindBufferMemory"), &f.BindBufferMemory) && find(get("vkMapMemory"), &f.MapMemory) &&
      find(get("vkCreateSemaphore"), &f.CreateSemaphore) &&
      find(get("vkDestroySemaphore"), &f.DestroySemaphore);
  if (!whole) return "its device lacks functions of Vulkan 1.1";
  if (!find(get("vkGetMemoryFdKHR"), &f.GetMemoryFd))
    return "its device was made without VK_KHR_external_memory_fd";
  find(get("vkGetSemaphoreFdKHR"), &f.GetSemaphoreFd);
  return {};
}

std::uint32_t VulkanDevice::memory_type(std::uint32_t allowed, Place place) const {
  vk::MemoryProperties memory = {};
  instance_functions_.GetPhysicalDeviceMemoryProperties(physical_, &memory);
  const std::uint32_t needed =
      place == Place::kDevice ? vk::kDeviceLocal : vk::kHostVisible | vk::kHostCoherent | vk::kHostCached;
  for (std::uint32_t i = 0; i < memory.type_count; ++i) {
    if ((allowed >> i & 1) != 0 && (memory.types[i].flags & needed) == needed) return i;
  }
  throw InteropError(place == Place::kDevice ? "Vulkan has no memory of the device that could be exported"
                                             : "Vulkan has no memory of the host that could be exported");
}

std::unique_ptr<VulkanDevice::Memory> VulkanDevice::allocate(std::size_t bytes, Place place) const {
  const vk::ExternalBufferInfo external = {.usage = kBufferUsage};
  vk::ExternalBufferProperties can = {};
  instance_functions_.GetPhysicalDeviceExternalBufferProperties(physical_, &external, &can);
  if ((can.features & vk::kExportable) == 0) throw InteropError("Vulkan exports no buffers as opaque fds");

  std::unique_ptr<Memory> made(new Memory(*this));
  const vk::ExternalMemoryBufferCreateInfo handles;
  const vk::BufferCreateInfo info = {.head = {12, &handles},
                                     .size = bytes + (place == Place::kMapped ? kPageBytes : 0),
                                     .usage = kBufferUsage};
  check_vk(functions_.CreateBuffer(device_, &info, nullptr, &made->buffer_), "vkCreateBuffer");
  const vk::BufferMemoryRequirementsInfo2 of = {.buffer = made->buffer_};
  vk::MemoryDedicatedRequirements dedicated = {};
  vk::MemoryRequirements2 needs = {};
  needs.head.next = &dedicated;
  functions_.GetBufferMemoryRequirements2(device_, &of, &needs);
  made->dedicated_ = dedicated.requires_it != 0 || (can.features & vk::kDedicatedOnly) != 0;
  // Dedicated memory is exactly as large as its buffer.
  made->size_ = static_cast<std::size_t>(needs.size) + (made->dedicated_ ? 0 : kSlack);

  const vk::MemoryDedicatedAllocateInfo only = {.buffer = made->buffer_};
  vk::ExportMemoryAllocateInfo exported;
  if (made->dedicated_) exported.head.next = &only;
  const vk::MemoryAllocateInfo wanted = {
      .head = {5, &exported}, .size = made->size_, .type_index = memory_type(needs.types, place)};
  check_vk(functions_.AllocateMemory(device_, &wanted, nullptr, &made->memory_), "vkAllocateMemory");
  check_vk(functions_.BindBufferMemory(device_, made->buffer_, made->memory_, 0), "vkBindBufferMemory");
  if (place == Place::kMapped) {
    void* at = nullptr;
    check_vk(functions_.MapMemory(device_, made->memory_, 0, vk::kWholeSize, 0, &at), "vkMapMemory");
    made->start_ = bytes_to_page(at);
    made->mapped_ = static_cast<std::uint8_t*>(at) + made->start_;
  }
  return made;
}

VulkanDevice::Memory::~Memory() {
  if (buffer_ != 0) device_.functions_.DestroyBuffer(device_.device_, buffer_, nullptr);
  if (memory_ != 0) device_.functions_.FreeMemory(device_.device_, memory_, nullptr);  // and unmaps it
}

Fd VulkanDevice::Memory::fd() const {
  const vk::MemoryGetFdInfo info = {.memory = memory_};
  int fd = -1;
  check_vk(device_.functions_.GetMemoryFd(device_.device_, &info, &fd), "vkGetMemoryFdKHR");
  return Fd(fd);
}

SharedMemory VulkanDevice::Memory::import_to(const Device& device, std::size_t bytes) const {
  ExternalMemory external = {.bytes = bytes, .device = device_.uuid()};
  Fd exported;
  if (mapped_ != nullptr) {
    external.handle = MemoryHandle::kMapped;
    external.mapped = mapped_;
  } else {
    exported = fd();
    external.fd = exported.get();
  }
  auto imported = device.import_memory(external);
  check_status(imported.status());
  return std::move(imported).value();
}

VulkanDevice::SharedSemaphore VulkanDevice::semaphore() const {
  const vk::ExportSemaphoreCreateInfo exported;
  const vk::SemaphoreCreateInfo info = {.head = {9, &exported}};
  vk::Semaphore made = 0;
  check_vk(functions_.CreateSemaphore(device_, &info, nullptr, &made), "vkCreateSemaphore");
  SharedSemaphore shared;
  shared.semaphore = made;
  shared.kept = {nullptr, [this, made](void*) { functions_.DestroySemaphore(device_, made, nullptr); }};
  for (Fd* to : {&shared.first, &shared.second}) {
    const vk::SemaphoreGetFdInfo of = {.semaphore = made};
    int fd = -1;
    check_vk(functions_.GetSemaphoreFd(device_, &of, &fd), "vkGetSemaphoreFdKHR");
    *to = Fd(fd);
  }
  return shared;
}

}  // namespace quincunx::gl
