// SPDX-License-Identifier: MIT
#include "cl_imports.h"

#include <dlfcn.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "cl_faults.h"
#include "external_memory.h"
#include "gl_semaphores.h"
#include "real_function.h"

namespace quincunx::gl::testing {
namespace {

constexpr cl_ulong kMemoryFd = 0x2060, kDmaBuf = 0x2067, kSemaphoreFd = 0x2055;

struct Imported {
  cl_ulong handle = 0;
  vk::DeviceMemory memory = 0;
  std::uint8_t* mapped = nullptr;
  bool acquired = false;
};

struct State {
  std::optional<PretendImports::Flaw> flaw;  // empty: no such driver
  DeviceUuid uuid = {};
  std::mutex mutex;
  std::map<cl_mem, Imported> imported;
};

// Never destroyed: OpenCL may be called while the process ends.
State& state() {
  static State* const instance = new State;
  return *instance;
}

// The importer: the first device of Vulkan's.
class Vulkan {
 public:
  static Vulkan& get() {
    static Vulkan* const instance = new Vulkan;
    return *instance;
  }

  bool import(int fd, std::size_t bytes, Imported* to) const {
    const struct {
      vk::Head head = {1000074000};  // VkImportMemoryFdInfoKHR
      std::uint32_t handle_type = vk::kOpaqueFd;
      int fd;
    } from = {.fd = fd};
    const vk::MemoryAllocateInfo info = {.head = {5, &from}, .size = bytes, .type_index = 0};
    if (functions_.AllocateMemory(device_, &info, nullptr, &to->memory) != 0) return false;
    void* mapped = nullptr;
    functions_.MapMemory(device_, to->memory, 0, vk::kWholeSize, 0, &mapped);
    to->mapped = static_cast<std::uint8_t*>(mapped);
    return true;
  }
  void free(vk::DeviceMemory memory) const { functions_.FreeMemory(device_, memory, nullptr); }

 private:
  template <typename Function>
  static void set(vk::VoidFunction found, Function* to) {
    *to = reinterpret_cast<Function>(found);
  }

  Vulkan() {
    const auto get = reinterpret_cast<vk::GetInstanceProcAddr>(
        dlsym(dlopen("libvulkan.so.1", RTLD_NOW), "vkGetInstanceProcAddr"));
    vk::Result (*create)(const vk::InstanceCreateInfo*, const void*, vk::Instance*) = nullptr;
    set(get(nullptr, "vkCreateInstance"), &create);
    const vk::ApplicationInfo application;
    const vk::InstanceCreateInfo info = {.application = &application};
    vk::Instance instance = nullptr;
    create(&info, nullptr, &instance);
    vk::InstanceFunctions of_instance = {};
    set(get(instance, "vkEnumeratePhysicalDevices"), &of_instance.EnumeratePhysicalDevices);
    set(get(instance, "vkCreateDevice"), &of_instance.CreateDevice);
    set(get(instance, "vkGetDeviceProcAddr"), &of_instance.DeviceProcAddr);
    std::uint32_t count = 1;
    vk::PhysicalDevice physical = nullptr;
    of_instance.EnumeratePhysicalDevices(instance, &count, &physical);
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue = {.priorities = &priority};
    const char* const extension = "VK_KHR_external_memory_fd";
    const vk::DeviceCreateInfo device = {.queues = &queue, .extension_count = 1, .extensions = &extension};
    of_instance.CreateDevice(physical, &device, nullptr, &device_);
    set(of_instance.DeviceProcAddr(device_, "vkAllocateMemory"), &functions_.AllocateMemory);
    set(of_instance.DeviceProcAddr(device_, "vkMapMemory"), &functions_.MapMemory);
    set(of_instance.DeviceProcAddr(device_, "vkFreeMemory"), &functions_.FreeMemory);
  }

  vk::Device device_ = nullptr;
  vk::DeviceFunctions functions_ = {};
};

void CL_CALLBACK forget(cl_mem memory, void*) {
  const std::lock_guard lock(state().mutex);
  const auto found = state().imported.find(memory);
  if (found == state().imported.end()) return;
  Vulkan::get().free(found->second.memory);
  state().imported.erase(found);
}

cl_int mark(cl_command_queue queue, cl_event* event) {
  return event == nullptr ? CL_SUCCESS : clEnqueueMarkerWithWaitList(queue, 0, nullptr, event);
}

cl_int CL_API_CALL change_sides(cl_command_queue queue, cl_uint count, const cl_mem* memory, bool acquire,
                                cl_event* event) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  const std::lock_guard lock(state().mutex);
  for (cl_uint i = 0; i < count; ++i) {
    const auto found = state().imported.find(memory[i]);
    if (found == state().imported.end()) return CL_INVALID_MEM_OBJECT;
    if (found->second.acquired == acquire) return CL_INVALID_OPERATION;
    found->second.acquired = acquire;
    if (acquire && state().flaw == PretendImports::Flaw::kWrongBytes) found->second.mapped[7] ^= 1;
  }
  return mark(queue, event);
}

cl_int CL_API_CALL acquire_memory(cl_command_queue queue, cl_uint count, const cl_mem* memory, cl_uint,
                                  const cl_event*, cl_event* event) {
  return change_sides(queue, count, memory, true, event);
}

cl_int CL_API_CALL release_memory(cl_command_queue queue, cl_uint count, const cl_mem* memory, cl_uint,
                                  const cl_event*, cl_event* event) {
  return change_sides(queue, count, memory, false, event);
}

struct EventSemaphore {
  cl_context context;
  int fd;
};

void* CL_API_CALL create_semaphore(cl_context context, const cl_ulong* properties, cl_int* code) {
  int fd = -1;
  for (; *properties != 0; properties += 2) {
    if (*properties == kSemaphoreFd) fd = static_cast<int>(properties[1]);
  }
  *code = fd < 0 ? CL_INVALID_VALUE : injected_fault();
  return *code == CL_SUCCESS ? new EventSemaphore{context, fd} : nullptr;
}

cl_int CL_API_CALL release_semaphore(void* semaphore) {
  auto* const own = static_cast<EventSemaphore*>(semaphore);
  close(own->fd);
  delete own;
  return CL_SUCCESS;
}

cl_int CL_API_CALL wait_semaphores(cl_command_queue queue, cl_uint, void* const* semaphores, const cl_ulong*,
                                   cl_uint, const cl_event*, cl_event* event) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  const auto* const semaphore = static_cast<const EventSemaphore*>(semaphores[0]);
  cl_int code = CL_SUCCESS;
  const cl_event gate = clCreateUserEvent(semaphore->context, &code);
  if (code != CL_SUCCESS) return code;
  code = clEnqueueBarrierWithWaitList(queue, 1, &gate, event);
  std::thread([gate, fd = dup(semaphore->fd)] {
    std::uint64_t value = 0;
    while (read(fd, &value, sizeof(value)) != sizeof(value)) {
      pollfd ready = {.fd = fd, .events = POLLIN, .revents = 0};
      poll(&ready, 1, -1);
    }
    close(fd);
    clSetUserEventStatus(gate, CL_COMPLETE);
    clReleaseEvent(gate);
  }).detach();
  return code;
}

void CL_CALLBACK raise(cl_event, cl_int, void* fd) {
  const auto own = static_cast<int>(reinterpret_cast<std::intptr_t>(fd));
  signal_event(own);
  close(own);
}

cl_int CL_API_CALL signal_semaphores(cl_command_queue queue, cl_uint, void* const* semaphores,
                                     const cl_ulong*, cl_uint, const cl_event*, cl_event*) {
  if (const cl_int fault = injected_fault(); fault != CL_SUCCESS) return fault;
  const auto* const semaphore = static_cast<const EventSemaphore*>(semaphores[0]);
  cl_event done = nullptr;
  if (const cl_int code = clEnqueueMarkerWithWaitList(queue, 0, nullptr, &done); code != CL_SUCCESS)
    return code;
  clSetEventCallback(done, CL_COMPLETE, raise, reinterpret_cast<void*>(std::intptr_t{dup(semaphore->fd)}));
  return clReleaseEvent(done);
}

void* function_of(const char* name) {
  const std::map<std::string, void*> functions = {
      {"clEnqueueAcquireExternalMemObjectsKHR", reinterpret_cast<void*>(&acquire_memory)},
      {"clEnqueueReleaseExternalMemObjectsKHR", reinterpret_cast<void*>(&release_memory)},
      {"clCreateSemaphoreWithPropertiesKHR", reinterpret_cast<void*>(&create_semaphore)},
      {"clReleaseSemaphoreKHR", reinterpret_cast<void*>(&release_semaphore)},
      {"clEnqueueWaitSemaphoresKHR", reinterpret_cast<void*>(&wait_semaphores)},
      {"clEnqueueSignalSemaphoresKHR", reinterpret_cast<void*>(&signal_semaphores)}};
  const auto found = functions.find(name);
  return found == functions.end() ? nullptr : found->second;
}

}  // namespace

PretendImports::PretendImports(Flaw flaw) {
  state().flaw = flaw;
  state().uuid = gl_device_uuid();
  if (flaw == Flaw::kWrongUuid) state().uuid[0] ^= 1;
}

PretendImports::~PretendImports() {
  state().flaw.reset();
}

int PretendImports::acquired() const {
  const std::lock_guard lock(state().mutex);
  int count = 0;
  for (const auto& [memory, imported] : state().imported)
    count += imported.acquired ? 1 : 0;
  return count;
}

int PretendImports::dma_bufs() const {
  const std::lock_guard lock(state().mutex);
  int count = 0;
  for (const auto& [memory, imported] : state().imported)
    count += imported.handle == kDmaBuf ? 1 : 0;
  return count;
}

const char* extensions_of_imports() {
  return state().flaw ? " cl_khr_device_uuid cl_khr_external_memory cl_khr_external_semaphore" : "";
}

bool tells_of_imports(cl_device_info name, std::size_t room, void* value, std::size_t* bytes_ret,
                      cl_int* code) {
  if (!state().flaw) return false;
  const cl_uint memory[] = {kMemoryFd, kDmaBuf}, semaphore = kSemaphoreFd;
  const void* from = nullptr;
  std::size_t bytes = sizeof(cl_uint);
  if (name == 0x204F) {
    from = memory;
    bytes = sizeof(memory);
  }
  if (name == 0x204D) from = &semaphore;
  if (name == 0x106A) {
    from = state().uuid.data();
    bytes = state().uuid.size();
  }
  if (from == nullptr) return false;
  if (bytes_ret != nullptr) *bytes_ret = bytes;
  *code = value != nullptr && room < bytes ? CL_INVALID_VALUE : CL_SUCCESS;
  if (value != nullptr && *code == CL_SUCCESS) std::memcpy(value, from, bytes);
  return true;
}

}  // namespace quincunx::gl::testing

using namespace quincunx::gl::testing;

extern "C" {

void* CL_API_CALL clGetExtensionFunctionAddressForPlatform(cl_platform_id platform, const char* name) {
  if (state().flaw == PretendImports::Flaw::kNoFunctions) return nullptr;
  void* const own = state().flaw ? function_of(name) : nullptr;
  return own != nullptr ? own : REAL(clGetExtensionFunctionAddressForPlatform)(platform, name);
}

// A function of OpenCL 3.0: its types are those of cl_ulong here.
cl_mem CL_API_CALL clCreateBufferWithProperties(cl_context context, const cl_ulong* properties,
                                                cl_mem_flags flags, std::size_t bytes, void* host,
                                                cl_int* code) {
  if (!state().flaw) return REAL(clCreateBufferWithProperties)(context, properties, flags, bytes, host, code);
  *code = injected_fault();
  if (*code == CL_SUCCESS && state().flaw == PretendImports::Flaw::kRefuses) *code = CL_INVALID_VALUE;
  if (*code != CL_SUCCESS) return nullptr;
  Imported imported;
  imported.handle = properties[0];  // lavapipe exports no dma-bufs: what is given as one is an opaque fd
  if ((properties[0] != kMemoryFd && properties[0] != kDmaBuf) ||
      !Vulkan::get().import(static_cast<int>(properties[1]), bytes, &imported)) {
    *code = CL_INVALID_VALUE;
    return nullptr;
  }
  const cl_mem memory =
      REAL(clCreateBuffer)(context, flags | CL_MEM_USE_HOST_PTR, bytes, imported.mapped, code);
  if (memory == nullptr) return nullptr;
  const std::lock_guard lock(state().mutex);
  state().imported[memory] = imported;
  clSetMemObjectDestructorCallback(memory, forget, nullptr);
  return memory;
}

}  // extern "C"
