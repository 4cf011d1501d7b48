// SPDX-License-Identifier: MIT
// Device: one OpenCL device with its context and an in-order, profiling queue.
//
// A Device is a shared handle: copies refer to the same context and queue, which live until the last copy,
// image and service is gone. Opening and querying are thread-safe; the queue is used by one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/external.h"
#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx {

struct DeviceProfile;

enum class DeviceKind { kCpu, kGpu, kAccelerator, kOther };

struct DeviceInfo {
  int index = 0;  // position in Device::list()
  DeviceKind kind = DeviceKind::kOther;
  std::string platform;  // "Portable Computing Language"
  std::string name;
  std::string vendor;
  std::string driver;
  std::string version;  // "OpenCL 3.0 ..."
  int compute_units = 0;
  std::uint64_t global_memory_bytes = 0;
  bool images = false;               // image2d_t at all
  bool two_channel_images = false;   // RG half images, readable and writable
  bool host_unified_memory = false;  // buffers over host memory cost no copy
  // The row pitch of buffers that images can be made on (cl_khr_image2d_from_buffer) is a multiple of so many texels;
  // 0: not supported.
  int image_pitch_texels = 0;
  bool gl_sharing = false;  // cl_khr_gl_sharing is advertised (the bridge still probes it)
  DeviceUuid uuid = {};     // zeros: not known (cl_khr_device_uuid)
  // Handles of other APIs that can be imported (cl_khr_external_memory, cl_khr_external_semaphore_opaque_fd).
  bool imports_opaque_fds = false;
  bool imports_dma_bufs = false;
  bool imports_semaphores = false;
};

struct FrontKey;
// Returns the key of the error fronts measured on this device for a scene; empty: for any scene.
QUINCUNX_API FrontKey front_key(const DeviceInfo& device, const std::string& scene = {});

class QUINCUNX_API Device {
 public:
  // Lists all devices of all platforms, GPUs before CPUs, otherwise in the loader's order. Devices that do not answer
  // are left out and named in the log.
  static std::vector<DeviceInfo> list();

  // Opens a device. `selector` is "" for the first of list(), "cpu" or "gpu" for the first of that kind, an index of
  // list(), or a part of "platform name", case-insensitive. A number beyond the last index is a part of a name: "4090".
  // If several names contain the part, the first device is opened, and the log names the others. `properties` holds
  // further context properties for GL sharing, ended by zero, or is null. Errors: kInvalidArgument when nothing matches
  // (the message lists the devices), kDeviceFailure when the context cannot be made.
  static Result<Device> open(const std::string& selector = {},
                             const cl_context_properties* properties = nullptr);

  // Takes the caller's context and queue, and retains both. The queue must be in-order. Pass times are
  // reported only where it was made with CL_QUEUE_PROFILING_ENABLE.
  static Result<Device> borrow(cl_context context, cl_device_id device, cl_command_queue queue);

  // Returns the same device, context and queue; services made on it use this profile.
  Device with_profile(const DeviceProfile& profile) const;

  const DeviceInfo& info() const;
  const DeviceProfile& profile() const;
  cl_context context() const;
  cl_device_id id() const;
  cl_command_queue queue() const;

  // Allocates an uninitialised image. Buffer rows are tightly packed when `pitch` is 0. Errors:
  // kInvalidArgument for an empty extent or a bad pitch, kUnsupported for a format this device has no image
  // of, kDeviceFailure.
  Result<Image> allocate(Extent extent, PixelFormat format, Storage storage = Storage::kBuffer,
                         std::size_t pitch = 0) const;

  // Copy between host memory (rows of `row_bytes`, 0: tightly packed) and the top left `extent` of an image, and wait.
  // For tools and tests: no frame uses them. Host texels have the view's format.
  Status upload(const ImageView& image, Extent extent, const void* texels, std::size_t row_bytes = 0) const;
  Status download(const ImageView& image, Extent extent, void* texels, std::size_t row_bytes = 0) const;

  // Imports memory and semaphores of another API. Errors: kInvalidArgument for a bad field and for memory of another
  // device, kUnsupported if the device cannot import such a handle, kDeviceFailure if the driver refuses it.
  Result<SharedMemory> import_memory(const ExternalMemory& external) const;
  // `fd`: an opaque one (VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT), which stays the caller's.
  Result<Semaphore> import_semaphore(int fd) const;

  Status finish() const;  // waits for all queued work

  struct QUINCUNX_HIDDEN Impl;
  const std::shared_ptr<Impl>& impl() const { return impl_; }

 private:
  explicit Device(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

}  // namespace quincunx
