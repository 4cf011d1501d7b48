// SPDX-License-Identifier: MIT
// Tables on the device that follow from an output, a viewport and a jitter: TableRing keeps them, and AxisTables,
// PositionTables and FilterTables make them on the host, in double precision, when they are first asked for.
//
// With `render` texels under `output` pixels on an axis, all in render pixels:
//   centre of output pixel x    p = (x + .5) * render / output
//   sample of texel i           i + .5 + jitter
//   texel coordinate of p       u = p - .5 - jitter
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/device_impl.h"
#include "params.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"
#include "resolve_params.h"

namespace quincunx {

// The extents and the jitter that a table follows from.
struct TableKey {
  Extent output, render;
  Vec2 jitter;

  friend bool operator==(const TableKey&, const TableKey&) = default;
};

// A key that was used lately costs nothing. The table of a new one is filled into the slot that has been unused for
// longest, and written without blocking. There is no allocation after construction. Not thread-safe. Throws cl::Error.
class TableRing {
 public:
  TableRing(const Device::Impl& device, std::size_t bytes);
  ~TableRing();  // waits for writes that still read host memory
  TableRing(const TableRing&) = delete;
  TableRing& operator=(const TableRing&) = delete;

  // `fill` makes the table in host memory, aligned for any type, and gives the bytes of it that are in use.
  // Valid for kernels enqueued on the in-order `queue` before the eighth further call.
  template <typename Fill>
  const cl::Buffer& get(const cl::CommandQueue& queue, const TableKey& key, const Fill& fill) {
    Slot& slot = find(key);
    const bool known = slot.holds(key);
    slot.last_use = ++uses_;
    if (!known) {
      wait_for(slot);
      slot.key = key;
      write(queue, slot, fill(slot.bytes.data()));
    }
    return slot.buffer;
  }

 private:
  // Enough that a slot's host memory is long since written when its turn comes again.
  static constexpr int kSlots = 8;

  struct Slot {
    TableKey key;
    std::uint64_t last_use = 0;
    std::vector<std::byte> bytes;
    cl::Buffer buffer;
    cl::Event written;

    bool holds(const TableKey& of) const { return last_use != 0 && key == of; }
  };

  Slot& find(const TableKey& key);
  static void wait_for(Slot& slot);
  static void write(const cl::CommandQueue& queue, Slot& slot, std::size_t bytes);

  std::uint64_t uses_ = 0;
  std::array<Slot, kSlots> slots_;
};

// Axis tables: which texels each output column and row reads.

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

// Position tables: where the centre of each output column and row lies among the samples of a viewport. They are like
// axis tables, but positions may lie outside the viewport: a position that a kernel moves is clamped only where it
// ends.

// Fills texels[0, output) and fractions[0, output): the texel coordinate u as its floor and the rest
//, in [0, 1]. `render` and `output` >= 1, |jitter| <= 1. Pure, no allocation.
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

// Filter tables: which texels each output column and row reads through a separable filter, and with what weights:
//   weight at the distance d    filter(d / r), divided by the sum of all weights
//   widening                    r = max(1, render / output)
// Above scale 1 the filter widens, so that what lies between output pixels is averaged and not skipped.

using Filter = SeparableFilter;

// The filter of a method that scale_filter serves at all scales, else null. Lives as long as the program.
const Filter* own_filter(Method method);

// Whether a method reads single samples and skips the rest where a viewport is larger than the output.
bool skips_samples(Method method);

// The filter by which a method widens above scale 1: its own, else bilinear's tent.
const Filter& filter_of(Method method);

// Samples that an axis reads at most: an even number, twice the radius up to scale 1.
int filter_taps(const Filter& filter, int render, int output);

// Samples of an axis that bound the result where ringing is clamped: 2 up to scale 1.
int filter_inner(int render, int output);

// Fills spans[0, output) and weights[0, output * filter_taps()). Beyond the edges a filter sees the edge
// texel, whose weight takes what falls there. A weight below 2^-25 is 0. `render` and `output` >= 1, |jitter|
// <= 1. Pure, no allocation.
void fill_filter(const Filter& filter, int render, int output, double jitter, FilterSpan* spans,
                 float* weights);

// The outputs of a plan's frames on each axis, and the largest viewport.
struct TableLimits {
  Extent target, min_output_extent, output;
};

// The tables of one filter on the device. Not thread-safe. Throws cl::Error.
class FilterTables {
 public:
  FilterTables(const Device::Impl& device, const Filter& filter, const TableLimits& limits);

  // FilterSpan of each output column, padded to whole blocks, then of each row; then the weights in the same
  // order. See TableRing::get().
  const cl::Buffer& get(const cl::CommandQueue& queue, const TableKey& key);

  const Filter& filter() const { return filter_; }

 private:
  const Filter& filter_;
  TableRing ring_;
};

// The tables that passes read. Each is made when a pass first asks for it, at construction.
class PassTables {
 public:
  PassTables(const Device::Impl& device, const TableLimits& limits) : device_(device), limits_(limits) {}

  AxisTables& axis();
  PositionTables& positions();
  FilterTables& filter(const Filter& filter);
  // Returns memory for an argument that a variant does not read.
  const cl::Memory& stand_in(Storage storage);

 private:
  const Device::Impl& device_;
  std::array<cl::Memory, 2> stand_ins_;
  TableLimits limits_;
  std::unique_ptr<AxisTables> axis_;
  std::unique_ptr<PositionTables> positions_;
  std::vector<std::unique_ptr<FilterTables>> filters_;
};

}  // namespace quincunx
