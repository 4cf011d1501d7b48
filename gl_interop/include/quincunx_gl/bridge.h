// SPDX-License-Identifier: MIT
// Bridge: carries frames that GL drew to OpenCL, and the picture that OpenCL made back to GL.
//
// Two backends stand behind one interface. GlSharing hands the textures themselves over (cl_khr_gl_sharing), after a
// probe has moved a 16x16 texture of every format both ways, byte for byte. HostCopy copies the viewport's rectangle
// into buffers: persistently mapped ones that OpenCL uses as host memory, or memory of Vulkan's that both import. A
// ring of slots lets frame n + 1 be drawn while n is resolved and n - 1 is still read as history.
//
// The life of a frame in slot s:
//   begin_draw(s, render), draw, submit(s)
//   acquire(s), service.dispatch(...)    s is held, and so is the slot before it, until the next dispatch
//   present(), then presented_pixels() or presented_texture()
// Where a renderer has textures of its own (BridgeSettings::imports):
//   draw, import(textures, render), service.dispatch(...), present(texture)
// All calls come from the thread where the GL context is current. Each restores the GL state that it changes, and
// leaves earlier GL errors to the caller.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/device.h"
#include "quincunx/resolve_plan.h"
#include "quincunx_gl/context.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::gl {

class CallerTextures;
enum class Before;

enum class Interop { kAuto, kGl, kExternal, kCopy };

QUINCUNX_API const char* name_of(Interop interop);  // "gl", "external", "copy", "auto"

struct BridgeSettings {
  Interop interop = Interop::kAuto;  // with the others create() fails if that backend cannot work
  Extent target_extent = {};         // size of the inputs
  Extent output_extent = {};         // size of the presented picture
  bool depth = false;                // hand depth over
  bool velocity = false;             // draw and hand over velocity
  bool reactive = false;             // draw and hand over reactive values
  bool checkerboard = false;         // targets have the stencil of TargetNeeds::checkerboard
  bool imports = false;              // frames come from the caller's textures; the bridge makes no targets
  // Calls restore the state that they change, for which they query some fifteen values a frame. false: they query
  // nothing, and leave that state as in a new context, for a caller that sets its own state anyway.
  bool restores_state = true;
  PixelFormat colour = PixelFormat::kRGBA16F;         // or RGBA8: see RenderTargets; imported also RGBA32F
  PixelFormat velocity_format = PixelFormat::kRG16F;  // imported also RG32F
  PixelFormat picture =
      PixelFormat::kRGBA8;  // RGBA8: the presented picture comes back; RGBA16F, RGBA32F: the linear one
  int slots = 3;            // 2 to 16; from 3 on a frame can be drawn while others are resolved
  Targets targets = Targets::kViewport;  // kPlaced: not with kGl
};

// Returns settings that hand over what frames of this plan need.
QUINCUNX_API BridgeSettings bridge_settings(const ResolvePlan& plan);

// The caller's textures: GL_TEXTURE_2D, not multisampled, at least as large as the viewport, which begins at texel (0,
// 0). The order of rows stays (Origin). Only the images that the settings ask for are read.
struct FrameTextures {
  GLuint colour = 0;    // of the settings' format; for RGBA8 also SRGB8_ALPHA8, whose codes are taken
  GLuint depth = 0;     // any depth format, or R32F
  GLuint velocity = 0;  // of the settings' format
  GLuint reactive = 0;  // R8
};

// The inputs of one slot as OpenCL sees them. The views are valid until the bridge is destroyed, and with placed
// targets until the slot is drawn again. Images that are not handed over are empty. All have the target extent and,
// where they are buffers, its pitch; placed ones have the viewport's.
struct SharedFrame {
  ImageView colour;
  ImageView depth;
  ImageView velocity;
  ImageView reactive;
};

// Opens the OpenCL device that suits the context: one that shares with it, if `interop` allows that and one exists,
// else the one that `selector` names (see Device::open).
QUINCUNX_API Result<Device> open_device(const Context& context, const std::string& selector, Interop interop);

class QUINCUNX_API Bridge {
 public:
  static Result<std::unique_ptr<Bridge>> create(const Context& context, const Device& device,
                                                const BridgeSettings& settings);
  virtual ~Bridge();
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  virtual Interop kind() const = 0;                      // kGl, kExternal or kCopy
  const std::string& reason() const { return reason_; }  // one sentence: why this backend
  virtual Storage storage() const = 0;                   // storage of the inputs
  int slots() const { return settings_.slots; }

  // Takes a slot back from OpenCL, and waits until the work that reads it is done. Returns its framebuffer for a frame
  // of the viewport `render`: its top left part, or with placed targets the whole of it. Placed targets are valid until
  // the next begin_draw().
  virtual Result<const RenderTargets*> begin_draw(int slot, Extent render) = 0;

  // Starts handing the drawn viewport over. Does not wait.
  virtual Status submit(int slot) = 0;

  // Makes the slot readable by OpenCL, and waits for GL where it must. Commands that are enqueued on the device's queue
  // afterwards see the frame.
  virtual Result<SharedFrame> acquire(int slot) = 0;

  // Takes a frame from the caller's textures, in place of begin_draw() and submit(). They are copied in OpenGL's order,
  // so that later drawing does not change this frame. Errors: kInvalidArgument, which names each texture that is wrong;
  // the slot then stays as it was.
  virtual Status submit(int slot, const FrameTextures& textures, Extent render) = 0;

  // Calls that submit() and acquire() for one slot after the other: enough for a renderer that does not draw ahead.
  Result<SharedFrame> import(const FrameTextures& textures, Extent render);

  // Makes the bridge query the caller's textures again. It queries each texture only once for each input, and again if
  // it seems too small or wrong. Call this when a texture's size, format, levels or filters have changed, and when one
  // was deleted.
  void textures_changed();

  // Returns the target of FrameOutputs::presented, or of the linear picture: output extent, BridgeSettings::picture.
  // The view stays the same until the bridge is destroyed.
  virtual Result<ImageView> begin_present() = 0;

  // Waits for the dispatch that writes it, which was enqueued before, and brings the picture to GL and the caller.
  // `into`: a texture of the caller's that receives it, of the picture's format (for RGBA8 also SRGB8_ALPHA8) and at
  // least its size; 0: presented_texture(). Errors: kInvalidArgument if that texture is wrong.
  virtual Status present(GLuint into = 0) = 0;
  virtual GLuint presented_texture() const = 0;        // row 0 on top, or as Origin says
  virtual const std::uint8_t* presented_pixels() = 0;  // tightly packed; valid until begin_present()

  // Returns the memory of the frames, without the presented picture.
  struct Memory {
    std::uint64_t gl_bytes = 0;      // render targets
    std::uint64_t opencl_bytes = 0;  // inputs of OpenCL's own; 0 where it reads the render targets themselves
  };
  virtual Memory memory() const = 0;

  // Bytes that the last submit() + acquire(), and the last present(), moved between GL and OpenCL, and the host's time
  // for the wait in acquire() and for present().
  struct Traffic {
    std::uint64_t bytes_in = 0;
    std::uint64_t bytes_out = 0;
    double acquire_ms = 0;
    double present_ms = 0;
    // Host time that the last begin_draw() spent on images of another size; 0: the size of the frame before.
    double resize_us = 0;
  };
  const Traffic& traffic() const { return traffic_; }

 protected:
  Bridge(const BridgeSettings& settings, std::string reason);

  // Refuse a call that is not for this bridge's kind of targets, or not in its turn.
  Status check_owner(const char* call, bool imports) const;
  Status check_present(bool begun, GLuint into);
  bool has_depth_format(GLuint depth);  // else it is R32F
  Before before() const;

  BridgeSettings settings_;
  std::string reason_;
  Traffic traffic_;
  std::unique_ptr<CallerTextures> textures_;

 private:
  int next_slot_ = 0;  // of import()
};

}  // namespace quincunx::gl
