// SPDX-License-Identifier: MIT
#include "slot_images.h"

namespace quincunx::gl {
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

}  // namespace quincunx::gl
