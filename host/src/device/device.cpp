// SPDX-License-Identifier: MIT
#include "quincunx/device.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "device/device_impl.h"
#include "quincunx/advanced/log.h"
#include "quincunx/control/front_file.h"

namespace quincunx {
namespace {

DeviceKind kind_of(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_GPU) return DeviceKind::kGpu;
  if (type & CL_DEVICE_TYPE_CPU) return DeviceKind::kCpu;
  if (type & CL_DEVICE_TYPE_ACCELERATOR) return DeviceKind::kAccelerator;
  return DeviceKind::kOther;
}

// Vendors pad names with blanks and, in some drivers, a final zero.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back())))) {
    text.pop_back();
  }
  const auto first = std::find_if(text.begin(), text.end(), [](unsigned char c) { return !std::isspace(c); });
  return {first, text.end()};
}

int image_pitch_texels(const cl::Device& device) {
  cl_uint texels = 0;
  const bool known = has_extension(device, "cl_khr_image2d_from_buffer") &&
                     clGetDeviceInfo(device(), CL_DEVICE_IMAGE_PITCH_ALIGNMENT_KHR, sizeof(texels), &texels,
                                     nullptr) == CL_SUCCESS;
  return known ? static_cast<int>(texels) : 0;
}

// PoCL keeps a kernel for each size of group that it ran with. Asked for a program's binary it compiles each
// kernel once more, for any size (docs/pipeline.md).
bool keeps_programs(const DeviceInfo& info) {
  return info.platform == "Portable Computing Language";
}

DeviceInfo info_of(const cl::Device& device) {
  DeviceInfo info;
  info.kind = kind_of(device.getInfo<CL_DEVICE_TYPE>());
  info.platform = trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.global_memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.images = device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() != 0;
  info.host_unified_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != 0;
  info.image_pitch_texels = info.images ? image_pitch_texels(device) : 0;
  info.gl_sharing = has_extension(device, "cl_khr_gl_sharing");
  learn_imports(device, info);
  return info;
}

bool lists_format(const cl::Context& context, const cl::ImageFormat& wanted) {
  std::vector<cl::ImageFormat> formats;
  context.getSupportedImageFormats(CL_MEM_READ_WRITE, CL_MEM_OBJECT_IMAGE2D, &formats);
  return std::any_of(formats.begin(), formats.end(), [&](const cl::ImageFormat& format) {
    return format.image_channel_order == wanted.image_channel_order &&
           format.image_channel_data_type == wanted.image_channel_data_type;
  });
}

// Mesa's compiler takes minutes for vectors of eight, on a CPU as well.
int usual_lanes(const DeviceInfo& info) {
  return info.kind == DeviceKind::kCpu && info.platform != "rusticl" ? 8 : 1;
}

Status choose_lanes(Device::Impl& impl) {
  impl.lanes = usual_lanes(impl.info);
  const char* wanted = std::getenv("QUINCUNX_LANES");
  if (wanted == nullptr) return {};
  const std::string_view text = wanted;
  if (text != "1" && text != "8")
    return Status::invalid(fmt::format("QUINCUNX_LANES is '{}'; it must be 1 or 8", text));
  impl.lanes = text == "8" ? 8 : 1;
  return {};
}

// Finds out all that follows from the device, the context and the queue.
Status learn(Device::Impl& impl) {
  if (Status status = choose_lanes(impl); !status.ok()) return status;
  impl.info.two_channel_images =
      impl.info.images && lists_format(impl.context, cl::ImageFormat(CL_RG, CL_HALF_FLOAT));
  impl.limits_registers = has_extension(impl.device, "cl_nv_compiler_options");
  impl.keeps_programs = keeps_programs(impl.info);
  impl.timer = validated_timer(impl);
  impl.profile = find_profile(impl);
  return {};
}

constexpr cl_int kNoPlatform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR: there is no driver at all

struct FoundDevice {
  cl::Device device;
  DeviceInfo info;
};

std::string platform_name(const cl::Platform& platform) {
  try {
    return trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  } catch (const cl::Error&) {
    return "a platform without a name";
  }
}

// A broken driver beside good ones must not take those along: it is named in the log, and left out. Called within a
// catch block.
void leave_out(const std::string& what, const std::string& platform) {
  log_line(LogLevel::kWarning,
           fmt::format("an OpenCL driver is broken and is left out: {}", caught(what, platform).message()));
}

void add_devices(const cl::Platform& platform, std::vector<FoundDevice>& found) {
  std::vector<cl::Device> devices;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
  } catch (const cl::Error& error) {
    if (error.err() != CL_DEVICE_NOT_FOUND) leave_out("list of devices", platform_name(platform));
    return;
  }
  for (const cl::Device& device : devices) {
    try {
      found.push_back({device, info_of(device)});
    } catch (const cl::Error&) {
      leave_out("a device", platform_name(platform));
    }
  }
}

// PoCL and its compiler take up to 650 MB of addresses before the first picture, and abort or wait for ever where they
// get fewer.
Status check_room() {
  constexpr rlim_t kDriverBytes = 700'000'000;
  struct rlimit limit = {};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  rlim_t taken = 0;
  std::ifstream("/proc/self/statm") >> taken;  // pages
  taken *= static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  if (limit.rlim_cur >= taken + kDriverBytes) return {};
  return Status::device(fmt::format(
      "there is too little memory for an OpenCL driver: ulimit -v is {}; it has to be {} at least",
      limit.rlim_cur / 1024, (taken + kDriverBytes) / 1024 + 1));
}

// Returns all devices that answer, with their places in the list.
std::vector<FoundDevice> all_devices() {
  if (!check_room().ok()) return {};
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error& error) {
    if (error.err() != kNoPlatform) leave_out("list of platforms", "the OpenCL loader");
  }
  std::vector<FoundDevice> found;
  for (const cl::Platform& platform : platforms)
    add_devices(platform, found);
  std::stable_partition(found.begin(), found.end(),
                        [](const FoundDevice& one) { return one.info.kind == DeviceKind::kGpu; });
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i].info.index = static_cast<int>(i);
  return found;
}

// Where PoCL would keep its programs, if it cannot.
std::string unwritable_cache() {
  std::filesystem::path folder;
  for (const char* name : {"POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME"}) {
    const char* value = std::getenv(name);
    if (folder.empty() && value != nullptr) folder = value;
  }
  std::error_code error;
  while (folder.has_relative_path() && !std::filesystem::exists(folder, error))
    folder = folder.parent_path();
  const bool is_good = std::filesystem::is_directory(folder, error) && ::access(folder.c_str(), W_OK) == 0;
  return folder.empty() || is_good ? "" : folder.string();
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string searched_name(const DeviceInfo& info) {
  return lower(info.platform + " " + info.name);
}

Status no_match(const std::string& selector, const std::vector<DeviceInfo>& infos) {
  if (Status status = check_room(); !status.ok()) return status;
  if (infos.empty()) {
    const std::string cache = unwritable_cache();
    return Status::unsupported(fmt::format(
        "no OpenCL device found; {}",
        cache.empty()
            ? "install a driver, for example the Debian package pocl-opencl-icd for the CPU"
            : fmt::format("PoCL has none where it cannot write below '{}': set XDG_CACHE_HOME or HOME to a "
                          "folder that can be written",
                          cache)));
  }
  std::string known;
  for (const DeviceInfo& info : infos) {
    known += fmt::format("{}{} '{}'", known.empty() ? "" : ", ", info.index, info.name);
  }
  return Status::invalid(fmt::format(
      "no OpenCL device matches '{}' as an index, as cpu or gpu, or as a part of a name; there are: {}",
      selector, known));
}

cl::ImageFormat channel_format(PixelFormat format, bool two_channel_images) {
  const int channels = channels_of(format);
  const std::size_t bytes = channels == 0 ? 0 : bytes_per_pixel(format) / static_cast<std::size_t>(channels);
  const cl_channel_order order = channels == 1 ? CL_R : channels == 2 && two_channel_images ? CL_RG : CL_RGBA;
  return {order, static_cast<cl_channel_type>(bytes == 1   ? CL_UNORM_INT8
                                              : bytes == 2 ? CL_HALF_FLOAT
                                                           : CL_FLOAT)};
}

}  // namespace

bool has_extension(const cl::Device& device, const std::string& extension) {
  const std::string all = fmt::format(" {} ", device.getInfo<CL_DEVICE_EXTENSIONS>());
  return all.find(fmt::format(" {} ", extension)) != std::string::npos;
}

FrontKey front_key(const DeviceInfo& device, const std::string& scene) {
  return {.device = device.platform + " " + device.name, .driver = device.driver, .scene = scene};
}

std::optional<std::size_t> choose_device(const std::string& selector, const std::vector<DeviceInfo>& infos) {
  const std::string wanted = lower(selector);
  std::size_t index = 0;
  const char* const end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, index);
  const bool is_index = parsed.ec == std::errc() && parsed.ptr == end && index < infos.size();
  if (is_index) return index;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const bool fits = wanted == "cpu"   ? infos[i].kind == DeviceKind::kCpu
                      : wanted == "gpu" ? infos[i].kind == DeviceKind::kGpu
                                        : searched_name(infos[i]).find(wanted) != std::string::npos;
    if (fits) return i;
  }
  return std::nullopt;
}

namespace {

// Says which device is taken where a part of a name, or a number, could mean another one as well.
void tell_choice(const std::string& selector, const std::vector<DeviceInfo>& infos,
                 const DeviceInfo& chosen) {
  const std::string wanted = lower(selector);
  if (wanted.empty() || wanted == "cpu" || wanted == "gpu") return;
  for (const DeviceInfo& other : infos) {
    if (other.index == chosen.index || searched_name(other).find(wanted) == std::string::npos) continue;
    log_line(LogLevel::kInfo, fmt::format("'{}' could also mean device {} '{}'; {} '{}' is taken", selector,
                                          other.index, other.name, chosen.index, chosen.name));
  }
}

}  // namespace

std::vector<DeviceInfo> Device::list() {
  std::vector<DeviceInfo> infos;
  for (FoundDevice& found : all_devices())
    infos.push_back(std::move(found.info));
  return infos;
}

Result<Device> Device::open(const std::string& selector, const cl_context_properties* properties) {
  std::string name = "the device '" + selector + "'";
  try {
    const std::vector<FoundDevice> found = all_devices();
    std::vector<DeviceInfo> infos;
    for (const FoundDevice& one : found)
      infos.push_back(one.info);
    const std::optional<std::size_t> at = choose_device(selector, infos);
    if (!at) return no_match(selector, infos);
    const FoundDevice& chosen = found[*at];
    name = chosen.info.name;
    tell_choice(selector, infos, chosen.info);
    auto impl = std::make_shared<Impl>();
    impl->info = chosen.info;
    impl->device = chosen.device;
    std::vector<cl_context_properties> all = {
        CL_CONTEXT_PLATFORM,
        reinterpret_cast<cl_context_properties>(cl::Platform(chosen.device.getInfo<CL_DEVICE_PLATFORM>())())};
    for (const cl_context_properties* p = properties; p != nullptr && *p != 0; p += 2) {
      all.insert(all.end(), {p[0], p[1]});
    }
    all.push_back(0);
    impl->context = cl::Context(impl->device, all.data());
    impl->queue = cl::CommandQueue(impl->context, impl->device, CL_QUEUE_PROFILING_ENABLE);
    if (Status status = learn(*impl); !status.ok()) return status;
    return Device(std::move(impl));
  } catch (...) {
    return caught("Device::open", name);
  }
}

Result<Device> Device::borrow(cl_context context, cl_device_id device, cl_command_queue queue) {
  if (context == nullptr || device == nullptr || queue == nullptr) {
    return Status::invalid("Device::borrow needs a context, a device and a queue; at least one is null");
  }
  try {
    auto impl = std::make_shared<Impl>();
    impl->device = quincunx::borrow<cl::Device>(device);
    impl->context = quincunx::borrow<cl::Context>(context);
    impl->queue = quincunx::borrow<cl::CommandQueue>(queue);
    if (impl->queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) {
      return Status::invalid("the queue given to Device::borrow is out-of-order; it must be in-order");
    }
    impl->info = info_of(impl->device);
    if (Status status = learn(*impl); !status.ok()) return status;
    return Device(std::move(impl));
  } catch (...) {
    return caught("Device::borrow", "a borrowed device");
  }
}

Device Device::with_profile(const DeviceProfile& profile) const {
  auto impl = std::make_shared<Impl>(*impl_);
  impl->profile = profile;
  return Device(std::move(impl));
}

const DeviceInfo& Device::info() const {
  return impl_->info;
}
const DeviceProfile& Device::profile() const {
  return impl_->profile;
}
cl_context Device::context() const {
  return impl_->context();
}
cl_device_id Device::id() const {
  return impl_->device();
}
cl_command_queue Device::queue() const {
  return impl_->queue();
}

Result<Image> Device::allocate(Extent extent, PixelFormat format, Storage storage, std::size_t pitch) const {
  const std::size_t texel = bytes_per_pixel(format);
  if (extent.width < 1 || extent.height < 1 || texel == 0) {
    return Status::invalid(fmt::format(
        "the image to allocate is {}x{} of format {}; its sides must be at least 1, and its format "
        "must not be none",
        extent.width, extent.height, name_of(format)));
  }
  ImageView view = {.storage = storage, .format = format, .extent = extent};
  try {
    if (storage == Storage::kImage) {
      if (pitch != 0) return Status::invalid("pitch is set for image storage; only buffers have one");
      const cl::ImageFormat channels = channel_format(format, impl_->info.two_channel_images);
      if (!impl_->info.images || !lists_format(impl_->context, channels)) {
        return Status::unsupported(
            fmt::format("'{}' has no {} images; use buffer storage", impl_->info.name, name_of(format)));
      }
      cl::Image2D image(impl_->context, impl_->picture_flags(), channels, extent.width, extent.height);
      view.memory = image();
      return Image::borrow(view);
    }
    view.pitch = pitch != 0 ? pitch : extent.width * texel;
    if (view.pitch < extent.width * texel || view.pitch % texel != 0) {
      return Status::invalid(
          fmt::format("pitch is {} bytes; for {} texels of {} it must be a multiple of {} and at "
                      "least {}",
                      view.pitch, extent.width, name_of(format), texel, extent.width * texel));
    }
    cl::Buffer buffer(impl_->context, impl_->picture_flags(), view.pitch * extent.height);
    view.memory = buffer();
    return Image::borrow(view);
  } catch (...) {
    return caught(fmt::format("{}x{} {}", extent.width, extent.height, name_of(format)), impl_->info.name);
  }
}

Status Device::finish() const {
  try {
    // rusticl 22.3 waits only for what was not flushed yet.
    cl::Event done;
    impl_->queue.enqueueMarkerWithWaitList(nullptr, &done);
    if (longest_wait_ms != 0) {
      impl_->queue.flush();
      wait_for(done);
    }
    impl_->queue.finish();
    return {};
  } catch (...) {
    return caught("finish", impl_->info.name);
  }
}

}  // namespace quincunx
