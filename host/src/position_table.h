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

// Columns of an output, padded to whole blocks of kReprojectedBlock.
int position_columns(Extent output);

// The tables on the device, for outputs up to `most`. Not thread-safe. Throws cl::Error.
class PositionTables {
 public:
  PositionTables(const Device::Impl& device, Extent most);

  // Texels of the position_columns(), which repeat the last, their fractions, texels of the rows, their fractions; see
  // TableRing::get().
  const cl::Buffer& get(const cl::CommandQueue& queue, const TableKey& key);

 private:
  TableRing ring_;
};

}  // namespace quincunx
