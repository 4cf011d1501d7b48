// SPDX-License-Identifier: MIT
// VulkanBridge with an engine's images and buffers: on a processor lavapipe's, which PoCL uses where they are mapped,
// or a stand-in imports.
#if __has_include(<vulkan/vulkan.hpp>)
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VULKAN_HPP_DISPATCH_LOADER_DYNAMIC 1
#include "quincunx_gl/vulkan_bridge.h"

#include <dlfcn.h>

#include <cstring>
#include <optional>
#include <vulkan/vulkan.hpp>

#include "cl_imports.h"
#include "cl_interposer.h"
#include "gl_semaphores.h"
#include "interop_fixture.h"
#include "skip.h"

VULKAN_HPP_DEFAULT_DISPATCH_LOADER_DYNAMIC_STORAGE

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {96, 80};
constexpr Extent kOutput = {64, 48};
constexpr int kFrames = 24;
constexpr ::vk::DeviceSize kOffset = 256;  // of texels in buffers

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// An engine's device. It stays: with NVIDIA's OpenGL's context would go.
struct Engine {
  ::vk::Instance instance;
  ::vk::PhysicalDevice physical;
  ::vk::Device device;
  ::vk::Queue queue;
  ::vk::CommandPool pool;
  ::vk::Semaphore order;  // a timeline
  std::uint64_t value = 0;

  static Engine& get() {
    static auto* const engine = new Engine;
    return *engine;
  }
  static bool exists() { return dlopen("libvulkan.so.1", RTLD_NOW) != nullptr && get().device; }

  VulkanContext context() const {
    return {.get_instance_proc_addr = VULKAN_HPP_DEFAULT_DISPATCHER.vkGetInstanceProcAddr,
            .instance = instance,
            .physical_device = physical,
            .device = device,
            .queue = queue};
  }

  ::vk::DeviceMemory allocate(const ::vk::MemoryRequirements& needs, ::vk::MemoryPropertyFlags flags) const {
    const auto memory = physical.getMemoryProperties();
    std::uint32_t type = 0;
    while ((needs.memoryTypeBits >> type & 1) == 0 ||
           (memory.memoryTypes[type].propertyFlags & flags) != flags)
      ++type;
    return device.allocateMemory({.allocationSize = needs.size, .memoryTypeIndex = type});
  }

  // Runs commands, then signals the timeline's next value.
  template <typename Record>
  VulkanSemaphore submit(const Record& record) {
    const auto commands =
        device.allocateCommandBuffers({.commandPool = pool, .commandBufferCount = 1}).front();
    commands.begin(::vk::CommandBufferBeginInfo{});
    record(commands);
    commands.end();
    const std::uint64_t next = ++value;
    const ::vk::TimelineSemaphoreSubmitInfo values = {.signalSemaphoreValueCount = 1,
                                                      .pSignalSemaphoreValues = &next};
    queue.submit(::vk::SubmitInfo{.pNext = &values,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &commands,
                                  .signalSemaphoreCount = 1,
                                  .pSignalSemaphores = &order});
    return {order, next};
  }
  void wait(const VulkanSemaphore& until) const {
    const ::vk::Semaphore semaphore = until.semaphore;
    const ::vk::SemaphoreWaitInfo info = {
        .semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &until.value};
    ASSERT_EQ(device.waitSemaphores(info, 10'000'000'000), ::vk::Result::eSuccess);
  }

 private:
  Engine() {
    VULKAN_HPP_DEFAULT_DISPATCHER.init(reinterpret_cast<PFN_vkGetInstanceProcAddr>(
        dlsym(dlopen("libvulkan.so.1", RTLD_NOW), "vkGetInstanceProcAddr")));
    const ::vk::ApplicationInfo application = {.apiVersion = VK_API_VERSION_1_2};
    instance = ::vk::createInstance({.pApplicationInfo = &application});
    VULKAN_HPP_DEFAULT_DISPATCHER.init(instance);
    for (const ::vk::PhysicalDevice one : instance.enumeratePhysicalDevices()) {
      const auto chain =
          one.getProperties2<::vk::PhysicalDeviceProperties2, ::vk::PhysicalDeviceIDProperties>();
      const auto& its = chain.get<::vk::PhysicalDeviceIDProperties>().deviceUUID;
      const DeviceUuid uuid = gl_device_uuid();
      if (std::equal(uuid.begin(), uuid.end(), its.begin())) physical = one;
    }
    if (!physical) return;
    std::vector<const char*> extensions = {"VK_KHR_external_memory_fd"};
    for (const auto& offered : physical.enumerateDeviceExtensionProperties()) {
      if (contains(offered.extensionName.data(), "VK_KHR_external_semaphore_fd"))
        extensions.push_back("VK_KHR_external_semaphore_fd");
    }
    ::vk::PhysicalDeviceVulkan12Features timeline = {.timelineSemaphore = VK_TRUE};
    const float priority = 1;
    const ::vk::DeviceQueueCreateInfo queues = {.queueCount = 1, .pQueuePriorities = &priority};
    device = physical.createDevice({.pNext = &timeline,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queues,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()});
    queue = device.getQueue(0, 0);
    pool = device.createCommandPool({});
    const ::vk::SemaphoreTypeCreateInfo type = {.semaphoreType = ::vk::SemaphoreType::eTimeline};
    order = device.createSemaphore({.pNext = &type});
  }
};

// An image, and a buffer of the host's to fill and read it.
class EngineImage {
 public:
  EngineImage(PixelFormat format, bool is_depth, Extent extent)
      : format_(format),
        extent_(extent),
        is_depth_(is_depth),
        row_texels_(static_cast<std::uint32_t>(extent.width) + 8) {
    Engine& engine = Engine::get();
    using Usage = ::vk::ImageUsageFlagBits;
    const ::vk::Extent3D size = {static_cast<std::uint32_t>(extent.width),
                                 static_cast<std::uint32_t>(extent.height), 1};
    image_ = engine.device.createImage({.imageType = ::vk::ImageType::e2D,
                                        .format = vk_format(),
                                        .extent = size,
                                        .mipLevels = 1,
                                        .arrayLayers = 1,
                                        .usage = Usage::eTransferSrc | Usage::eTransferDst});
    memory_[0] = engine.allocate(engine.device.getImageMemoryRequirements(image_), {});
    engine.device.bindImageMemory(image_, memory_[0], 0);
    const ::vk::DeviceSize bytes = kOffset + row_bytes() * static_cast<std::size_t>(extent.height);
    buffer_ = engine.device.createBuffer(
        {.size = bytes,
         .usage = ::vk::BufferUsageFlagBits::eTransferSrc | ::vk::BufferUsageFlagBits::eTransferDst});
    using Property = ::vk::MemoryPropertyFlagBits;
    memory_[1] = engine.allocate(engine.device.getBufferMemoryRequirements(buffer_),
                                 Property::eHostVisible | Property::eHostCoherent);
    engine.device.bindBufferMemory(buffer_, memory_[1], 0);
    bytes_ = static_cast<std::uint8_t*>(engine.device.mapMemory(memory_[1], 0, bytes)) + kOffset;
  }
  ~EngineImage() {
    Engine& engine = Engine::get();
    engine.queue.waitIdle();
    engine.device.destroyImage(image_);
    engine.device.destroyBuffer(buffer_);
    for (const auto& memory : memory_)
      engine.device.freeMemory(memory);
  }
  EngineImage(const EngineImage&) = delete;
  EngineImage& operator=(const EngineImage&) = delete;

  VulkanImage as_image() const {
    return {.image = image_, .layout = VK_IMAGE_LAYOUT_GENERAL, .format = static_cast<VkFormat>(vk_format())};
  }
  VulkanImage as_buffer() const {
    return {.format = static_cast<VkFormat>(vk_format()),
            .buffer = buffer_,
            .offset = kOffset,
            .row_texels = row_texels_};
  }

  // Texels of the upper left part.
  VulkanSemaphore fill(const Bytes& texels, Extent part) {
    const std::size_t row = static_cast<std::size_t>(part.width) * bytes_per_pixel(format_);
    for (std::size_t y = 0; y < static_cast<std::size_t>(part.height); ++y)
      std::copy_n(texels.data() + y * row, row, bytes_ + y * row_bytes());
    return Engine::get().submit([&](::vk::CommandBuffer commands) {
      move(commands, ::vk::ImageLayout::eUndefined);
      commands.copyBufferToImage(buffer_, image_, ::vk::ImageLayout::eGeneral, region());
      move(commands, ::vk::ImageLayout::eGeneral);
    });
  }
  Bytes read_image() {
    Engine& engine = Engine::get();
    engine.wait(engine.submit([&](::vk::CommandBuffer commands) {
      commands.copyImageToBuffer(image_, ::vk::ImageLayout::eGeneral, buffer_, region());
    }));
    return read_buffer();
  }
  Bytes read_buffer() const {
    Bytes texels;
    const std::size_t row = static_cast<std::size_t>(extent_.width) * bytes_per_pixel(format_);
    for (std::size_t y = 0; y < static_cast<std::size_t>(extent_.height); ++y)
      texels.insert(texels.end(), bytes_ + y * row_bytes(), bytes_ + y * row_bytes() + row);
    return texels;
  }

 private:
  ::vk::Format vk_format() const {
    switch (format_) {
      case PixelFormat::kR8:
        return ::vk::Format::eR8Unorm;
      case PixelFormat::kR32F:
        return is_depth_ ? ::vk::Format::eD32Sfloat : ::vk::Format::eR32Sfloat;
      case PixelFormat::kRG16F:
        return ::vk::Format::eR16G16Sfloat;
      case PixelFormat::kRGBA16F:
        return ::vk::Format::eR16G16B16A16Sfloat;
      default:
        return ::vk::Format::eR8G8B8A8Srgb;
    }
  }
  ::vk::ImageAspectFlags aspect() const {
    return is_depth_ ? ::vk::ImageAspectFlagBits::eDepth : ::vk::ImageAspectFlagBits::eColor;
  }
  std::size_t row_bytes() const { return row_texels_ * bytes_per_pixel(format_); }
  ::vk::BufferImageCopy region() const {
    return {.bufferOffset = kOffset,
            .bufferRowLength = row_texels_,
            .imageSubresource = {aspect(), 0, 0, 1},
            .imageExtent = {static_cast<std::uint32_t>(extent_.width),
                            static_cast<std::uint32_t>(extent_.height), 1}};
  }
  void move(::vk::CommandBuffer commands, ::vk::ImageLayout from) const {
    using Access = ::vk::AccessFlagBits;
    using Stage = ::vk::PipelineStageFlagBits;
    const ::vk::ImageMemoryBarrier barrier = {.srcAccessMask = Access::eMemoryRead | Access::eMemoryWrite,
                                              .dstAccessMask = Access::eMemoryRead | Access::eMemoryWrite,
                                              .oldLayout = from,
                                              .newLayout = ::vk::ImageLayout::eGeneral,
                                              .image = image_,
                                              .subresourceRange = {aspect(), 0, 1, 0, 1}};
    commands.pipelineBarrier(Stage::eAllCommands, Stage::eAllCommands, {}, {}, {}, barrier);
  }

  PixelFormat format_;
  Extent extent_;
  bool is_depth_;
  std::uint32_t row_texels_;
  ::vk::Image image_;
  ::vk::Buffer buffer_;
  ::vk::DeviceMemory memory_[2];
  std::uint8_t* bytes_ = nullptr;
};

class VulkanBridgeTest : public InteropTest {
 protected:
  void SetUp() override {
    InteropTest::SetUp();
    if (!Engine::exists()) QUINCUNX_SKIP("Vulkan has no device that OpenGL draws on");
  }

  void reopen() { device_ = std::make_unique<Device>(open_device(*context_, "", Interop::kCopy).value()); }

  std::unique_ptr<VulkanBridge> bridge(const BridgeSettings& settings) {
    auto made = VulkanBridge::create(Engine::get().context(), *device_, settings);
    EXPECT_TRUE(made.ok()) << made.status().message();
    return made.ok() ? std::move(made).value() : nullptr;
  }

  void carry_frames(bool buffers, const std::string& way);
};

// Frames of changing size arrive byte for byte, and so do pictures.
void VulkanBridgeTest::carry_frames(bool buffers, const std::string& way) {
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  const auto bridge = this->bridge(settings);
  ASSERT_NE(bridge, nullptr);
  EXPECT_TRUE(contains(bridge->reason(), way)) << bridge->reason();
  const std::vector<Plane> planes = planes_of(settings);
  std::vector<std::unique_ptr<EngineImage>> images;
  for (const Plane& plane : planes)
    images.push_back(std::make_unique<EngineImage>(plane.format, plane.kind == PlaneKind::kDepth, kTarget));
  EngineImage picture(settings.picture, false, kOutput);
  const auto given = [&](const EngineImage& image) { return buffers ? image.as_buffer() : image.as_image(); };

  std::optional<ImageView> previous;
  Bytes previous_texels;
  Extent previous_render;
  VulkanSemaphore done;
  for (int n = 0; n < kFrames; ++n) {
    const Extent render = {kTarget.width - 5 * (n % 9), 20 + 7 * (n % 8)};
    VulkanFrame frame;
    std::vector<Bytes> texels;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      texels.push_back(random_texels(planes[i].format, render,
                                     static_cast<std::uint32_t>(n) * 10 + static_cast<std::uint32_t>(i)));
      frame.drawn = images[i]->fill(texels[i], render);
    }
    frame.colour = given(*images[0]);
    frame.depth = given(*images[1]);
    frame.velocity = given(*images[2]);
    frame.reactive = given(*images[3]);
    frame.taken = {Engine::get().order, ++Engine::get().value};
    auto inputs = bridge->import(frame, render);
    ASSERT_TRUE(inputs.ok()) << inputs.status().message();
    for (std::size_t i = 0; i < planes.size(); ++i)
      EXPECT_TRUE(download(view_of(*inputs, planes[i].kind), render) == texels[i])
          << "frame " << n << ", plane " << i;
    if (previous) {
      EXPECT_TRUE(download(*previous, previous_render) == previous_texels) << "history of frame " << n;
    }
    previous = inputs->colour;
    previous_texels = texels[0];
    previous_render = render;

    const auto output = bridge->begin_present();
    ASSERT_TRUE(output.ok()) << output.status().message();
    const Bytes made = random_texels(settings.picture, kOutput, static_cast<std::uint32_t>(n) + 7);
    upload(*output, made);
    const VulkanSemaphore free = done;
    done = {Engine::get().order, ++Engine::get().value};
    ASSERT_TRUE(bridge->present(given(picture), free, done).ok());
    Engine::get().wait(done);
    EXPECT_TRUE((buffers ? picture.read_buffer() : picture.read_image()) == made) << "picture " << n;
  }
}

TEST_F(VulkanBridgeTest, ImagesArriveByteForByte) {
  carry_frames(false, "as a probe has shown");
}

TEST_F(VulkanBridgeTest, BuffersArriveByteForByte) {
  carry_frames(true, "as a probe has shown");
}

TEST_F(VulkanBridgeTest, BadCallsAreNamed) {
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  const auto refused = [&](VulkanContext context, BridgeSettings wanted) {
    const auto made = VulkanBridge::create(context, *device_, wanted);
    EXPECT_FALSE(made.ok());
    EXPECT_EQ(made.status().code(), StatusCode::kInvalidArgument);
    return made.status().message();
  };
  VulkanContext no_queue = Engine::get().context();
  no_queue.queue = nullptr;
  EXPECT_TRUE(contains(refused(no_queue, settings), "a handle of the context is null"));
  BridgeSettings wrong = settings;
  wrong.slots = 1;
  EXPECT_TRUE(contains(refused(Engine::get().context(), wrong), "slots is 1 and must be 2 to 16"));
  wrong = settings;
  wrong.targets = Targets::kPlaced;
  EXPECT_TRUE(contains(refused(Engine::get().context(), wrong), "targets must be kViewport"));

  const auto bridge = this->bridge(settings);
  EngineImage colour(settings.colour, false, kTarget), depth(PixelFormat::kR32F, true, kTarget);
  VulkanFrame frame = {.colour = colour.as_image(), .depth = depth.as_image(), .velocity = colour.as_image()};
  const auto imported = bridge->import(frame, {kTarget.width + 1, 4});
  ASSERT_FALSE(imported.ok());
  const std::string message = imported.status().message();
  EXPECT_TRUE(contains(message, "the render extent is 97x4 and must lie within 1x1 and the target's 96x80"))
      << message;
  EXPECT_TRUE(contains(message, "velocity has VkFormat 97 and must have 83, with texels of RG16F"))
      << message;
  EXPECT_TRUE(contains(message, "reactive is missing; give an image or a buffer")) << message;
  EXPECT_FALSE(contains(message, "colour")) << message;
  frame.colour.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  EXPECT_TRUE(contains(bridge->import(frame, kTarget).status().message(), "colour has the layout UNDEFINED"));
  EXPECT_TRUE(contains(bridge->present(colour.as_image()).message(), "no picture was begun"));
  ASSERT_TRUE(bridge->begin_present().ok());
  EXPECT_TRUE(contains(bridge->present(colour.as_image()).message(),
                       "picture has VkFormat 97 and must have 37 or 43"));
}

// Stands before Vulkan's function where a test is in a hurry.
bool is_hurried = false;
VkResult wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                         std::uint64_t ns) {
  EXPECT_LE(ns, 30'000'000'000u) << "a wait that may never end";
  return VULKAN_HPP_DEFAULT_DISPATCHER.vkWaitForFences(device, count, fences, all,
                                                       is_hurried ? 200'000'000 : ns);
}
PFN_vkVoidFunction device_function(VkDevice device, const char* name) {
  return std::strcmp(name, "vkWaitForFences") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&wait_for_fences)
             : VULKAN_HPP_DEFAULT_DISPATCHER.vkGetDeviceProcAddr(device, name);
}
PFN_vkVoidFunction instance_function(VkInstance instance, const char* name) {
  return std::strcmp(name, "vkGetDeviceProcAddr") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&device_function)
             : VULKAN_HPP_DEFAULT_DISPATCHER.vkGetInstanceProcAddr(instance, name);
}

TEST_F(VulkanBridgeTest, ASemaphoreThatIsNeverSignalledEndsInWords) {
  BridgeSettings settings = all_planes(kTarget, kOutput);
  settings.depth = settings.velocity = settings.reactive = false;
  VulkanContext context = Engine::get().context();
  context.get_instance_proc_addr = instance_function;
  const auto bridge = VulkanBridge::create(context, *device_, settings).value();
  EngineImage colour(settings.colour, false, kTarget);
  const Bytes texels = random_texels(settings.colour, kTarget, 1);
  Engine::get().wait(colour.fill(texels, kTarget));
  const std::uint64_t never = ++Engine::get().value;
  const VulkanFrame frame = {.colour = colour.as_image(), .drawn = {Engine::get().order, never}};
  is_hurried = true;
  Status status;
  for (int i = 0; i < 4 && status.ok(); ++i)  // at the latest where a slot is needed again
    status = bridge->import(frame, kTarget).status();
  is_hurried = false;
  EXPECT_EQ(status.code(), StatusCode::kDeviceFailure);
  EXPECT_TRUE(contains(status.message(), "VulkanFrame::drawn, may never have been signalled"))
      << status.message();
  Engine::get().device.signalSemaphore(
      ::vk::SemaphoreSignalInfo{.semaphore = Engine::get().order, .value = never});
  const auto inputs = bridge->import(frame, kTarget);
  ASSERT_TRUE(inputs.ok()) << inputs.status().message();
  EXPECT_TRUE(download(inputs->colour, kTarget) == texels) << "it arrived after all";
}

// The same by fds, on a driver of its own memory, with and without semaphores.
TEST_F(VulkanBridgeTest, ImportedMemoryHasTheSameBytes) {
  if (device_->info().kind != DeviceKind::kCpu) QUINCUNX_SKIP("the stand-in is a processor's OpenCL");
  if (!PretendSemaphores::works()) QUINCUNX_SKIP("this build has no stand-in for Vulkan's loader");
  const PretendSeparateMemory separate;
  const PretendImports driver;
  reopen();
  carry_frames(false, "the same memory, ordered by semaphores");
  carry_frames(true, "the same memory, ordered by semaphores");
}

TEST_F(VulkanBridgeTest, ADriverThatCannotBeTrustedIsRefused) {
  if (device_->info().kind != DeviceKind::kCpu) QUINCUNX_SKIP("the stand-in is a processor's OpenCL");
  const PretendSeparateMemory separate;
  using Flaw = PretendImports::Flaw;
  for (const auto& [flaw, clue] : {std::pair{Flaw::kWrongBytes, "OpenCL read other bytes than Vulkan wrote"},
                                   std::pair{Flaw::kRefuses, "clCreateBufferWithProperties"},
                                   std::pair{Flaw::kWrongUuid, "import it where it was allocated"}}) {
    const PretendImports driver(flaw);
    reopen();
    const auto made = VulkanBridge::create(Engine::get().context(), *device_, all_planes(kTarget, kOutput));
    ASSERT_FALSE(made.ok()) << clue;
    EXPECT_EQ(made.status().code(), StatusCode::kUnsupported);
    EXPECT_TRUE(contains(made.status().message(), clue)) << made.status().message();
  }
}

}  // namespace
}  // namespace quincunx::gl::testing
#endif
