// SPDX-License-Identifier: MIT
// Stage: what the kernels of one output size work on. Lives longer than the cases that use it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "axis_table.h"
#include "interleaved.h"
#include "pass.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"

namespace quincunx::bench {

std::uint64_t bytes_of(Extent extent, PixelFormat format);
Extent scaled(Extent output, double scale);

class Stage {
 public:
  Stage(Device device, Extent output);

  const Device& device() const { return device_; }
  const Device::Impl& impl() const { return *device_.impl(); }
  Extent output() const { return output_; }
  AxisTables& tables() { return tables_; }
  Counter counter() const { return {counter_(), 0}; }

  // Seeded noise; floats and halves lie between 0.1 and 1, without denormals or infinities to slow a kernel
  // down. One image for each extent, format and `index`, shared by all who ask for it.
  ImageView noise(Extent extent, PixelFormat format, int index = 0);

  // The same with one value, 0.5, in every channel.
  ImageView constant(Extent extent, PixelFormat format);

  // A velocity target whose texel (x, y) holds (value(x, y), 0).
  ImageView velocity(Extent extent, const std::function<float(int x, int y)>& value);

  // Colour, velocity, depth and reactive values of one frame at `render`.
  FrameInputs frame(Extent render, PixelFormat colour, float jitter, int index);

  // Adds to `cases` a case that times `enqueue` by the events of its `kernels` kernels.
  using Enqueue = std::function<void(cl::Event*)>;
  static void add(std::vector<Case>& cases, Case what, Enqueue enqueue, int kernels = 1);

  // The float4 copy of the output, the unit of speed.
  void add_copy(std::vector<Case>& cases);

 private:
  struct Noise {
    Extent extent;
    PixelFormat format;
    int index;
    Image image;
  };

  Device device_;
  Extent output_;
  AxisTables tables_;
  cl::Buffer counter_;
  std::vector<Noise> images_;
  std::vector<Image> velocities_;
  std::vector<Image> constants_;
};

}  // namespace quincunx::bench
