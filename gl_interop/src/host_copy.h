// SPDX-License-Identifier: MIT
// HostCopy: the bridge for every pair of drivers. Pixels travel through host memory.
//
// submit() has GL read the viewport's rectangle of each plane into the slot's pixel buffer, behind a fence;
// acquire() waits for that fence and hands the buffer to OpenCL. The pixel buffers are the ring: all slots
// are drawn in one framebuffer, because GL itself keeps its reads before the next frame's writes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fence.h"
#include "pixel_buffer.h"
#include "plane.h"
#include "quincunx_gl/bridge.h"
#include "slot_ring.h"

namespace quincunx::gl {

class HostCopy final : public Bridge {
 public:
  // `settings` are checked by Bridge::create(). Throws InteropError or std::runtime_error.
  HostCopy(const Device& device, const BridgeSettings& settings, std::string reason, Transfer transfer);
  ~HostCopy() override;

  Interop kind() const override { return Interop::kCopy; }
  Result<const RenderTargets*> begin_draw(int slot) override;
  Status submit(int slot, Extent render) override;
  Result<SharedFrame> acquire(int slot) override;
  Result<ImageView> begin_present() override;
  Status present() override;
  GLuint presented_texture() const override { return presented_.get(); }
  const std::uint8_t* presented_pixels() override { return output_.bytes(); }

 private:
  struct Slot {
    PixelBuffer pixels;
    SharedFrame views;
    Fence read_back;
  };

  Slot& slot_at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  Slot make_slot(Transfer transfer);
  void read_back(Slot& slot, Extent render);
  void hand_over(Slot& slot, Extent render);

  Device device_;
  std::vector<Plane> planes_;
  RenderTargets targets_;
  SlotRing ring_;
  std::vector<Slot> slots_;
  PixelBuffer output_;
  ImageView output_view_;
  Texture presented_;
  Fence uploaded_;
  bool presenting_ = false;
};

}  // namespace quincunx::gl
