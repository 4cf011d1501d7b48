// SPDX-License-Identifier: MIT
// GlSharing: the bridge where one driver serves both sides. Textures are handed over, no pixel moves.
//
// Rests on cl_khr_gl_sharing. A depth texture would reach OpenCL as another image type, and only with
// cl_khr_gl_depth_images; a compute shader copies the viewport's part of it to R32F instead, on every driver
// alike. Where cl_khr_gl_event is missing, glFinish() comes before OpenCL takes textures, and the release is
// waited for before GL takes them back.
#pragma once

#include <epoxy/gl.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cl_handle.h"
#include "frame_layout.h"
#include "quincunx/device.h"
#include "quincunx_gl/bridge.h"
#include "slot_ring.h"
#include "texel_copy.h"

namespace quincunx::gl {

// GL textures that OpenCL knows as images, and which side owns them: a set that changes sides together. GL owns them
// first. Where OpenCL still owns them at the end, the destructor gives them back. All functions throw InteropError.
class SharedTextures {
 public:
  explicit SharedTextures(const Device& device);
  ~SharedTextures();
  SharedTextures(SharedTextures&& other) noexcept;
  SharedTextures& operator=(SharedTextures&&) = delete;
  SharedTextures(const SharedTextures&) = delete;
  SharedTextures& operator=(const SharedTextures&) = delete;

  // The image of a complete GL_TEXTURE_2D, which must outlive this object. `format` is what OpenCL must see
  // in it.
  cl_mem add(GLuint texture, PixelFormat format, cl_mem_flags flags);

  // Enqueues the change to OpenCL, after what GL was told to do so far.
  void acquire();
  // Enqueues the change to GL, after what OpenCL was told to do so far.
  void release();
  // Before GL touches the textures again: waits for release() where the driver does not order the two itself.
  void wait_for_release();

  bool acquired() const { return acquired_; }

 private:
  Device device_;
  bool driver_synchronises_;  // cl_khr_gl_event
  std::vector<ClMem> images_;
  std::vector<cl_mem> raw_;
  ClEvent released_;
  bool acquired_ = false;
};

class GlSharing final : public Bridge {
 public:
  // Errors: kUnsupported with the reason when device, context or probe say no; kDeviceFailure.
  static Result<std::unique_ptr<Bridge>> create(const Context& context, const Device& device,
                                                const BridgeSettings& settings);
  ~GlSharing() override;

  Interop kind() const override { return Interop::kGl; }
  Storage storage() const override { return Storage::kImage; }
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
    std::optional<RenderTargets> targets;  // none with imports
    std::vector<Texture> own;              // for each plane what OpenCL is given; empty: the target itself
    SharedTextures shared;
    SharedFrame views;
  };

  GlSharing(const Device& device, const BridgeSettings& settings, std::string reason);
  Slot& slot_at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  bool is_copied(const Plane& plane) const;
  Slot make_slot();
  Status take_back(const char* call, int slot);
  void copy_linear() const;
  void copy_planes(const Slot& slot, const FrameTextures& from, Extent render);

  Device device_;
  std::vector<Plane> planes_;
  SlotRing ring_;
  std::vector<Slot> slots_;
  DepthCopy depth_copy_;
  Texture presented_;
  SharedTextures output_;
  cl_mem output_image_ = nullptr;
  ClMem linear_;  // the linear picture, which the service writes to buffers alone; empty for RGBA8
  ImageView output_view_;
  std::vector<std::uint8_t> pixels_;
  bool pixels_are_current_ = false;
  bool presenting_ = false;
};

}  // namespace quincunx::gl
