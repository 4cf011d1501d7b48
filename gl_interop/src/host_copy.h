// SPDX-License-Identifier: MIT
// HostCopy: the bridge by pixel buffers: through host memory for every pair of drivers, or through memory that both
// have imported.
//
// submit() has GL read the viewport's rectangle of each plane into the slot's pixel buffer, behind a fence;
// acquire() waits for that fence, unless the device itself keeps the order, and hands the buffer to OpenCL. The pixel
// buffers are the ring: all slots are drawn in one framebuffer, because GL itself keeps its reads before the next
// frame's writes.
//
// With placed targets the slots are parts of one allocation, and framebuffer and images have the viewport's size: made
// again in begin_draw(), when OpenCL has given the slot back, and only where the size is another.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "caller_texture.h"
#include "fence.h"
#include "frame_layout.h"
#include "pixel_buffer.h"
#include "quincunx_gl/bridge.h"
#include "quincunx_gl/render_targets.h"
#include "slot_ring.h"
#include "texel_copy.h"

namespace quincunx::gl {

// Render targets of the sizes that were asked for most recently.
//
// OpenGL has no memory in which textures could be placed (but what Vulkan allocates), so that targets of exactly a
// viewport's size have to be made. Those of sizes that come back are kept, as long as all of them together have no
// more texels than two of the largest size: as many as a double-buffered allocation would have.
class TargetPool {
 public:
  // `largest.target_extent` is the largest size that at() will be asked for. Makes nothing yet.
  explicit TargetPool(const TargetNeeds& largest);

  // Targets of this size, valid until the next call. Throws InteropError where they cannot be made.
  const RenderTargets& at(Extent extent);

  std::uint64_t bytes() const;  // sum over all that are kept

 private:
  void make_room(Extent extent);

  TargetNeeds needs_;
  std::int64_t most_texels_;
  std::vector<std::unique_ptr<RenderTargets>> kept_;  // the most recently used last
};

// The form of placed images: buffers, or images made on them (cl_khr_image2d_from_buffer).
struct PlacedForm {
  Storage storage = Storage::kBuffer;
  int row_texels = 1;  // rows start at multiples of so many texels
};

// Chooses images on a device that can make them and gains by them, else buffers.
PlacedForm placed_form_for(const DeviceInfo& device);

// The images of one slot, in its part of the memory that GL and OpenCL use together.
class SlotImages {
 public:
  // In `pixels`, which outlives this object. Throws InteropError.
  SlotImages(const Device& device, const std::vector<Plane>& planes, const FrameLayout& layout,
             const PlacedForm& form, const PixelBuffer& pixels);

  // Makes placed images of this size, at most the layout's; nothing where they have it. OpenCL uses them no more.
  void resize(Extent render);

  Extent extent() const { return views_.colour.extent; }
  const SharedFrame& views() const { return views_; }      // for OpenCL
  const SharedFrame& regions() const { return regions_; }  // regions of the pixel buffer, for copies

 private:
  struct Surface {  // for form.storage kImage
    ClMem region;
    ClMem image;
  };

  Device device_;
  std::vector<Plane> planes_;
  PlacedForm form_;
  SharedFrame regions_;
  SharedFrame views_;
  std::vector<Surface> surfaces_;  // one for each plane
};

class HostCopy final : public Bridge {
 public:
  // `settings` are checked by Bridge::create(); `exporter` for kShared. Throws InteropError or std::runtime_error.
  HostCopy(const Device& device, const BridgeSettings& settings, std::string reason, Transfer transfer,
           const PlacedForm& form = {}, const Exporter* exporter = nullptr);
  ~HostCopy() override;

  Interop kind() const override {
    return output_.transfer() == Transfer::kShared ? Interop::kExternal : Interop::kCopy;
  }
  Storage storage() const override { return form_.storage; }
  Memory memory() const override;
  Result<const RenderTargets*> begin_draw(int slot, Extent render) override;
  Status submit(int slot) override;
  Status submit(int slot, const FrameTextures& textures, Extent render) override;
  Result<SharedFrame> acquire(int slot) override;
  Result<ImageView> begin_present() override;
  Status present(GLuint into = 0) override;
  GLuint presented_texture() const override { return presented_.get(); }
  const std::uint8_t* presented_pixels() override;

 private:
  struct Slot {
    PixelBuffer pixels;
    SlotImages images;
    Fence read_back;
  };

  Slot& slot_at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  void make_slots(Transfer transfer, const Exporter* exporter);
  Status take_back(const char* call, int slot);
  void resize(Slot& slot, Extent render);
  void read_back(Slot& slot, const FrameTextures& from, Extent render);
  void hand_over(Slot& slot, Extent render);
  void prepare_shaders();
  const TexelCopy* shader_of(TextureFacts& facts, GLuint texture, const Plane& plane,
                             TexelCopy::Direction direction);

  Device device_;
  std::vector<Plane> planes_;
  PlacedForm form_;
  TargetPool pool_;
  const RenderTargets* targets_ = nullptr;  // that are drawn or were drawn last; none with imports
  Framebuffer reader_;                      // through which textures are read
  DepthReader depth_reader_;
  // Copies of the planes, and of the picture, by shaders; none: by transfers of pixels. Those of imported textures
  // are kept with what is known of them.
  std::vector<TexelCopy> plane_copies_;
  std::optional<TexelCopy> picture_copy_;
  SlotRing ring_;
  std::vector<Slot> slots_;
  PixelBuffer output_;
  ImageView output_view_;
  Texture presented_;
  Fence uploaded_;
  BufferReader reader_of_output_;
  const std::uint8_t* pixels_ = nullptr;  // what it read of the current picture
  bool presenting_ = false;
};

}  // namespace quincunx::gl
