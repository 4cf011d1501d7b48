// SPDX-License-Identifier: MIT
// Position tables: where the centre of each output column and row lies among the samples of a viewport, made
// in double precision on the host. They are like axis tables, but positions may lie outside the viewport: a
// position that a kernel moves is clamped only where it ends.
#pragma once

#include <cstddef>

#include "device_impl.h"
#include "quincunx/image.h"
#include "table_ring.h"

namespace quincunx {

// Fills texels[0, output) and fractions[0, output): the texel coordinate u of axis_table.h as its floor and
// the rest, in [0, 1]. `render` and `output` >= 1, |jitter| <= 1. Pure, no allocation.
void fill_positions(int render, int output, double jitter, int* texels, float* fractions);

// The tables of one output extent on the device. Not thread-safe. Throws cl::Error.
class PositionTables {
 public:
  PositionTables(const Device::Impl& device, Extent output);

  // Texels of the columns, their fractions, texels of the rows, their fractions; see TableRing::get().
  const cl::Buffer& get(const cl::CommandQueue& queue, Extent render, Vec2 jitter);

  Extent output() const { return output_; }

  // Columns padded to whole blocks of kReprojectedBlock, repeating the last.
  int columns() const;

 private:
  std::size_t count() const;

  Extent output_;
  TableRing ring_;
};

}  // namespace quincunx
