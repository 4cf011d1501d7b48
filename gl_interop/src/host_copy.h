// SPDX-License-Identifier: MIT
// HostCopy: the bridge for every pair of drivers. Pixels travel through host memory.
//
// submit() has GL read the viewport's rectangle of each plane into the slot's pixel buffer, behind a fence;
// acquire() waits for that fence and hands the buffer to OpenCL. The pixel buffers are the ring: all slots
// are drawn in one framebuffer, because GL itself keeps its reads before the next frame's writes.
//
// With placed targets the slots are parts of one allocation, and framebuffer and images have the viewport's size: made
// again in begin_draw(), when OpenCL has given the slot back, and only where the size is another.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_reader.h"
#include "fence.h"
#include "pixel_buffer.h"
#include "plane.h"
#include "quincunx_gl/bridge.h"
#include "slot_images.h"
#include "slot_ring.h"
#include "target_pool.h"

namespace quincunx::gl {

class HostCopy final : public Bridge {
 public:
  // `settings` are checked by Bridge::create(). Throws InteropError or std::runtime_error.
  HostCopy(const Device& device, const BridgeSettings& settings, std::string reason, Transfer transfer,
           const PlacedForm& form = {});
  ~HostCopy() override;

  Interop kind() const override { return Interop::kCopy; }
  Storage storage() const override { return form_.storage; }
  Memory memory() const override;
  Result<const RenderTargets*> begin_draw(int slot, Extent render) override;
  Status submit(int slot) override;
  Result<SharedFrame> acquire(int slot) override;
  Result<ImageView> begin_present() override;
  Status present() override;
  GLuint presented_texture() const override { return presented_.get(); }
  const std::uint8_t* presented_pixels() override { return output_.bytes(); }

 private:
  struct Slot {
    PixelBuffer pixels;
    SlotImages images;
    Fence read_back;
  };

  Slot& slot_at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  void make_slots(Transfer transfer);
  void resize(Slot& slot, Extent render);
  void read_back(Slot& slot, Extent render);
  void hand_over(Slot& slot, Extent render);

  Device device_;
  std::vector<Plane> planes_;
  PlacedForm form_;
  TargetPool pool_;
  const RenderTargets* targets_;  // that are drawn or were drawn last
  DepthReader depth_reader_;
  SlotRing ring_;
  std::vector<Slot> slots_;
  PixelBuffer output_;
  ImageView output_view_;
  Texture presented_;
  Fence uploaded_;
  bool presenting_ = false;
};

}  // namespace quincunx::gl
