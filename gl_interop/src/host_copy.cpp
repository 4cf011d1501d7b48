// SPDX-License-Identifier: MIT
#include "host_copy.h"

#include <fmt/format.h>

#include "stopwatch.h"

namespace quincunx::gl {
namespace {

// Rows start on a cache line pair, which is also what PoCL's widest loads want.
constexpr std::size_t kRowAlignment = 128;

std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

// Places the planes one behind the other; each starts at a whole number of its own rows. Returns the bytes of
// all.
std::size_t place(const std::vector<Plane>& planes, Extent target, SharedFrame* views) {
  std::size_t end = 0;
  for (const Plane& plane : planes) {
    ImageView& view = view_of(*views, plane.kind);
    view.format = plane.format;
    view.extent = target;
    view.pitch = round_up(target.width * bytes_per_pixel(plane.format), kRowAlignment);
    view.offset = round_up(end, view.pitch);
    end = view.offset + view.pitch * target.height;
  }
  return end;
}

void* offset_pointer(std::size_t offset) {
  return reinterpret_cast<void*>(offset);
}

}  // namespace

HostCopy::Slot HostCopy::make_slot(Transfer transfer) {
  SharedFrame views;
  const std::size_t bytes = place(planes_, settings_.target, &views);
  Slot slot = {.pixels = PixelBuffer(device_, bytes, transfer), .views = views, .read_back = {}};
  for (const Plane& plane : planes_)
    view_of(slot.views, plane.kind).memory = slot.pixels.cl_buffer();
  return slot;
}

HostCopy::HostCopy(const Device& device, const BridgeSettings& settings, std::string reason,
                   Transfer transfer)
    : Bridge(settings, std::move(reason)),
      device_(device),
      planes_(planes_of(settings)),
      targets_({.target = settings.target, .velocity = settings.velocity, .reactive = settings.reactive}),
      ring_(settings.slots, settings.target),
      output_(device, static_cast<std::size_t>(settings.output.area()) * bytes_per_pixel(PixelFormat::kRGBA8),
              transfer),
      presented_(Texture::create()) {
  slots_.reserve(static_cast<std::size_t>(settings.slots));
  for (int i = 0; i < settings.slots; ++i)
    slots_.push_back(make_slot(transfer));

  output_view_ = {.memory = output_.cl_buffer(),
                  .format = PixelFormat::kRGBA8,
                  .extent = settings.output,
                  .pitch = settings.output.width * bytes_per_pixel(PixelFormat::kRGBA8)};
  glTextureStorage2D(presented_.get(), 1, GL_RGBA8, settings.output.width, settings.output.height);

  // One hand-over in advance finds what the driver refuses, and leaves nothing to be made in the first frame.
  while (glGetError() != GL_NO_ERROR) {
  }
  targets_.clear({1, 1});
  read_back(slots_.front(), {1, 1});
  slots_.front().read_back.wait();
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw InteropError(fmt::format(
        "reading the render targets into a pixel buffer failed with OpenGL error 0x{:04x}", error));
  }
}

HostCopy::~HostCopy() {
  glFinish();  // GL may still be reading back into the buffers that go now
}

void HostCopy::read_back(Slot& slot, Extent render) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, targets_.framebuffer());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.gl_buffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (const Plane& plane : planes_) {
    const ImageView& view = view_of(slot.views, plane.kind);
    const GlFormat names = gl_format(plane.format);
    const bool is_depth = plane.kind == PlaneKind::kDepth;
    if (!is_depth) glReadBuffer(plane.attachment);
    glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(view.pitch / bytes_per_pixel(plane.format)));
    glReadPixels(0, 0, render.width, render.height, is_depth ? GLenum{GL_DEPTH_COMPONENT} : names.format,
                 names.type, offset_pointer(slot.pixels.gl_offset() + view.offset));
  }
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  slot.read_back.set();
}

void HostCopy::hand_over(Slot& slot, Extent render) {
  if (slot.pixels.transfer() == Transfer::kZeroCopy) {
    slot.pixels.hand_over();
    return;
  }
  for (const Plane& plane : planes_)
    slot.pixels.enqueue_write(view_of(slot.views, plane.kind), render);
}

Result<const RenderTargets*> HostCopy::begin_draw(int slot) {
  if (Status status = ring_.begin_draw(slot); !status.ok()) return status;
  try {
    PixelBuffer& pixels = slot_at(slot).pixels;
    if (!pixels.host_owns()) pixels.take_back(PixelBuffer::Access::kOverwrite);
    pixels.wait();
    return &targets_;
  } catch (const std::exception& error) {
    return Status::device(fmt::format("begin_draw({}) on '{}': {}", slot, device_.info().name, error.what()));
  }
}

Status HostCopy::submit(int slot, Extent render) {
  if (Status status = ring_.submit(slot, render); !status.ok()) return status;
  read_back(slot_at(slot), render);
  return {};
}

Result<SharedFrame> HostCopy::acquire(int slot) {
  if (Status status = ring_.acquire(slot); !status.ok()) return status;
  const Stopwatch watch;
  try {
    slot_at(slot).read_back.wait();
    // The readers of a retired slot are all enqueued by now and this frame's are not yet: a map here is done
    // when the last frame is, so that begin_draw() need not wait for this one.
    for (int other = 0; other < slots(); ++other) {
      PixelBuffer& pixels = slot_at(other).pixels;
      if (ring_.is_retired(other) && !pixels.host_owns()) pixels.take_back(PixelBuffer::Access::kOverwrite);
    }
    hand_over(slot_at(slot), ring_.render(slot));
    check_cl(clFlush(device_.queue()), "clFlush");
  } catch (const std::exception& error) {
    return Status::device(fmt::format("acquire({}) on '{}': {}", slot, device_.info().name, error.what()));
  }
  traffic_.bytes_in = 0;
  for (const Plane& plane : planes_) {
    traffic_.bytes_in +=
        static_cast<std::uint64_t>(ring_.render(slot).area()) * bytes_per_pixel(plane.format);
  }
  traffic_.acquire_ms = watch.milliseconds();
  return slot_at(slot).views;
}

Result<ImageView> HostCopy::begin_present() {
  try {
    uploaded_.wait();
    if (output_.transfer() == Transfer::kZeroCopy) output_.hand_over();
    presenting_ = true;
    return output_view_;
  } catch (const std::exception& error) {
    return Status::device(fmt::format("begin_present() on '{}': {}", device_.info().name, error.what()));
  }
}

Status HostCopy::present() {
  if (!presenting_) {
    return Status::invalid("present: no picture was begun; call begin_present() and dispatch into it first");
  }
  const Stopwatch watch;
  try {
    if (output_.transfer() == Transfer::kZeroCopy) {
      output_.take_back(PixelBuffer::Access::kRead);
    } else {
      output_.enqueue_read();
    }
    output_.wait();
  } catch (const std::exception& error) {
    return Status::device(fmt::format("present() on '{}': {}", device_.info().name, error.what()));
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, output_.gl_buffer());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTextureSubImage2D(presented_.get(), 0, 0, 0, settings_.output.width, settings_.output.height, GL_RGBA,
                      GL_UNSIGNED_BYTE, offset_pointer(output_.gl_offset()));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  uploaded_.set();
  presenting_ = false;
  traffic_.bytes_out =
      static_cast<std::uint64_t>(settings_.output.area()) * bytes_per_pixel(PixelFormat::kRGBA8);
  traffic_.present_ms = watch.milliseconds();
  return {};
}

}  // namespace quincunx::gl
