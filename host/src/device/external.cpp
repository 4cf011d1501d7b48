// SPDX-License-Identifier: MIT
#include "quincunx/advanced/external.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "device/device_impl.h"
#include "quincunx/advanced/log.h"

// A function of OpenCL 3.0: null in a program whose loader is older.
extern "C" cl_mem CL_API_CALL clCreateBufferWithProperties(cl_context, const cl_ulong*, cl_mem_flags, size_t,
                                                           void*, cl_int*) __attribute__((weak));

namespace quincunx {
namespace {

// OpenCL 3.0 and its extensions, by the numbers and types of their specification: headers of OpenCL 1.2 lack them.
using Property = cl_ulong;
constexpr cl_device_info kMemoryImports = 0x204F;     // CL_DEVICE_EXTERNAL_MEMORY_IMPORT_HANDLE_TYPES_KHR
constexpr cl_device_info kSemaphoreImports = 0x204D;  // CL_DEVICE_SEMAPHORE_IMPORT_HANDLE_TYPES_KHR
constexpr cl_device_info kUuid = 0x106A;              // CL_DEVICE_UUID_KHR
constexpr Property kMemoryFd = 0x2060;                // CL_EXTERNAL_MEMORY_HANDLE_OPAQUE_FD_KHR
constexpr Property kMemoryDmaBuf = 0x2067;            // CL_EXTERNAL_MEMORY_HANDLE_DMA_BUF_KHR
constexpr Property kSemaphoreFd = 0x2055;             // CL_SEMAPHORE_HANDLE_OPAQUE_FD_KHR
constexpr Property kSemaphoreType = 0x203D;           // CL_SEMAPHORE_TYPE_KHR
constexpr Property kBinary = 1;                       // CL_SEMAPHORE_TYPE_BINARY_KHR

using SemaphoreHandle = void*;  // cl_semaphore_khr
using ChangeSides = cl_int(CL_API_CALL*)(cl_command_queue, cl_uint, const cl_mem*, cl_uint, const cl_event*,
                                         cl_event*);
using CreateSemaphore = SemaphoreHandle(CL_API_CALL*)(cl_context, const Property*, cl_int*);
using UseSemaphores = cl_int(CL_API_CALL*)(cl_command_queue, cl_uint, const SemaphoreHandle*, const cl_ulong*,
                                           cl_uint, const cl_event*, cl_event*);
using ReleaseSemaphore = cl_int(CL_API_CALL*)(SemaphoreHandle);

// Returns a function of an extension; throws where the driver lists the extension and has no such function.
template <typename Function>
Function extension(const cl::Device& device, const char* name) {
  const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());  // a handle, or one by newer headers
  void* const found = clGetExtensionFunctionAddressForPlatform(platform(), name);
  if (found == nullptr) throw std::runtime_error(fmt::format("the driver has no {}", name));
  return reinterpret_cast<Function>(found);
}

bool lists(cl_device_id device, cl_device_info query, Property wanted) {
  std::size_t bytes = 0;
  if (clGetDeviceInfo(device, query, 0, nullptr, &bytes) != CL_SUCCESS) return false;
  std::vector<cl_uint> types(bytes / sizeof(cl_uint));
  if (types.empty() || clGetDeviceInfo(device, query, bytes, types.data(), nullptr) != CL_SUCCESS)
    return false;
  return std::find(types.begin(), types.end(), wanted) != types.end();
}

// A file descriptor of our own: importing takes it over.
class OwnFd {
 public:
  explicit OwnFd(int callers) : fd_(::fcntl(callers, F_DUPFD_CLOEXEC, 0)) {}
  ~OwnFd() {
    if (fd_ >= 0) ::close(fd_);
  }
  OwnFd(const OwnFd&) = delete;
  OwnFd& operator=(const OwnFd&) = delete;

  Property property() const { return static_cast<Property>(fd_); }
  bool is_open() const { return fd_ >= 0; }
  void give_away() { fd_ = -1; }

 private:
  int fd_;
};

Status not_open(const char* call, int fd) {
  return Status::invalid(fmt::format("{}: fd is {}, which is no open file descriptor", call, fd));
}

Status check(const ExternalMemory& external, const DeviceInfo& device) {
  constexpr const char* kCall = "import_memory";
  if (external.bytes == 0)
    return Status::invalid(fmt::format("{}: bytes is 0; it must be the size of the memory", kCall));
  if (external.handle == MemoryHandle::kMapped) {
    constexpr std::uintptr_t kAlignment = 128;  // of the widest loads of kernels
    if (external.mapped == nullptr || reinterpret_cast<std::uintptr_t>(external.mapped) % kAlignment != 0) {
      return Status::invalid(fmt::format("{}: mapped is {}; it must be an address that {} divides", kCall,
                                         external.mapped, kAlignment));
    }
    if (device.host_unified_memory) return {};
    return Status::unsupported(fmt::format(
        "{}: the memory of '{}' is not the host's, so that it cannot use a mapped pointer in place", kCall,
        device.name));
  }
  const bool is_dma_buf = external.handle == MemoryHandle::kDmaBuf;
  if (!(is_dma_buf ? device.imports_dma_bufs : device.imports_opaque_fds)) {
    return Status::unsupported(fmt::format("{}: '{}' does not offer cl_khr_external_memory_{}", kCall,
                                           device.name, is_dma_buf ? "dma_buf" : "opaque_fd"));
  }
  if (external.device == DeviceUuid{} || external.device == device.uuid) return {};
  return Status::invalid(fmt::format(
      "{}: the memory lies on the device {}, and '{}' is the device {}; import it where it was allocated",
      kCall, uuid_text(external.device), device.name, uuid_text(device.uuid)));
}

cl::Buffer import_fd(const Device::Impl& device, const ExternalMemory& external, OwnFd& fd) {
  if (clCreateBufferWithProperties == nullptr)
    throw std::runtime_error("the OpenCL loader is older than 3.0: it has no clCreateBufferWithProperties");
  const Property type = external.handle == MemoryHandle::kDmaBuf ? kMemoryDmaBuf : kMemoryFd;
  const std::array<Property, 3> properties = {type, fd.property(), 0};
  cl_int code = CL_SUCCESS;
  const cl_mem memory = clCreateBufferWithProperties(device.context(), properties.data(), CL_MEM_READ_WRITE,
                                                     external.bytes, nullptr, &code);
  if (code != CL_SUCCESS) throw cl::Error(code, "clCreateBufferWithProperties");
  fd.give_away();
  return adopt<cl::Buffer>(memory);
}

}  // namespace

void learn_imports(const cl::Device& device, DeviceInfo& info) {
  if (has_extension(device, "cl_khr_device_uuid") &&
      clGetDeviceInfo(device(), kUuid, info.uuid.size(), info.uuid.data(), nullptr) != CL_SUCCESS)
    info.uuid = {};
  if (has_extension(device, "cl_khr_external_memory")) {
    info.imports_opaque_fds = lists(device(), kMemoryImports, kMemoryFd);
    info.imports_dma_bufs = lists(device(), kMemoryImports, kMemoryDmaBuf);
  }
  if (has_extension(device, "cl_khr_external_semaphore"))
    info.imports_semaphores = lists(device(), kSemaphoreImports, kSemaphoreFd);
}

std::atomic<int> longest_wait_ms = 0;

void wait_for(const cl::Event& event) {
  const int limit = longest_wait_ms;
  if (limit == 0) {
    event.wait();
    return;
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(limit);
  for (;;) {
    const auto state = event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
    if (state < CL_COMPLETE) throw cl::Error(state, "a command of the queue");
    if (state == CL_COMPLETE) return;
    if (std::chrono::steady_clock::now() > end) {
      throw StatusError(Status::device(fmt::format(
          "OpenCL did not finish within {} ms; a semaphore that it waits for may never have been signalled",
          limit)));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
}

std::string uuid_text(const DeviceUuid& uuid) {
  std::string text;
  for (const std::uint8_t byte : uuid)
    text += fmt::format("{:02x}", byte);
  return text;
}

struct SharedMemory::Impl {
  std::shared_ptr<Device::Impl> device;
  cl::Buffer buffer;
  std::size_t bytes = 0;
  void* mapped = nullptr;  // null: the driver knows the change of sides
  void* held = nullptr;    // by the host: a pointer that clEnqueueMapBuffer gave
  bool acquired = false;
  ChangeSides acquire = nullptr;
  ChangeSides release = nullptr;

  void change(ChangeSides how, const char* call, cl_event* done) const {
    const cl_mem memory = buffer();
    if (const cl_int code = how(device->queue(), 1, &memory, 0, nullptr, done); code != CL_SUCCESS)
      throw cl::Error(code, call);
  }
  void map(cl_map_flags flags, cl_bool blocking, cl_event* done) {
    cl_int code = CL_SUCCESS;
    held = clEnqueueMapBuffer(device->queue(), buffer(), blocking, flags, 0, bytes, 0, nullptr, done, &code);
    if (code != CL_SUCCESS) throw cl::Error(code, "clEnqueueMapBuffer");
    if (held != mapped) throw std::runtime_error("the device does not use the mapped memory in place");
  }
  void unmap(cl::Event* done = nullptr) {
    device->queue.enqueueUnmapMemObject(buffer, std::exchange(held, nullptr), nullptr, done);
  }

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (held == nullptr) return;
    try {  // PoCL keeps for ever what is mapped
      cl::Event done;
      unmap(&done);
      done.wait();
    } catch (...) {
      log_line(LogLevel::kWarning, caught("closing imported memory", device->info.name).message());
    }
  }
};

SharedMemory::SharedMemory(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SharedMemory::~SharedMemory() = default;
SharedMemory::SharedMemory(SharedMemory&&) noexcept = default;
SharedMemory& SharedMemory::operator=(SharedMemory&&) noexcept = default;

cl_mem SharedMemory::memory() const {
  return impl_->buffer();
}
std::size_t SharedMemory::bytes() const {
  return impl_->bytes;
}
bool SharedMemory::acquired() const {
  return impl_->acquired;
}

Status SharedMemory::acquire() {
  if (impl_->acquired) return {};
  try {
    if (impl_->mapped != nullptr) {
      impl_->unmap();
    } else {
      impl_->change(impl_->acquire, "clEnqueueAcquireExternalMemObjectsKHR", nullptr);
    }
    impl_->acquired = true;
    return {};
  } catch (...) {
    return caught("acquire", impl_->device->info.name);
  }
}

Status SharedMemory::release(cl_event* done) {
  if (done != nullptr) *done = nullptr;
  if (!impl_->acquired) return {};
  try {
    if (impl_->mapped != nullptr) {
      impl_->map(CL_MAP_READ | CL_MAP_WRITE, CL_FALSE, done);
    } else {
      impl_->change(impl_->release, "clEnqueueReleaseExternalMemObjectsKHR", done);
    }
    impl_->acquired = false;
    return {};
  } catch (...) {
    return caught("release", impl_->device->info.name);
  }
}

Result<SharedMemory> Device::import_memory(const ExternalMemory& external) const {
  if (Status status = check(external, impl_->info); !status.ok()) return status;
  try {
    auto made = std::make_unique<SharedMemory::Impl>();
    made->device = impl_;
    made->bytes = external.bytes;
    if (external.handle == MemoryHandle::kMapped) {
      made->mapped = external.mapped;
      made->buffer = cl::Buffer(impl_->context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, external.bytes,
                                external.mapped);
      made->map(CL_MAP_WRITE_INVALIDATE_REGION, CL_TRUE, nullptr);  // the host's first, as it is
    } else {
      OwnFd fd(external.fd);
      if (!fd.is_open()) return not_open("import_memory", external.fd);
      made->acquire = extension<ChangeSides>(impl_->device, "clEnqueueAcquireExternalMemObjectsKHR");
      made->release = extension<ChangeSides>(impl_->device, "clEnqueueReleaseExternalMemObjectsKHR");
      made->buffer = import_fd(*impl_, external, fd);
    }
    return SharedMemory(std::move(made));
  } catch (...) {
    return caught(fmt::format("import_memory of {} bytes", external.bytes), impl_->info.name);
  }
}

struct Semaphore::Impl {
  std::shared_ptr<Device::Impl> device;
  SemaphoreHandle handle = nullptr;
  UseSemaphores wait = nullptr;
  UseSemaphores signal = nullptr;
  ReleaseSemaphore release = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (handle != nullptr) release(handle);
  }

  void use(UseSemaphores how, const char* call) const {
    if (const cl_int code = how(device->queue(), 1, &handle, nullptr, 0, nullptr, nullptr);
        code != CL_SUCCESS)
      throw cl::Error(code, call);
  }
};

Semaphore::Semaphore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Semaphore::~Semaphore() = default;
Semaphore::Semaphore(Semaphore&&) noexcept = default;
Semaphore& Semaphore::operator=(Semaphore&&) noexcept = default;

Status Semaphore::wait() {
  constexpr int kLongestMs = 30'000;
  int forever = 0;
  longest_wait_ms.compare_exchange_strong(forever, kLongestMs);
  try {
    impl_->use(impl_->wait, "clEnqueueWaitSemaphoresKHR");
    return {};
  } catch (...) {
    return caught("wait", impl_->device->info.name);
  }
}

Status Semaphore::signal() {
  try {
    impl_->use(impl_->signal, "clEnqueueSignalSemaphoresKHR");
    impl_->device->queue.flush();
    return {};
  } catch (...) {
    return caught("signal", impl_->device->info.name);
  }
}

cl_command_queue Semaphore::queue() const {
  return impl_->device->queue();
}

Result<Semaphore> Device::import_semaphore(int callers) const {
  if (!impl_->info.imports_semaphores) {
    return Status::unsupported(fmt::format(
        "import_semaphore: '{}' does not offer cl_khr_external_semaphore_opaque_fd", impl_->info.name));
  }
  try {
    OwnFd fd(callers);
    if (!fd.is_open()) return not_open("import_semaphore", callers);
    auto made = std::make_unique<Semaphore::Impl>();
    made->device = impl_;
    made->wait = extension<UseSemaphores>(impl_->device, "clEnqueueWaitSemaphoresKHR");
    made->signal = extension<UseSemaphores>(impl_->device, "clEnqueueSignalSemaphoresKHR");
    made->release = extension<ReleaseSemaphore>(impl_->device, "clReleaseSemaphoreKHR");
    const auto create = extension<CreateSemaphore>(impl_->device, "clCreateSemaphoreWithPropertiesKHR");
    const std::array<Property, 5> properties = {kSemaphoreType, kBinary, kSemaphoreFd, fd.property(), 0};
    cl_int code = CL_SUCCESS;
    made->handle = create(impl_->context(), properties.data(), &code);
    if (code != CL_SUCCESS) throw cl::Error(code, "clCreateSemaphoreWithPropertiesKHR");
    fd.give_away();
    return Semaphore(std::move(made));
  } catch (...) {
    return caught("import_semaphore", impl_->info.name);
  }
}

}  // namespace quincunx
