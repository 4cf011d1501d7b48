// SPDX-License-Identifier: MIT
#include "host_copy.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "fence.h"
#include "quincunx/advanced/log.h"
#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"
#include "state_scope.h"

namespace quincunx::gl {

TargetPool::TargetPool(const TargetNeeds& largest)
    : needs_(largest), most_texels_(2 * largest.target_extent.area()) {}

void TargetPool::make_room(Extent extent) {
  std::int64_t texels = extent.area();
  for (const auto& targets : kept_)
    texels += targets->extent().area();
  auto oldest = kept_.begin();
  for (; oldest != kept_.end() && texels > most_texels_; ++oldest)
    texels -= (*oldest)->extent().area();
  kept_.erase(kept_.begin(), oldest);
}

const RenderTargets& TargetPool::at(Extent extent) {
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept->extent() == extent; });
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
  } else {
    make_room(extent);
    TargetNeeds needs = needs_;
    needs.target_extent = extent;
    auto made = RenderTargets::create(needs);
    if (!made.ok()) throw InteropError(made.error());
    kept_.push_back(std::make_unique<RenderTargets>(std::move(made).value()));
  }
  return *kept_.back();
}

std::uint64_t TargetPool::bytes() const {
  return std::accumulate(kept_.begin(), kept_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& targets) { return sum + targets->bytes(); });
}

namespace {

ClMem make_image(const Device& device, const ImageView& region, cl_mem buffer) {
  const cl_image_format format = cl_format(region.format);
  cl_image_desc desc = {};
  desc.image_type = CL_MEM_OBJECT_IMAGE2D;
  desc.image_width = static_cast<std::size_t>(region.extent.width);
  desc.image_height = static_cast<std::size_t>(region.extent.height);
  desc.image_row_pitch = region.pitch;
  desc.buffer = buffer;
  cl_int code = CL_SUCCESS;
  ClMem image = ClMem::adopt(clCreateImage(device.context(), 0, &format, &desc, nullptr, &code));
  check_cl(code, "clCreateImage on a buffer");
  return image;
}

}  // namespace

PlacedForm placed_form_for(const DeviceInfo& device) {
  // On a CPU the kernels are faster on buffers.
  const bool images =
      device.kind != DeviceKind::kCpu && device.image_pitch_texels > 0 && device.two_channel_images;
  return images ? PlacedForm{Storage::kImage, device.image_pitch_texels} : PlacedForm{};
}

SlotImages::SlotImages(const Device& device, const std::vector<Plane>& planes, const FrameLayout& layout,
                       const PlacedForm& form, const PixelBuffer& pixels)
    : device_(device), planes_(planes), form_(form), regions_(layout.views) {
  for (const Plane& plane : planes_) {
    ImageView& region = view_of(regions_, plane.kind);
    region.memory = pixels.cl_buffer();
    if (form_.storage == Storage::kBuffer) continue;
    const std::size_t bytes = region.pitch * static_cast<std::size_t>(region.extent.height);
    surfaces_.push_back({.region = pixels.sub_buffer(region.offset, bytes), .image = {}});
  }
  views_ = regions_;
}

void SlotImages::resize(Extent render) {
  const bool made = form_.storage == Storage::kBuffer || surfaces_.front().image;
  if (made && extent() == render) return;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    ImageView& region = view_of(regions_, planes_[i].kind);
    ImageView& view = view_of(views_, planes_[i].kind);
    place(region, render, form_.row_texels);
    view = region;
    if (form_.storage == Storage::kBuffer) continue;
    surfaces_[i].image = make_image(device_, region, surfaces_[i].region.get());
    view = {.memory = surfaces_[i].image.get(),
            .storage = Storage::kImage,
            .format = region.format,
            .extent = render};
  }
}

// Viewport targets: memory of its own for each slot. Placed ones: all slots in one allocation.
void HostCopy::make_slots(Transfer transfer, const Exporter* exporter) {
  const bool placed = settings_.targets == Targets::kPlaced && transfer != Transfer::kShared;
  const FrameLayout layout = lay_out(planes_, settings_.target_extent, settings_.targets, form_.row_texels);
  const std::size_t bytes = PixelMemory::whole_pages(layout.bytes);
  const auto count = static_cast<std::size_t>(settings_.slots);
  const auto memory = placed ? std::make_shared<PixelMemory>(device_, count * bytes, transfer) : nullptr;
  slots_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    PixelBuffer pixels = placed ? PixelBuffer(device_, memory, i * bytes, bytes)
                                : PixelBuffer(device_, layout.bytes, transfer, exporter);
    SlotImages images(device_, planes_, layout, form_, pixels);
    slots_.push_back({.pixels = std::move(pixels), .images = std::move(images), .read_back = {}});
  }
}

HostCopy::HostCopy(const Device& device, const BridgeSettings& settings, std::string reason,
                   Transfer transfer, const PlacedForm& form, const Exporter* exporter)
    : Bridge(settings, std::move(reason)),
      device_(device),
      planes_(planes_of(settings)),
      form_(settings.targets == Targets::kPlaced ? form : PlacedForm{}),
      pool_(target_needs(settings)),
      reader_(Framebuffer::create()),
      ring_(settings.slots, settings.target_extent),
      output_(device,
              static_cast<std::size_t>(settings.output_extent.area()) * bytes_per_pixel(settings.picture),
              transfer, exporter),
      presented_(Texture::create()) {
  make_slots(transfer, exporter);

  output_view_ = {.memory = output_.cl_buffer(),
                  .format = settings.picture,
                  .extent = settings.output_extent,
                  .pitch = settings.output_extent.width * bytes_per_pixel(settings.picture)};
  texture_storage(presented_.get(), 1, gl_format(settings.picture).internal, settings.output_extent);
  if (settings.depth && !capabilities().reads_depth) depth_reader_ = DepthReader(settings.target_extent);

  if (!settings.imports)
    targets_ = &pool_.at(settings.targets == Targets::kPlaced ? Extent{1, 1} : settings.target_extent);
  prepare_shaders();
  if (settings.imports) return;
  // One hand-over in advance finds what the driver refuses, and leaves nothing to be made in the first frame.
  const ErrorScope callers;
  targets_->clear({1, 1});
  read_back(slots_.front(), textures_of(*targets_), {1, 1});
  slots_.front().read_back.wait();
  if (const GLenum error = ErrorScope::take(); error != GL_NO_ERROR) {
    throw InteropError(fmt::format(
        "reading the render targets into a pixel buffer failed with OpenGL error 0x{:04x}", error));
  }
}

// For memory of a device, within the reach of a shader, and textures that stay.
void HostCopy::prepare_shaders() {
  if (output_.bytes() != nullptr || capabilities().api != Api::kGl45) return;
  GLint64 reach = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &reach);
  const std::size_t largest = std::max(slots_.front().pixels.size(), output_.size());
  if (static_cast<GLint64>(largest) > reach) return;
  const ErrorScope callers;
  picture_copy_.emplace(presented_.get(), settings_.picture, false, TexelCopy::Direction::kToTexture);
  if (settings_.imports || settings_.targets == Targets::kPlaced) return;
  for (const Plane& plane : planes_) {
    plane_copies_.emplace_back(texture_of(textures_of(*targets_), plane.kind), plane.format,
                               plane.kind == PlaneKind::kDepth, TexelCopy::Direction::kToBuffer);
  }
}

// For textures of the caller's; null: by transfers of pixels. A view needs an immutable texture, and image units take
// no other without all its levels.
const TexelCopy* HostCopy::shader_of(TextureFacts& facts, GLuint texture, const Plane& plane,
                                     TexelCopy::Direction direction) {
  if (!picture_copy_ || !facts.immutable) return nullptr;
  if (facts.copy) return facts.copy.get();
  const ErrorScope callers;
  try {
    facts.copy = std::make_shared<TexelCopy>(texture, plane.format, facts.depth_bits > 0, direction);
  } catch (const std::exception& error) {
    ErrorScope::take();
    facts.immutable = false;  // of use for nothing else
    log_line(LogLevel::kWarning, fmt::format("interop: {}", error.what()));
  }
  return facts.copy.get();
}

HostCopy::~HostCopy() {
  glFinish();  // GL may still be reading back into the buffers that go now
}

void HostCopy::read_back(Slot& slot, const FrameTextures& from, Extent render) {
  const PackScope restore(before());
  SharedFrame regions = slot.images.regions();
  slot.pixels.begin_gl();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, reader_.get());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.gl_buffer());
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    const ImageView& view = view_of(regions, plane.kind);
    const GLuint texture = texture_of(from, plane.kind);
    const TexelCopy* const shader = settings_.imports
                                        ? shader_of(textures_->facts(plane.kind, texture), texture, plane,
                                                    TexelCopy::Direction::kToBuffer)
                                    : plane_copies_.empty() ? nullptr
                                                            : &plane_copies_[i];
    if (shader != nullptr) {
      shader->run(render, slot.pixels.gl_buffer(), slot.pixels.offset() + view.offset, view.pitch, before());
      continue;
    }
    const GlFormat names = gl_format(plane.format);
    const bool is_depth = plane.kind == PlaneKind::kDepth && has_depth_format(texture);
    void* const start = slot.pixels.gl_pointer(view.offset);
    glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(view.pitch / bytes_per_pixel(plane.format)));
    if (is_depth && !capabilities().reads_depth) {
      depth_reader_.read(texture, render, start, before());
      glBindFramebuffer(GL_READ_FRAMEBUFFER, reader_.get());
      continue;
    }
    const GLenum attachment = is_depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0;
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    glReadPixels(0, 0, render.width, render.height, is_depth ? GLenum{GL_DEPTH_COMPONENT} : names.format,
                 names.type, start);
    // Else the texture would outlive its end, and be seen by a framebuffer of another size.
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, attachment, GL_TEXTURE_2D, 0, 0);
  }
  slot.pixels.end_gl();
  slot.read_back.set();
}

void HostCopy::hand_over(Slot& slot, Extent render) {
  if (slot.pixels.transfer() != Transfer::kExplicit) {
    slot.pixels.hand_over();
    return;
  }
  SharedFrame regions = slot.images.regions();
  for (const Plane& plane : planes_)
    slot.pixels.enqueue_write(view_of(regions, plane.kind), render);
}

// Nothing is in use here: OpenCL has given the slot back, and GL itself keeps textures until it has read them.
void HostCopy::resize(Slot& slot, Extent render) {
  traffic_.resize_us = 0;
  if (settings_.targets == Targets::kViewport) return;
  const bool same = targets_->extent() == render && slot.images.extent() == render;
  const Stopwatch watch;
  targets_ = &pool_.at(render);
  slot.images.resize(render);
  if (!same) traffic_.resize_us = 1000 * watch.milliseconds();
}

Bridge::Memory HostCopy::memory() const {
  Memory memory{.gl_bytes = pool_.bytes(), .opencl_bytes = 0};
  for (const Slot& slot : slots_)
    memory.opencl_bytes += slot.pixels.size();
  return memory;
}

Result<const RenderTargets*> HostCopy::begin_draw(int slot, Extent render) {
  if (Status status = check_owner("begin_draw", false); !status.ok()) return status;
  if (Status status = ring_.begin_draw(slot, render); !status.ok()) return status;
  if (Status status = take_back("begin_draw", slot); !status.ok()) return status;
  return targets_;
}

Status HostCopy::take_back(const char* call, int slot) {
  try {
    PixelBuffer& pixels = slot_at(slot).pixels;
    // Where the device keeps the order nothing else holds a caller who runs ahead, and finds a device that hangs.
    if (pixels.device_orders()) slot_at(slot).read_back.wait();
    if (!pixels.host_owns()) pixels.take_back(PixelBuffer::Access::kOverwrite);
    pixels.wait();
    resize(slot_at(slot), ring_.render(slot));
    return {};
  } catch (const std::exception& error) {
    return Status::device(fmt::format("{}({}) on '{}': {}", call, slot, device_.info().name, error.what()));
  }
}

Status HostCopy::submit(int slot) {
  if (Status status = ring_.submit(slot); !status.ok()) return status;
  read_back(slot_at(slot), textures_of(*targets_), ring_.render(slot));
  return {};
}

Status HostCopy::submit(int slot, const FrameTextures& textures, Extent render) {
  if (Status status = check_owner("submit", true); !status.ok()) return status;
  if (Status status = textures_->check(planes_, textures, render); !status.ok()) return status;
  if (Status status = ring_.begin_draw(slot, render); !status.ok()) return status;
  if (Status status = take_back("submit", slot); !status.ok()) return status;
  read_back(slot_at(slot), textures, render);
  return ring_.submit(slot);
}

Result<SharedFrame> HostCopy::acquire(int slot) {
  if (Status status = ring_.acquire(slot); !status.ok()) return status;
  const Stopwatch watch;
  try {
    if (!slot_at(slot).pixels.device_orders()) slot_at(slot).read_back.wait();
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
  return slot_at(slot).images.views();
}

Result<ImageView> HostCopy::begin_present() {
  try {
    if (!output_.device_orders()) uploaded_.wait();
    if (output_.transfer() != Transfer::kExplicit) output_.hand_over();
    reader_of_output_.release();
    pixels_ = nullptr;
    presenting_ = true;
    return output_view_;
  } catch (const std::exception& error) {
    return Status::device(fmt::format("begin_present() on '{}': {}", device_.info().name, error.what()));
  }
}

Status HostCopy::present(GLuint into) {
  if (Status status = check_present(presenting_, into); !status.ok()) return status;
  const Stopwatch watch;
  try {
    if (output_.transfer() != Transfer::kExplicit) {
      output_.take_back(PixelBuffer::Access::kRead);
    } else {
      output_.enqueue_read();
    }
    output_.wait();
  } catch (const std::exception& error) {
    return Status::device(fmt::format("present() on '{}': {}", device_.info().name, error.what()));
  }
  const UnpackScope restore(before());
  const GlFormat names = gl_format(settings_.picture);
  output_.begin_gl();
  const TexelCopy* const shader =
      into != 0       ? shader_of(textures_->picture_facts(into), into, {.format = settings_.picture},
                                  TexelCopy::Direction::kToTexture)
      : picture_copy_ ? &*picture_copy_
                      : nullptr;
  if (shader != nullptr) {
    shader->run(settings_.output_extent, output_.gl_buffer(), output_.offset(), output_view_.pitch, before());
  } else {
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, output_.gl_buffer());
    texture_write(into != 0 ? into : presented_.get(), 0, settings_.output_extent, names.format, names.type,
                  output_.gl_pointer(0));
  }
  output_.end_gl();
  uploaded_.set();
  presenting_ = false;
  traffic_.bytes_out =
      static_cast<std::uint64_t>(settings_.output_extent.area()) * bytes_per_pixel(settings_.picture);
  traffic_.present_ms = watch.milliseconds();
  return {};
}

const std::uint8_t* HostCopy::presented_pixels() {
  if (output_.bytes() != nullptr) return output_.bytes();
  if (pixels_ == nullptr && !presenting_) {
    pixels_ = reader_of_output_.read(
        output_.gl_buffer(), output_.offset(),
        static_cast<std::size_t>(settings_.output_extent.area()) * bytes_per_pixel(settings_.picture));
  }
  return pixels_;
}

}  // namespace quincunx::gl
