// SPDX-License-Identifier: MIT
#include "pass_present.h"

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {

PresentPass::PresentPass(const Device::Impl& device, const ResolveSettings& settings)
    : device_(device),
      settings_(settings),
      kernel_(build_kernel(device, kernel_name(), present_options(settings))) {}

void PresentPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  launch(queue, scratch.view(Storage::kBuffer, settings_.resolved), {1, 1}, 1,
         scratch.view(settings_.storage, PixelFormat::kRGBA8), scratch.counter(), nullptr);
  queue.finish();
}

void PresentPass::enqueue(const cl::CommandQueue& queue, const ImageView& resolved, float exposure,
                          const ImageView& presented, Counter counter, cl::Event* event) {
  launch(queue, resolved, settings_.output, exposure, presented, counter, event);
}

void PresentPass::launch(const cl::CommandQueue& queue, const ImageView& resolved, Extent extent,
                         float exposure, const ImageView& presented, Counter counter, cl::Event* event) {
  const PresentParams params{.width = extent.width,
                             .height = extent.height,
                             .source = layout_of(resolved),
                             .output = layout_of(presented),
                             .counter = counter.index,
                             .columns_per_item = columns_per_item(device_, extent.width, kPresentBlock),
                             .exposure = exposure == 0 ? 1 : exposure};
  kernel_.setArg(0, params);
  set_memory(kernel_, 1, resolved.memory);
  set_memory(kernel_, 2, presented.memory);
  set_memory(kernel_, 3, counter.memory);
  enqueue_rows(device_, queue, kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
