// SPDX-License-Identifier: MIT
// Axis tables: which texels each output column and row reads, made in double precision on the host.
//
// With `render` texels under `output` pixels on an axis, all in render pixels:
//   centre of output pixel x    p = (x + .5) * render / output
//   sample of texel i           i + .5 + jitter
//   texel coordinate of p       u = p - .5 - jitter
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

// The tables on the device, for outputs up to `most`. Not thread-safe. Throws cl::Error.
class AxisTables {
 public:
  AxisTables(const Device::Impl& device, Extent most);

  // AxisTap of each output column, then, from padded_columns(output) on, of each output row; see TableRing::get().
  // The columns are padded to whole blocks, repeating the last.
  const cl::Buffer& get(const cl::CommandQueue& queue, const TableKey& key);

 private:
  TableRing ring_;
};

}  // namespace quincunx
