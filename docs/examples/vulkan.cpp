// SPDX-License-Identifier: MIT
// Quincunx in a Vulkan engine: turning cubes, without a window; your images, your queue, a timeline semaphore.
//
//   vulkan FRAMES PICTURE.ppm SCALE METHOD   by temporal or bilinear; the last frame as a file
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <quincunx/resolve_service.h>
#include <quincunx_gl/vulkan_bridge.h>
#include <vulkan/vulkan.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using namespace quincunx;

constexpr Extent kOutput = {960, 540};
constexpr Extent kTarget = {2 * kOutput.width, 2 * kOutput.height};  // for scales up to 2
constexpr float kStep = 1.0f / 60;                              // seconds of the scene from frame to frame
constexpr vk::ImageLayout kLayout = vk::ImageLayout::eGeneral;  // of all images, for good

// glslangValidator -V -x -o vulkan.vert.spv vulkan.vert, and so the other
constexpr std::uint32_t kVertex[] = {
#include "vulkan.vert.spv"
};
constexpr std::uint32_t kFragment[] = {
#include "vulkan.frag.spv"
};

struct Push {
  Vec2 jitter;  // as a part of the viewport, +y down
  float time, time_before;
};

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}
template <typename T>
T get(Result<T> result) {
  if (!result.ok()) fail(result.status().message());
  return std::move(result).value();
}

// Your engine's: an instance, a device and its queue.
struct Vulkan {
  vk::Instance instance;
  vk::PhysicalDevice physical;
  vk::Device device;
  vk::Queue queue;

  explicit Vulkan(const DeviceUuid& uuid) {
    const vk::ApplicationInfo application = {.apiVersion = VK_API_VERSION_1_3};
    instance = vk::createInstance({.pApplicationInfo = &application});
    const std::vector<vk::PhysicalDevice> all = instance.enumeratePhysicalDevices();
    if (all.empty()) fail("Vulkan finds no device");
    physical = all.front();
    for (const vk::PhysicalDevice one : all) {
      const auto chain = one.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
      const auto& its = chain.get<vk::PhysicalDeviceIDProperties>().deviceUUID;
      if (std::equal(uuid.begin(), uuid.end(), its.begin())) physical = one;  // OpenCL's
    }

    // The bridge needs the first of these, and the second where there is one.
    std::vector<const char*> extensions = {"VK_KHR_external_memory_fd"};
    for (const auto& offered : physical.enumerateDeviceExtensionProperties()) {
      if (std::string(offered.extensionName.data()) == "VK_KHR_external_semaphore_fd")
        extensions.push_back("VK_KHR_external_semaphore_fd");
    }
    vk::PhysicalDeviceVulkan13Features rendering = {.dynamicRendering = VK_TRUE};
    vk::PhysicalDeviceVulkan12Features timeline = {.pNext = &rendering, .timelineSemaphore = VK_TRUE};
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queues = {.queueCount = 1, .pQueuePriorities = &priority};  // of family 0
    device = physical.createDevice({.pNext = &timeline,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queues,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()});
    queue = device.getQueue(0, 0);
  }

  vk::DeviceMemory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags flags) const {
    const auto memory = physical.getMemoryProperties();
    std::uint32_t type = 0;
    while (type < memory.memoryTypeCount && ((needs.memoryTypeBits >> type & 1) == 0 ||
                                             (memory.memoryTypes[type].propertyFlags & flags) != flags))
      ++type;
    return device.allocateMemory({.allocationSize = needs.size, .memoryTypeIndex = type});
  }
};

struct Target {
  vk::Format format = {};
  vk::ImageAspectFlags aspect = {};
  vk::Image image = {};
  vk::ImageView view = {};
};

Target make_target(const Vulkan& vulkan, vk::Format format, vk::ImageUsageFlags usage) {
  const bool is_depth = format == vk::Format::eD32Sfloat;
  Target made = {.format = format,
                 .aspect = is_depth ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor};
  made.image = vulkan.device.createImage({.imageType = vk::ImageType::e2D,
                                          .format = format,
                                          .extent = {kTarget.width, kTarget.height, 1},
                                          .mipLevels = 1,
                                          .arrayLayers = 1,
                                          .usage = usage | vk::ImageUsageFlagBits::eTransferSrc});
  const auto memory = vulkan.allocate(vulkan.device.getImageMemoryRequirements(made.image),
                                      vk::MemoryPropertyFlagBits::eDeviceLocal);
  vulkan.device.bindImageMemory(made.image, memory, 0);
  made.view = vulkan.device.createImageView({.image = made.image,
                                             .viewType = vk::ImageViewType::e2D,
                                             .format = format,
                                             .subresourceRange = {made.aspect, 0, 1, 0, 1}});
  return made;
}

vk::Pipeline make_pipeline(const Vulkan& vulkan, vk::PipelineLayout layout) {
  using Stage = vk::ShaderStageFlagBits;
  const auto shader = [&](const auto& words) {
    return vulkan.device.createShaderModule({.codeSize = sizeof(words), .pCode = words});
  };
  const std::array<vk::PipelineShaderStageCreateInfo, 2> stages = {
      {{.stage = Stage::eVertex, .module = shader(kVertex), .pName = "main"},
       {.stage = Stage::eFragment, .module = shader(kFragment), .pName = "main"}}};
  const vk::PipelineVertexInputStateCreateInfo no_vertices;
  constexpr auto kTriangles = vk::PrimitiveTopology::eTriangleList;
  const vk::PipelineInputAssemblyStateCreateInfo triangles = {.topology = kTriangles};
  const vk::PipelineViewportStateCreateInfo viewports = {.viewportCount = 1, .scissorCount = 1};
  const vk::PipelineRasterizationStateCreateInfo raster = {.lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo samples;
  const vk::PipelineDepthStencilStateCreateInfo depth = {
      .depthTestEnable = VK_TRUE, .depthWriteEnable = VK_TRUE, .depthCompareOp = vk::CompareOp::eGreater};
  const vk::PipelineColorBlendAttachmentState plain = {.colorWriteMask = vk::ColorComponentFlags(15)};  // all
  const std::array both = {plain, plain};
  const vk::PipelineColorBlendStateCreateInfo blend = {.attachmentCount = 2, .pAttachments = both.data()};
  const std::array changing = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic = {.dynamicStateCount = 2,
                                                      .pDynamicStates = changing.data()};
  const std::array formats = {vk::Format::eR16G16B16A16Sfloat, vk::Format::eR16G16Sfloat};
  const vk::PipelineRenderingCreateInfo targets = {.colorAttachmentCount = 2,
                                                   .pColorAttachmentFormats = formats.data(),
                                                   .depthAttachmentFormat = vk::Format::eD32Sfloat};
  return vulkan.device
      .createGraphicsPipeline({}, {.pNext = &targets,
                                   .stageCount = 2,
                                   .pStages = stages.data(),
                                   .pVertexInputState = &no_vertices,
                                   .pInputAssemblyState = &triangles,
                                   .pViewportState = &viewports,
                                   .pRasterizationState = &raster,
                                   .pMultisampleState = &samples,
                                   .pDepthStencilState = &depth,
                                   .pColorBlendState = &blend,
                                   .pDynamicState = &dynamic,
                                   .layout = layout})
      .value;
}

// Records a frame: colour, velocity and depth, in the upper left part of the targets.
void draw(vk::CommandBuffer commands, const std::array<Target, 3>& targets, vk::Pipeline pipeline,
          vk::PipelineLayout layout, Extent render, const Push& push, bool is_first) {
  std::array<vk::RenderingAttachmentInfo, 3> attachments;
  for (std::size_t i = 0; i < 3; ++i) {
    using Stage = vk::PipelineStageFlagBits;
    const vk::ImageMemoryBarrier barrier = {
        .dstAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite,
        .oldLayout = is_first ? vk::ImageLayout::eUndefined : kLayout,
        .newLayout = kLayout,
        .image = targets[i].image,
        .subresourceRange = {targets[i].aspect, 0, 1, 0, 1}};
    commands.pipelineBarrier(Stage::eAllCommands, Stage::eAllCommands, {}, {}, {}, barrier);
    attachments[i] = {.imageView = targets[i].view,
                      .imageLayout = kLayout,
                      .loadOp = vk::AttachmentLoadOp::eClear,
                      .storeOp = vk::AttachmentStoreOp::eStore};
  }
  attachments[0].clearValue.color = {std::array{0.02f, 0.03f, 0.06f, 1.f}};
  const vk::Rect2D area = {
      {}, {static_cast<std::uint32_t>(render.width), static_cast<std::uint32_t>(render.height)}};
  commands.beginRendering({.renderArea = area,
                           .layerCount = 1,
                           .colorAttachmentCount = 2,
                           .pColorAttachments = attachments.data(),
                           .pDepthAttachment = &attachments[2]});
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
  const auto width = static_cast<float>(render.width), height = static_cast<float>(render.height);
  commands.setViewport(0, vk::Viewport{0, 0, width, height, 0, 1});
  commands.setScissor(0, area);
  commands.pushConstants<Push>(layout, vk::ShaderStageFlagBits::eVertex, 0, push);
  commands.draw(36, 35, 0, 0);
  commands.endRendering();
}

int main(int argc, char** argv) {
  if (argc != 5) fail("Usage: vulkan FRAMES PICTURE.ppm SCALE METHOD");
  const auto frames = static_cast<std::uint64_t>(std::atoll(argv[1]));
  const double scale = std::atof(argv[3]);
  // What makes the picture.
  const Device opencl = get(Device::open());
  ResolveSettings settings;
  settings.output_extent = kOutput;
  settings.target_extent = kTarget;
  if (argv[4] == std::string("bilinear")) settings.method = Method::kBilinear;
  const ResolvePlan plan = get(plan_for({.transparents = false}, settings));
  auto service = get(ResolveService::create(opencl, plan));

  const Vulkan vulkan(opencl.info().uuid);
  const auto bridge = get(gl::VulkanBridge::create({.get_instance_proc_addr = vkGetInstanceProcAddr,
                                                    .instance = vulkan.instance,
                                                    .physical_device = vulkan.physical,
                                                    .device = vulkan.device,
                                                    .queue = vulkan.queue},
                                                   opencl, gl::bridge_settings(plan)));
  std::printf("%s\n", bridge->reason().c_str());

  // The engine's own: targets of the largest viewport, and a pipeline.
  using Usage = vk::ImageUsageFlagBits;
  const std::array targets = {make_target(vulkan, vk::Format::eR16G16B16A16Sfloat, Usage::eColorAttachment),
                              make_target(vulkan, vk::Format::eR16G16Sfloat, Usage::eColorAttachment),
                              make_target(vulkan, vk::Format::eD32Sfloat, Usage::eDepthStencilAttachment)};
  // The picture: an image of yours, or, as here, a buffer that the host can read.
  const auto texels = static_cast<std::size_t>(kOutput.area());
  const auto picture =
      vulkan.device.createBuffer({.size = 4 * texels, .usage = vk::BufferUsageFlagBits::eTransferDst});
  const auto memory =
      vulkan.allocate(vulkan.device.getBufferMemoryRequirements(picture),
                      vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
  vulkan.device.bindBufferMemory(picture, memory, 0);
  const auto* const codes = static_cast<const char*>(vulkan.device.mapMemory(memory, 0, 4 * texels));
  const vk::PushConstantRange range = {vk::ShaderStageFlagBits::eVertex, 0, sizeof(Push)};
  const auto layout =
      vulkan.device.createPipelineLayout({.pushConstantRangeCount = 1, .pPushConstantRanges = &range});
  const vk::Pipeline pipeline = make_pipeline(vulkan, layout);
  const auto pool =
      vulkan.device.createCommandPool({.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer});
  const auto commands =
      vulkan.device.allocateCommandBuffers({.commandPool = pool, .commandBufferCount = 1}).front();
  const vk::SemaphoreTypeCreateInfo timeline = {.semaphoreType = vk::SemaphoreType::eTimeline};
  const auto order = vulkan.device.createSemaphore({.pNext = &timeline});
  const auto wait_until = [&](std::uint64_t value) {
    const auto all = vk::SemaphoreWaitInfo{.semaphoreCount = 1, .pSemaphores = &order, .pValues = &value};
    if (vulkan.device.waitSemaphores(all, UINT64_MAX) != vk::Result::eSuccess) fail("no frame came");
  };
  const auto handed = [](const Target& target) {
    return gl::VulkanImage{.image = target.image,
                           .layout = static_cast<VkImageLayout>(kLayout),
                           .format = static_cast<VkFormat>(target.format)};
  };

  // Frame n is drawn at the semaphore's value 2n + 1 and shown at 2n + 2.
  const Extent render = {static_cast<int>(scale * kOutput.width), static_cast<int>(scale * kOutput.height)};
  for (std::uint64_t n = 0; n < frames; ++n) {
    const std::uint64_t drawn = 2 * n + 1, shown = 2 * n + 2;
    wait_until(2 * n);  // one command buffer
    const Vec2 offset = uses_earlier_frames(settings.method) ? jitter(n, render, kOutput) : Vec2();
    const Vec2 part = {offset.x / static_cast<float>(render.width),
                       offset.y / static_cast<float>(render.height)};
    const float time = kStep * static_cast<float>(n);
    commands.begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    draw(commands, targets, pipeline, layout, render, {part, time, time - kStep}, n == 0);
    commands.end();
    const vk::TimelineSemaphoreSubmitInfo values = {.signalSemaphoreValueCount = 1,
                                                    .pSignalSemaphoreValues = &drawn};
    vulkan.queue.submit(vk::SubmitInfo{.pNext = &values,
                                       .commandBufferCount = 1,
                                       .pCommandBuffers = &commands,
                                       .signalSemaphoreCount = 1,
                                       .pSignalSemaphores = &order});

    const gl::SharedFrame inputs = get(bridge->import({.colour = handed(targets[0]),
                                                       .depth = handed(targets[2]),
                                                       .velocity = handed(targets[1]),
                                                       .drawn = {order, drawn}},
                                                      render));
    const FrameReport report = service.dispatch({.colour = inputs.colour,
                                                 .depth = inputs.depth,
                                                 .velocity = inputs.velocity,
                                                 .render_extent = render,
                                                 .jitter = offset},
                                                {.presented = get(bridge->begin_present())});
    if (!report.ok()) fail(report.status.message());
    const Status status =
        bridge->present({.format = VK_FORMAT_R8G8B8A8_UNORM, .buffer = picture}, {}, {order, shown});
    if (!status.ok()) fail(status.message());
  }

  wait_until(2 * frames);
  std::ofstream file(argv[2], std::ios::binary);
  file << "P6 " << kOutput.width << ' ' << kOutput.height << " 255\n";
  for (std::size_t i = 0; i < texels; ++i)
    file.write(codes + 4 * i, 3);
  return 0;
}
