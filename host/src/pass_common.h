// SPDX-License-Identifier: MIT
// What the passes share: layouts, launch sizes, the counter of non-finite pixels, scratch memory for warm-up.
//
// A pass binds one kernel variant: it compiles at construction, warm_up() makes the device finish compiling
// it, and enqueue() allocates nothing of its own. Each may throw cl::Error, construction also BuildError. Not
// thread-safe.
#pragma once

#include <vector>

#include "device_impl.h"
#include "params.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// Where a pass adds the number of its output pixels that met NaN or Inf: uint `index` of the buffer `memory`.
struct Counter {
  cl_mem memory = nullptr;
  int index = 0;
};

// In texels; zeros for an image.
TexelLayout layout_of(const ImageView& view);

// From a frame's velocity, in its own units, to pixels of an extent.
struct VelocityScale {
  double x;
  double y;
};
VelocityScale velocity_scale_to(const FrameInputs& frame, Extent extent);

// CLHPP takes no raw handle as an argument.
void set_memory(cl::Kernel& kernel, cl_uint index, cl_mem memory);

// Pixels of a row that one work-item makes: a whole row on a CPU, where the row's own values are then loaded
// once, and one block elsewhere. A multiple of `block`.
int columns_per_item(const Device::Impl& device, int width, int block = kBlock);

// Enough work-items of `columns` x 1 pixels for the extent, in groups of one fixed size: a device compiles a
// kernel anew for each size.
void enqueue_rows(const Device::Impl& device, const cl::CommandQueue& queue, const cl::Kernel& kernel,
                  Extent extent, int columns, cl::Event* event);

// Small valid arguments for warm-up, 2x2 texels of any format up to 16 bytes.
class Scratch {
 public:
  explicit Scratch(const Device::Impl& device) : device_(device) {}

  // Released with the Scratch, after the caller has finished the queue.
  ImageView view(Storage storage, PixelFormat format);
  FrameInputs frame(const ResolveSettings& settings);  // of one pixel, with all its images
  Counter counter();

 private:
  const Device::Impl& device_;
  std::vector<cl::Memory> memory_;
};

}  // namespace quincunx
