// SPDX-License-Identifier: MIT
#include "quincunx_gl/vulkan_bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cl_handle.h"
#include "frame_layout.h"
#include "probe.h"
#include "quincunx/advanced/log.h"
#include "vulkan_memory.h"

namespace quincunx::gl {
namespace {

constexpr int kMinSlots = 2, kMaxSlots = 16;
constexpr std::uint64_t kLongestSeconds = 30;  // until a copy is done

void check_vk(VkResult code, const char* call) {
  if (code != VK_SUCCESS)
    throw InteropError(fmt::format("{} failed: Vulkan error {}", call, static_cast<int>(code)));
}

// Vulkan's handles as the headers have them, and as vulkan.h has.
template <typename To, typename From>
To as(From handle) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::copy_n(reinterpret_cast<const char*>(&handle), sizeof(to), reinterpret_cast<char*>(&to));
  return to;
}

struct Functions {
  PFN_vkCreateCommandPool CreateCommandPool;
  PFN_vkDestroyCommandPool DestroyCommandPool;
  PFN_vkAllocateCommandBuffers AllocateCommandBuffers;
  PFN_vkBeginCommandBuffer BeginCommandBuffer;
  PFN_vkEndCommandBuffer EndCommandBuffer;
  PFN_vkCmdPipelineBarrier CmdPipelineBarrier;
  PFN_vkCmdCopyImageToBuffer CmdCopyImageToBuffer;
  PFN_vkCmdCopyBufferToImage CmdCopyBufferToImage;
  PFN_vkCmdCopyBuffer CmdCopyBuffer;
  PFN_vkCmdUpdateBuffer CmdUpdateBuffer;
  PFN_vkQueueSubmit QueueSubmit;
  PFN_vkCreateFence CreateFence;
  PFN_vkDestroyFence DestroyFence;
  PFN_vkWaitForFences WaitForFences;
  PFN_vkResetFences ResetFences;

  explicit Functions(const VulkanDevice& device) {
    const auto find = [&](const char* name, auto* to) {
      *to = reinterpret_cast<std::remove_pointer_t<decltype(to)>>(device.function(name));
      if (*to == nullptr) throw InteropError(fmt::format("Vulkan has no {}", name));
    };
    find("vkCreateCommandPool", &CreateCommandPool);
    find("vkDestroyCommandPool", &DestroyCommandPool);
    find("vkAllocateCommandBuffers", &AllocateCommandBuffers);
    find("vkBeginCommandBuffer", &BeginCommandBuffer);
    find("vkEndCommandBuffer", &EndCommandBuffer);
    find("vkCmdPipelineBarrier", &CmdPipelineBarrier);
    find("vkCmdCopyImageToBuffer", &CmdCopyImageToBuffer);
    find("vkCmdCopyBufferToImage", &CmdCopyBufferToImage);
    find("vkCmdCopyBuffer", &CmdCopyBuffer);
    find("vkCmdUpdateBuffer", &CmdUpdateBuffer);
    find("vkQueueSubmit", &QueueSubmit);
    find("vkCreateFence", &CreateFence);
    find("vkDestroyFence", &DestroyFence);
    find("vkWaitForFences", &WaitForFences);
    find("vkResetFences", &ResetFences);
  }
};

// Formats whose texels are a PixelFormat's.
std::vector<VkFormat> formats_of(PixelFormat format, bool is_depth) {
  switch (format) {
    case PixelFormat::kR8:
      return {VK_FORMAT_R8_UNORM};
    case PixelFormat::kR32F:
      return is_depth ? std::vector{VK_FORMAT_R32_SFLOAT, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT}
                      : std::vector{VK_FORMAT_R32_SFLOAT};
    case PixelFormat::kRG16F:
      return {VK_FORMAT_R16G16_SFLOAT};
    case PixelFormat::kRG32F:
      return {VK_FORMAT_R32G32_SFLOAT};
    case PixelFormat::kRGBA8:
      return {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB};
    case PixelFormat::kRGBA16F:
      return {VK_FORMAT_R16G16B16A16_SFLOAT};
    case PixelFormat::kRGBA32F:
      return {VK_FORMAT_R32G32B32A32_SFLOAT};
    case PixelFormat::kNone:
      break;
  }
  return {};
}

VkImageAspectFlags aspects_of(VkFormat format) {
  if (format == VK_FORMAT_D32_SFLOAT) return VK_IMAGE_ASPECT_DEPTH_BIT;
  if (format == VK_FORMAT_D32_SFLOAT_S8_UINT) return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
  return VK_IMAGE_ASPECT_COLOR_BIT;
}

// Says what is wrong with an image, by its name in the call.
void check_image(const char* name, const VulkanImage& image, PixelFormat format, bool is_depth, Extent extent,
                 std::string* faults) {
  const auto add = [&](const std::string& fault) {
    *faults += fmt::format("{}{} {}", faults->empty() ? "" : "; ", name, fault);
  };
  if ((image.image == VK_NULL_HANDLE) == (image.buffer == VK_NULL_HANDLE)) {
    add(image.image == VK_NULL_HANDLE ? "is missing; give an image or a buffer"
                                      : "has an image and a buffer; give one");
    return;
  }
  if (image.image != VK_NULL_HANDLE && image.layout == VK_IMAGE_LAYOUT_UNDEFINED)
    add("has the layout UNDEFINED; give the one that it has, and gets back");
  const std::vector<VkFormat> allowed = formats_of(format, is_depth);
  if (std::find(allowed.begin(), allowed.end(), image.format) == allowed.end()) {
    add(fmt::format("has VkFormat {} and must have {}, with texels of {}", static_cast<int>(image.format),
                    fmt::join(std::vector<int>(allowed.begin(), allowed.end()), " or "), name_of(format)));
  }
  if (image.buffer != VK_NULL_HANDLE && image.row_texels != 0 &&
      image.row_texels < static_cast<std::uint32_t>(extent.width)) {
    add(fmt::format("has rows of {} texels and must have {} at least", image.row_texels, extent.width));
  }
}

struct Direction {
  VulkanDevice::SharedSemaphore vulkan;
  std::optional<Semaphore> cl;
  bool signalled = false;  // and not waited for yet
};

// Memory that both have, and who waits for whom.
struct Crossing {
  std::unique_ptr<VulkanDevice::Memory> memory;
  std::optional<Device> device;
  std::optional<SharedMemory> cl;
  ClEvent released;  // by OpenCL, where the host waits for it
  VkCommandBuffer commands = nullptr;
  VkFence copied = VK_NULL_HANDLE;
  bool copying = false;                       // `copied` will be signalled
  std::optional<Direction> to_cl, to_vulkan;  // none: the host waits

  VkBuffer buffer() const { return as<VkBuffer>(memory->buffer()); }
};

}  // namespace

struct VulkanBridge::Impl {
  Impl(const VulkanContext& callers, const Device& with, const BridgeSettings& wanted);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Crossing make_crossing(const Device& to, std::size_t bytes);
  void destroy(Crossing& crossing) noexcept;
  static void leave(Crossing& crossing);  // until the process ends
  void probe();

  void finish_copy(Crossing& crossing);     // waits for Vulkan's last copy
  void release(Crossing& crossing);         // enqueues OpenCL's release; does not wait
  void give_to_vulkan(Crossing& crossing);  // the next submission may use it
  void give_to_cl(Crossing& crossing);      // OpenCL's next commands may
  void begin(Crossing& crossing);           // recording
  void submit(Crossing& crossing, bool to_cl, const VulkanSemaphore& wait, const VulkanSemaphore& signal);
  void change_layout(Crossing& crossing, const VulkanImage& image, VkImageLayout from, VkImageLayout to);
  void hand_memory(VkCommandBuffer commands, const Crossing& crossing, bool to_cl);
  void copy(Crossing& crossing, const VulkanImage& image, const ImageView& view, Extent extent,
            bool to_buffer);

  void make_ring();
  Result<SharedFrame> import(const VulkanFrame& frame, Extent render);
  Status present(const VulkanImage& picture, const VulkanSemaphore& free, const VulkanSemaphore& done);

  VulkanContext context;
  Device device;
  BridgeSettings settings;
  std::unique_ptr<const VulkanDevice> vulkan;
  Functions functions;
  bool mapped;
  bool semaphores;
  std::vector<Plane> planes;
  SharedFrame layout;
  VkCommandPool pool = VK_NULL_HANDLE;
  std::vector<Crossing> slots;
  Crossing output;
  ImageView output_view;
  std::uint64_t frames = 0;
  bool presenting = false;
  bool leaves_all = false;  // memory, and Vulkan's objects, which may still be in use
  std::string reason;
  std::vector<VkBufferCopy> rows;  // of the copy that is recorded; kept for its memory
};

VulkanBridge::Impl::Impl(const VulkanContext& callers, const Device& with, const BridgeSettings& wanted)
    : context(callers),
      device(with),
      settings(wanted),
      vulkan(VulkanDevice::adopt(reinterpret_cast<vk::GetInstanceProcAddr>(callers.get_instance_proc_addr),
                                 as<vk::Instance>(callers.instance),
                                 as<vk::PhysicalDevice>(callers.physical_device),
                                 as<vk::Device>(callers.device))),
      functions(*vulkan),
      mapped(!with.info().imports_opaque_fds),
      semaphores(with.info().imports_semaphores && vulkan->has_semaphores()),
      planes(planes_of(wanted)) {
  if (mapped && !device.info().host_unified_memory) {
    throw InteropError(
        fmt::format("'{}' does not offer cl_khr_external_memory_opaque_fd, and its memory is not the host's",
                    device.info().name));
  }
  const VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                        .pNext = nullptr,
                                        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                        .queueFamilyIndex = context.queue_family};
  check_vk(functions.CreateCommandPool(context.device, &info, nullptr, &pool), "vkCreateCommandPool");
}

VulkanBridge::Impl::~Impl() {
  for (Crossing& slot : slots)
    destroy(slot);
  destroy(output);
  if (leaves_all) {
    static_cast<void>(vulkan.release());
    return;
  }
  if (pool != VK_NULL_HANDLE) functions.DestroyCommandPool(context.device, pool, nullptr);
}

Crossing VulkanBridge::Impl::make_crossing(const Device& to, std::size_t bytes) {
  Crossing made;
  made.device = to;
  try {
    made.memory =
        vulkan->allocate(bytes, mapped ? VulkanDevice::Place::kMapped : VulkanDevice::Place::kDevice);
    made.cl = made.memory->import_to(to, bytes);
    for (auto* direction : {&made.to_cl, &made.to_vulkan}) {
      if (!semaphores) break;
      direction->emplace().vulkan = vulkan->semaphore();
      auto semaphore = to.import_semaphore((*direction)->vulkan.first.get());
      check_status(semaphore.status());
      (*direction)->cl = std::move(semaphore).value();
    }
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .pNext = nullptr,
                                              .commandPool = pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    check_vk(functions.AllocateCommandBuffers(context.device, &info, &made.commands),
             "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence = {
        .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .pNext = nullptr, .flags = 0};
    check_vk(functions.CreateFence(context.device, &fence, nullptr, &made.copied), "vkCreateFence");
  } catch (...) {
    destroy(made);
    throw;
  }
  return made;
}

// Neither side uses it afterwards, except that after a wait that was too long they may: all is left as it is then.
void VulkanBridge::Impl::destroy(Crossing& crossing) noexcept {
  if (!crossing.memory) return;
  try {
    if (!leaves_all) finish_copy(crossing);
    if (!leaves_all && crossing.cl) check_status(crossing.device->finish());
  } catch (const std::exception& error) {
    log_line(LogLevel::kWarning, fmt::format("interop: {}", error.what()));
    leaves_all = true;
  }
  if (leaves_all) return leave(crossing);
  if (crossing.copied != VK_NULL_HANDLE) functions.DestroyFence(context.device, crossing.copied, nullptr);
  crossing.cl.reset();  // before the memory that it uses
  crossing = {};
}

void VulkanBridge::Impl::leave(Crossing& crossing) {
  static_cast<void>(new Crossing(std::move(crossing)));
  crossing = {};
}

void VulkanBridge::Impl::finish_copy(Crossing& crossing) {
  if (!crossing.copying) return;
  const VkResult code =
      functions.WaitForFences(context.device, 1, &crossing.copied, VK_TRUE, kLongestSeconds * 1'000'000'000);
  if (code == VK_TIMEOUT) {
    throw InteropError(fmt::format(
        "Vulkan did not copy within {} s; a semaphore that it waits for, such as VulkanFrame::drawn, "
        "may never have been signalled",
        kLongestSeconds));
  }
  crossing.copying = false;
  check_vk(code, "vkWaitForFences");
  check_vk(functions.ResetFences(context.device, 1, &crossing.copied), "vkResetFences");
}

void VulkanBridge::Impl::release(Crossing& crossing) {
  if (!crossing.cl->acquired()) return;
  cl_event event = nullptr;
  check_status(crossing.cl->release(crossing.to_vulkan ? nullptr : &event));
  crossing.released = ClEvent::adopt(event);
  if (!crossing.to_vulkan) {
    check_cl(clFlush(crossing.device->queue()), "clFlush");
    return;
  }
  check_status(crossing.to_vulkan->cl->signal());
  crossing.to_vulkan->signalled = true;
}

void VulkanBridge::Impl::give_to_vulkan(Crossing& crossing) {
  release(crossing);
  wait_and_reset(crossing.released);
}

void VulkanBridge::Impl::give_to_cl(Crossing& crossing) {
  if (crossing.to_cl) {
    if (std::exchange(crossing.to_cl->signalled, false)) check_status(crossing.to_cl->cl->wait());
  } else {
    finish_copy(crossing);
  }
  check_status(crossing.cl->acquire());
}

void VulkanBridge::Impl::begin(Crossing& crossing) {
  finish_copy(crossing);
  const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .pNext = nullptr,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                         .pInheritanceInfo = nullptr};
  check_vk(functions.BeginCommandBuffer(crossing.commands, &info), "vkBeginCommandBuffer");
}

// Waits for what the memory waits for, and signals it.
void VulkanBridge::Impl::submit(Crossing& crossing, bool to_cl, const VulkanSemaphore& wait,
                                const VulkanSemaphore& signal) {
  check_vk(functions.EndCommandBuffer(crossing.commands), "vkEndCommandBuffer");
  struct List {  // the caller's and the bridge's
    std::array<VkSemaphore, 2> semaphores = {};
    std::array<std::uint64_t, 2> values = {};
    std::uint32_t size = 0;
    void add(const VulkanSemaphore& one) {
      if (one.semaphore == VK_NULL_HANDLE) return;
      semaphores[size] = one.semaphore;
      values[size++] = one.value;
    }
  } waits, signals;
  waits.add(wait);
  signals.add(signal);
  auto& released = crossing.to_vulkan;
  if (released && std::exchange(released->signalled, false))
    waits.add({as<VkSemaphore>(released->vulkan.semaphore)});
  if (to_cl && crossing.to_cl) signals.add({as<VkSemaphore>(crossing.to_cl->vulkan.semaphore)});
  constexpr VkPipelineStageFlags kStages[] = {VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                              VK_PIPELINE_STAGE_ALL_COMMANDS_BIT};
  const VkTimelineSemaphoreSubmitInfo timeline = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                                  .pNext = nullptr,
                                                  .waitSemaphoreValueCount = waits.size,
                                                  .pWaitSemaphoreValues = waits.values.data(),
                                                  .signalSemaphoreValueCount = signals.size,
                                                  .pSignalSemaphoreValues = signals.values.data()};
  const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                             .pNext = wait.value != 0 || signal.value != 0 ? &timeline : nullptr,
                             .waitSemaphoreCount = waits.size,
                             .pWaitSemaphores = waits.semaphores.data(),
                             .pWaitDstStageMask = kStages,
                             .commandBufferCount = 1,
                             .pCommandBuffers = &crossing.commands,
                             .signalSemaphoreCount = signals.size,
                             .pSignalSemaphores = signals.semaphores.data()};
  check_vk(functions.QueueSubmit(context.queue, 1, &info, crossing.copied), "vkQueueSubmit");
  crossing.copying = true;
  if (to_cl && crossing.to_cl) crossing.to_cl->signalled = true;
}

void VulkanBridge::Impl::change_layout(Crossing& crossing, const VulkanImage& image, VkImageLayout from,
                                       VkImageLayout to) {
  const VkImageMemoryBarrier barrier = {
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
      .pNext = nullptr,
      .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
      .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
      .oldLayout = from,
      .newLayout = to,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image.image,
      .subresourceRange = {aspects_of(image.format), 0, 1, 0, 1}};
  constexpr VkPipelineStageFlags kAll = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  functions.CmdPipelineBarrier(crossing.commands, kAll, kAll, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

// The memory's change of sides, which Vulkan sees as one of queue families.
void VulkanBridge::Impl::hand_memory(VkCommandBuffer commands, const Crossing& crossing, bool to_cl) {
  const auto outside = std::uint32_t{VK_QUEUE_FAMILY_EXTERNAL};
  const VkBufferMemoryBarrier barrier = {
      .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
      .pNext = nullptr,
      .srcAccessMask = to_cl ? VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT : VkAccessFlags{0},
      .dstAccessMask =
          to_cl ? VkAccessFlags{VK_ACCESS_HOST_READ_BIT} : VkAccessFlags{VK_ACCESS_TRANSFER_READ_BIT},
      .srcQueueFamilyIndex = mapped  ? VK_QUEUE_FAMILY_IGNORED
                             : to_cl ? context.queue_family
                                     : outside,
      .dstQueueFamilyIndex = mapped  ? VK_QUEUE_FAMILY_IGNORED
                             : to_cl ? outside
                                     : context.queue_family,
      .buffer = crossing.buffer(),
      .offset = 0,
      .size = VK_WHOLE_SIZE};
  const VkPipelineStageFlags copies = VK_PIPELINE_STAGE_TRANSFER_BIT;
  functions.CmdPipelineBarrier(commands, to_cl ? copies : VkPipelineStageFlags{VK_PIPELINE_STAGE_HOST_BIT},
                               to_cl ? VkPipelineStageFlags{VK_PIPELINE_STAGE_HOST_BIT} : copies, 0, 0,
                               nullptr, 1, &barrier, 0, nullptr);
}

void VulkanBridge::Impl::copy(Crossing& crossing, const VulkanImage& image, const ImageView& view,
                              Extent extent, bool to_buffer) {
  const std::size_t texel = bytes_per_pixel(view.format);
  const VkDeviceSize begin = crossing.memory->start() + view.offset;
  if (image.buffer != VK_NULL_HANDLE) {
    const auto width = static_cast<std::size_t>(extent.width);
    const std::size_t row_bytes = (image.row_texels != 0 ? image.row_texels : width) * texel;
    rows.clear();
    for (std::size_t y = 0; y < static_cast<std::size_t>(extent.height); ++y) {
      const VkDeviceSize ours = begin + y * view.row_pitch(), callers = image.offset + y * row_bytes;
      rows.push_back({to_buffer ? callers : ours, to_buffer ? ours : callers, width * texel});
    }
    functions.CmdCopyBuffer(crossing.commands, to_buffer ? image.buffer : crossing.buffer(),
                            to_buffer ? crossing.buffer() : image.buffer,
                            static_cast<std::uint32_t>(rows.size()), rows.data());
    return;
  }
  const bool is_depth = aspects_of(image.format) != VK_IMAGE_ASPECT_COLOR_BIT;
  const VkBufferImageCopy region = {
      .bufferOffset = begin,
      .bufferRowLength = static_cast<std::uint32_t>(view.row_pitch() / texel),
      .bufferImageHeight = 0,
      .imageSubresource = {is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
      .imageOffset = {},
      .imageExtent = {static_cast<std::uint32_t>(extent.width), static_cast<std::uint32_t>(extent.height),
                      1}};
  const VkImageLayout use =
      to_buffer ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  change_layout(crossing, image, to_buffer ? image.layout : VK_IMAGE_LAYOUT_UNDEFINED, use);
  if (to_buffer) {
    functions.CmdCopyImageToBuffer(crossing.commands, image.image, use, crossing.buffer(), 1, &region);
  } else {
    functions.CmdCopyBufferToImage(crossing.commands, crossing.buffer(), image.image, use, 1, &region);
  }
  change_layout(crossing, image, use, image.layout);
}

// Vulkan writes bytes that OpenCL reads, then OpenCL others that Vulkan copies to where OpenCL reads them.
void VulkanBridge::Impl::probe() {
  const Device own = probe_device(device);
  Crossing to_and_fro = make_crossing(own, kProbeBytes), second = make_crossing(own, kProbeBytes);
  const std::vector<std::uint8_t> from_vulkan = probe_bytes(1), from_cl = probe_bytes(2);
  std::vector<std::uint8_t> seen;
  try {
    begin(to_and_fro);
    functions.CmdUpdateBuffer(to_and_fro.commands, to_and_fro.buffer(), to_and_fro.memory->start(),
                              kProbeBytes, from_vulkan.data());
    hand_memory(to_and_fro.commands, to_and_fro, true);
    submit(to_and_fro, true, {}, {});
    give_to_cl(to_and_fro);
    try {
      seen = read_probe(own, to_and_fro.cl->memory(), "Vulkan");
    } catch (...) {
      leave(to_and_fro);
      leave(second);
      throw;
    }
    if (seen != from_vulkan) throw InteropError("OpenCL read other bytes than Vulkan wrote");

    check_cl(clEnqueueWriteBuffer(own.queue(), to_and_fro.cl->memory(), CL_TRUE, 0, kProbeBytes,
                                  from_cl.data(), 0, nullptr, nullptr),
             "clEnqueueWriteBuffer");
    give_to_vulkan(to_and_fro);
    begin(to_and_fro);
    hand_memory(to_and_fro.commands, to_and_fro, false);
    const VkBufferCopy all = {to_and_fro.memory->start(), second.memory->start(), kProbeBytes};
    functions.CmdCopyBuffer(to_and_fro.commands, to_and_fro.buffer(), second.buffer(), 1, &all);
    hand_memory(to_and_fro.commands, second, true);
    submit(to_and_fro, false, {}, {});
    finish_copy(to_and_fro);
    check_status(second.cl->acquire());
    if (read_probe(own, second.cl->memory(), "Vulkan") != from_cl)
      throw InteropError("Vulkan read other bytes than OpenCL wrote");
  } catch (...) {
    destroy(to_and_fro);
    destroy(second);
    throw;
  }
  destroy(to_and_fro);
  destroy(second);
}

void VulkanBridge::Impl::make_ring() {
  const FrameLayout laid_out = lay_out(planes, settings.target_extent, Targets::kViewport, 1);
  layout = laid_out.views;
  for (int i = 0; i < settings.slots; ++i)
    slots.push_back(make_crossing(device, laid_out.bytes));
  output_view = {.format = settings.picture,
                 .extent = settings.output_extent,
                 .pitch = settings.output_extent.width * bytes_per_pixel(settings.picture)};
  output = make_crossing(device, output_view.pitch * static_cast<std::size_t>(settings.output_extent.height));
  output_view.memory = output.cl->memory();
}

Result<SharedFrame> VulkanBridge::Impl::import(const VulkanFrame& frame, Extent render) {
  const auto image_of = [&](PlaneKind kind) -> std::pair<const char*, const VulkanImage&> {
    switch (kind) {
      case PlaneKind::kDepth:
        return {"depth", frame.depth};
      case PlaneKind::kVelocity:
        return {"velocity", frame.velocity};
      case PlaneKind::kReactive:
        return {"reactive", frame.reactive};
      case PlaneKind::kColour:
        break;
    }
    return {"colour", frame.colour};
  };
  std::string faults;
  const Extent target = settings.target_extent;
  if (render.width < 1 || render.height < 1 || render.width > target.width || render.height > target.height) {
    faults = fmt::format("the render extent is {}x{} and must lie within 1x1 and the target's {}x{}",
                         render.width, render.height, target.width, target.height);
  }
  for (const Plane& plane : planes) {
    const auto [name, image] = image_of(plane.kind);
    check_image(name, image, plane.format, plane.kind == PlaneKind::kDepth, render, &faults);
  }
  if (!faults.empty()) return Status::invalid("VulkanBridge::import: " + faults);

  try {
    // All that reads the frame before the last is enqueued by now, and nothing of this frame: where the host waits, it
    // need not wait for this one.
    const auto slot_of = [&](std::uint64_t index) -> Crossing& { return slots[index % slots.size()]; };
    if (frames >= 2) release(slot_of(frames - 2));
    Crossing& slot = slot_of(frames);
    give_to_vulkan(slot);
    begin(slot);
    for (const Plane& plane : planes)
      copy(slot, image_of(plane.kind).second, view_of(layout, plane.kind), render, true);
    hand_memory(slot.commands, slot, true);
    submit(slot, true, frame.drawn, frame.taken);
    give_to_cl(slot);
    ++frames;
    SharedFrame views = layout;
    for (const Plane& plane : planes)
      view_of(views, plane.kind).memory = slot.cl->memory();
    return views;
  } catch (const std::exception& error) {
    return Status::device(fmt::format("VulkanBridge::import on '{}': {}", device.info().name, error.what()));
  }
}

Status VulkanBridge::Impl::present(const VulkanImage& picture, const VulkanSemaphore& free,
                                   const VulkanSemaphore& done) {
  constexpr const char* kCall = "VulkanBridge::present";
  if (!presenting)
    return Status::invalid(
        fmt::format("{}: no picture was begun; call begin_present() and dispatch first", kCall));
  std::string faults;
  check_image("picture", picture, settings.picture, false, settings.output_extent, &faults);
  if (!faults.empty()) return Status::invalid(fmt::format("{}: {}", kCall, faults));
  try {
    give_to_vulkan(output);
    begin(output);
    hand_memory(output.commands, output, false);
    copy(output, picture, output_view, settings.output_extent, false);
    hand_memory(output.commands, output, true);
    submit(output, true, free, done);
    presenting = false;
    return {};
  } catch (const std::exception& error) {
    return Status::device(fmt::format("{} on '{}': {}", kCall, device.info().name, error.what()));
  }
}

VulkanBridge::VulkanBridge(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VulkanBridge::~VulkanBridge() = default;

const std::string& VulkanBridge::reason() const {
  return impl_->reason;
}

Result<std::unique_ptr<VulkanBridge>> VulkanBridge::create(const VulkanContext& context, const Device& device,
                                                           const BridgeSettings& settings) {
  std::string fault;
  const auto expect = [&](bool holds, const std::string& else_) {
    if (!holds && fault.empty()) fault = else_;
  };
  expect(context.get_instance_proc_addr != nullptr && context.instance != nullptr &&
             context.physical_device != nullptr && context.device != nullptr && context.queue != nullptr,
         "a handle of the context is null");
  expect(settings.target_extent.area() > 0 && settings.output_extent.area() > 0,
         "target_extent and output_extent must not be empty");
  expect(settings.slots >= kMinSlots && settings.slots <= kMaxSlots,
         fmt::format("slots is {} and must be {} to {}", settings.slots, kMinSlots, kMaxSlots));
  expect(settings.targets == Targets::kViewport, "targets must be kViewport; placed ones are OpenGL's");
  for (const Plane& plane : planes_of(settings)) {
    expect(!formats_of(plane.format, false).empty(),
           fmt::format("no plane can have the format {}", name_of(plane.format)));
  }
  if (!fault.empty()) return Status::invalid("VulkanBridge::create: " + fault);
  try {
    auto impl = std::make_unique<Impl>(context, device, settings);
    try {
      impl->probe();
    } catch (const std::exception& error) {
      if (!std::exchange(impl->semaphores, false)) throw;
      log_line(LogLevel::kWarning, fmt::format("interop: semaphores are left out: {}", error.what()));
      impl->probe();
    }
    impl->make_ring();
    impl->reason = fmt::format("Vulkan and '{}' use {}, ordered by {}, as a probe has shown",
                               device.info().name, impl->mapped ? "the host's memory" : "the same memory",
                               impl->semaphores ? "semaphores" : "waits of the host");
    log_line(LogLevel::kInfo, fmt::format("interop: vulkan ({})", impl->reason));
    return std::unique_ptr<VulkanBridge>(new VulkanBridge(std::move(impl)));
  } catch (const std::exception& error) {
    return Status::unsupported(
        fmt::format("VulkanBridge::create on '{}': {}", device.info().name, error.what()));
  }
}

Result<SharedFrame> VulkanBridge::import(const VulkanFrame& frame, Extent render) {
  return impl_->import(frame, render);
}

Result<ImageView> VulkanBridge::begin_present() {
  try {
    impl_->give_to_cl(impl_->output);
    impl_->presenting = true;
    return impl_->output_view;
  } catch (const std::exception& error) {
    return Status::device(
        fmt::format("VulkanBridge::begin_present on '{}': {}", impl_->device.info().name, error.what()));
  }
}

Status VulkanBridge::present(const VulkanImage& picture, const VulkanSemaphore& free,
                             const VulkanSemaphore& done) {
  return impl_->present(picture, free, done);
}

}  // namespace quincunx::gl
