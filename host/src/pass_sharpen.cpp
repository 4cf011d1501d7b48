// SPDX-License-Identifier: MIT
#include "pass_sharpen.h"

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {

SharpenPass::SharpenPass(const Device::Impl& device, const ResolveSettings& settings)
    : device_(device),
      settings_(settings),
      kernel_(build_kernel(device, kernel_name(), sharpen_options(settings))) {}

void SharpenPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  launch(queue, scratch.view(Storage::kBuffer, settings_.resolved), {1, 1},
         scratch.view(Storage::kBuffer, settings_.resolved), nullptr);
  queue.finish();
}

void SharpenPass::enqueue(const cl::CommandQueue& queue, const ImageView& source, const ImageView& sharpened,
                          cl::Event* event) {
  launch(queue, source, settings_.output, sharpened, event);
}

void SharpenPass::launch(const cl::CommandQueue& queue, const ImageView& source, Extent extent,
                         const ImageView& sharpened, cl::Event* event) {
  const SharpenParams params{.width = extent.width,
                             .height = extent.height,
                             .source = layout_of(source),
                             .output = layout_of(sharpened),
                             .columns_per_item = columns_per_item(device_, extent.width),
                             .sharpness = settings_.sharpness};
  kernel_.setArg(0, params);
  set_memory(kernel_, 1, source.memory);
  set_memory(kernel_, 2, sharpened.memory);
  enqueue_rows(device_, queue, kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
