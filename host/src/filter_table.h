// SPDX-License-Identifier: MIT
// Filter tables: which texels each output column and row reads through a separable filter, and with what
// weights; made in double precision on the host.
//
// In render pixels (see axis_table.h):
//   centre of output pixel x       p = (x + .5) * render / output
//   sample of texel i              i + .5 + jitter
//   weight at the distance d       filter(d / r), divided by the sum of all weights
//   widening                       r = max(1, render / output)
// Above scale 1 the filter widens, so that what lies between output pixels is averaged and not skipped.
#pragma once

#include <cstddef>

#include "device_impl.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"
#include "scale_params.h"
#include "table_ring.h"

namespace quincunx {

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
  Extent target, least_output, output;
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

}  // namespace quincunx
