// SPDX-License-Identifier: MIT
#include "c_interface/host_images.h"

namespace quincunx::c {

HostImages::HostImages(const Device& device, const ResolvePlan& plan)
    : device_(device),
      target_(plan.settings.target),
      output_(plan.settings.output),
      placed_(plan.settings.targets == Targets::kPlaced) {}

Status HostImages::make(Image& image, Extent extent, const ImageView& like) const {
  if (image) return {};
  auto made = device_.allocate(extent, like.format, like.storage);
  if (made.ok()) image = std::move(made).value();
  return made.status();
}

Status HostImages::input(Image& image, const HostMemory& host, Extent render, ImageView& view) const {
  if (Status status = make(image, target_, view); !status.ok()) return status;
  view = image.view();
  if (placed_) {
    view.extent = render;
    view.pitch = 0;
  }
  return device_.upload(view, render, host.texels, host.row_bytes);
}

Status HostImages::bring(Frame& frame) {
  for (std::size_t i = 0; i < kInputImages.size(); ++i) {
    if (frame.host_inputs[i].texels == nullptr) continue;
    const Status status =
        input(inputs_[turn_][i], frame.host_inputs[i], frame.inputs.render, frame.inputs.*kInputImages[i]);
    if (!status.ok()) return status;
  }
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    if (frame.host_outputs[i].texels == nullptr) continue;
    ImageView& view = frame.outputs.*kOutputImages[i];
    if (Status status = make(outputs_[i], output_, view); !status.ok()) return status;
    view = outputs_[i].view();
  }
  return {};
}

Status HostImages::fetch(const Frame& frame) {
  turn_ = 1 - turn_;
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    const HostMemory& host = frame.host_outputs[i];
    if (host.texels == nullptr) continue;
    const Status status =
        device_.download(frame.outputs.*kOutputImages[i], output_, host.texels, host.row_bytes);
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace quincunx::c
