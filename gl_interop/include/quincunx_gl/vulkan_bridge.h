// SPDX-License-Identifier: MIT
// VulkanBridge: carries frames that Vulkan drew to OpenCL, and the picture that OpenCL made back to Vulkan.
//
//   draw, signal `drawn`
//   inputs = bridge->import({.colour = {...}, .drawn = {drawn}}, render)
//   output = bridge->begin_present()
//   service.dispatch(inputs, output)
//   bridge->present({picture}, {}, {done}), and wait for `done` before the picture is used
//
// Vulkan copies images into memory on the device that both APIs share, or into host memory if OpenCL runs on the CPU.
// So drivers need not agree on rows and tiling. Semaphores order the two; if OpenCL imports none, the host waits.
//
// It needs a Vulkan 1.1 device made with VK_KHR_external_memory_fd, and with VK_KHR_external_semaphore_fd if it has
// that. The caller's objects outlive the bridge. Calls come from one thread at a time. They submit to the Vulkan queue,
// which nobody else uses meanwhile, and use OpenCL's queue. They return kDeviceFailure if a copy is not done in 30 s,
// because its semaphore was never signalled, for example. Built where Vulkan's headers are installed.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <string>

#include "quincunx_gl/bridge.h"

namespace quincunx::gl {

struct VulkanContext {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  VkInstance instance = nullptr;
  VkPhysicalDevice physical_device = nullptr;
  VkDevice device = nullptr;
  VkQueue queue = nullptr;  // of graphics, compute or transfers; transfers cannot copy depth images
  std::uint32_t queue_family = 0;
};

// An image of one sample and one level, usable for transfers, at least as large as the viewport or picture, which
// begins at texel (0, 0); or a buffer with such texels.
struct VulkanImage {
  VkImage image = VK_NULL_HANDLE;
  VkImageLayout layout =
      VK_IMAGE_LAYOUT_GENERAL;            // before and after; of a picture after: what it held is lost
  VkFormat format = VK_FORMAT_UNDEFINED;  // as PixelFormat names it; depth D32 or R32; RGBA8 UNORM or SRGB
  VkBuffer buffer = VK_NULL_HANDLE;       // in place of an image
  VkDeviceSize offset = 0;
  std::uint32_t row_texels = 0;  // texels from one row of a buffer to the next; 0: the viewport's width
};

struct VulkanSemaphore {
  VkSemaphore semaphore = VK_NULL_HANDLE;  // none: the order is the queue's
  std::uint64_t value = 0;                 // of a timeline; binary ones have none
};

// Only the images that the settings ask for are read.
struct VulkanFrame {
  VulkanImage colour = {};
  VulkanImage depth = {};
  VulkanImage velocity = {};
  VulkanImage reactive = {};
  VulkanSemaphore drawn = {};  // waited for before the images are read
  VulkanSemaphore taken = {};  // signalled when they have been read; later work on the same queue needs none
};

class QUINCUNX_API VulkanBridge {
 public:
  // `settings`: bridge_settings(plan). Fields that concern only OpenGL (interop, imports, restores_state, checkerboard)
  // are ignored, and targets must be kViewport. A test pattern must pass both ways first. Errors: kInvalidArgument,
  // kUnsupported if OpenCL neither imports the device's memory nor uses the host's.
  static Result<std::unique_ptr<VulkanBridge>> create(const VulkanContext& context, const Device& device,
                                                      const BridgeSettings& settings);
  ~VulkanBridge();  // waits for the copies, and for OpenCL
  VulkanBridge(const VulkanBridge&) = delete;
  VulkanBridge& operator=(const VulkanBridge&) = delete;

  const std::string& reason() const;  // one sentence: how it works here

  // Takes a frame, which is copied in the queue's order. The views are valid until `slots` frames later; commands that
  // are enqueued on OpenCL's queue afterwards see the frame. Errors: kInvalidArgument, which names each image that is
  // wrong: nothing was submitted then.
  Result<SharedFrame> import(const VulkanFrame& frame, Extent render);

  // Returns the target of FrameOutputs::presented, or of the linear picture; the same view each time.
  Result<ImageView> begin_present();
  // Copies the picture, whose dispatch was enqueued before, to `picture`: waits for `free` before writing it, and
  // signals `done` afterwards.
  Status present(const VulkanImage& picture, const VulkanSemaphore& free = {},
                 const VulkanSemaphore& done = {});

 private:
  struct QUINCUNX_HIDDEN Impl;
  explicit VulkanBridge(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::gl
