// SPDX-License-Identifier: MIT
// Axis tables: which texels each output column and row reads, made in double precision on the host.
//
// With `render` texels under `output` pixels on an axis, the centre of pixel x lies, in render pixels, at
//   p = (x + .5) * render / output.
// The sample of texel i lies at i + .5 + jitter, so p has the texel coordinate
//   u = p - .5 - jitter.
#pragma once

#include <cstddef>

#include "device_impl.h"
#include "params.h"
#include "quincunx/image.h"
#include "table_ring.h"

namespace quincunx {

// Fills taps[0, output). `render` and `output` >= 1, |jitter| <= 1. Pure, no allocation.
//   bilinear: floor(u) and floor(u) + 1, each clamped to [0, render - 1], as two neighbours with weights
//   nearest:  the sample closest to p; of two equally close ones the upper/left
void fill_axis(int render, int output, double jitter, AxisTap* taps);

// Columns of an output in whole blocks.
inline int padded_columns(Extent output) {
  return (output.width + kBlock - 1) / kBlock * kBlock;
}

// The tables of one output extent on the device. Not thread-safe. Throws cl::Error.
class AxisTables {
 public:
  AxisTables(const Device::Impl& device, Extent output);

  // AxisTap of each output column, then, from row_axis() on, of each output row; see TableRing::get().
  const cl::Buffer& get(const cl::CommandQueue& queue, Extent render, Vec2 jitter);

  Extent output() const { return output_; }

  // The columns are padded to whole blocks, repeating the last.
  int row_axis() const { return padded_columns(output_); }

 private:
  std::size_t count() const {
    return static_cast<std::size_t>(row_axis()) + static_cast<std::size_t>(output_.height);
  }

  Extent output_;
  TableRing ring_;
};

}  // namespace quincunx
