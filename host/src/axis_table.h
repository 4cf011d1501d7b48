// SPDX-License-Identifier: MIT
// Axis tables: which texels each output column and row reads, made in double precision on the host.
//
// With `render` texels under `output` pixels on an axis, pixel x has its centre at p = (x + .5) * render /
// output render pixels. The sample of texel i lies at i + .5 + jitter, so p has the texel coordinate u = p -
// .5 - jitter.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "device_impl.h"
#include "params.h"
#include "quincunx/image.h"

namespace quincunx {

// Fills taps[0, output). `render` and `output` >= 1, |jitter| <= 1. Pure, no allocation.
//   bilinear: floor(u) and floor(u) + 1, each clamped to [0, render - 1], as two neighbours with weights
//   nearest:  the sample closest to p; of two equally close ones the upper/left
void fill_axis(int render, int output, double jitter, AxisTap* taps);

// A ring of tables on the device for one output extent. A viewport and jitter that were used lately cost
// nothing, a new one is filled into the slot unused for longest and written without blocking: no allocation
// after construction. Not thread-safe. Throws cl::Error.
class AxisTables {
 public:
  AxisTables(const Device::Impl& device, Extent output);
  ~AxisTables();  // waits for writes that still read host memory
  AxisTables(const AxisTables&) = delete;
  AxisTables& operator=(const AxisTables&) = delete;

  // AxisTap of each output column, then, from row_axis() on, of each output row. Valid for kernels enqueued
  // on the in-order `queue` before the eighth further call.
  const cl::Buffer& get(const cl::CommandQueue& queue, Extent render, Vec2 jitter);

  Extent output() const { return output_; }

  // The columns are padded to whole blocks, repeating the last.
  int row_axis() const { return (output_.width + kBlock - 1) / kBlock * kBlock; }

 private:
  // Enough that a slot's host memory is long since written when its turn comes again.
  static constexpr int kSlots = 8;

  struct Slot {
    Extent render;
    Vec2 jitter;
    std::uint64_t last_use = 0;
    std::vector<AxisTap> taps;
    cl::Buffer buffer;
    cl::Event written;
  };

  Slot& find(Extent render, Vec2 jitter);

  Extent output_;
  std::uint64_t uses_ = 0;
  std::array<Slot, kSlots> slots_;
};

}  // namespace quincunx
