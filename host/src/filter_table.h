// SPDX-License-Identifier: MIT
// Filter tables: which texels each output column and row reads through a separable filter, and with what
// weights; made in double precision on the host.
//
// Pixels and samples lie where axis_table.h has them. A sample at the distance d from a pixel's centre, in
// render pixels, has the weight
//   filter(d / r) / the sum over all samples,   r = max(1, render / output).
// So above scale 1 the filter widens, and what lies between output pixels is averaged, not skipped.
#pragma once

#include <cstddef>

#include "device_impl.h"
#include "params.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"
#include "table_ring.h"

namespace quincunx {

enum class Filter { kTent, kBSpline, kCatmullRom, kLanczos2 };

// The filter of a method; kTent for those that have none of their own.
Filter filter_of(Method method);

// Whether a viewport is larger than the output on an axis, so that filters widen.
inline bool widens(Extent render, Extent output) {
  return render.width > output.width || render.height > output.height;
}

// Samples that an axis reads at most: an even number, 2 (tent) or 4 up to scale 1.
int filter_taps(Filter filter, int render, int output);

// Samples of an axis that bound the result where ringing is clamped: 2 up to scale 1.
int filter_inner(int render, int output);

// Fills spans[0, output) and weights[0, output * filter_taps()). Beyond the edges a filter sees the edge
// texel, whose weight takes what falls there. A weight below 2^-25 is 0. `render` and `output` are at least 1,
// |jitter| is at most 1. Pure, no allocation.
void fill_filter(Filter filter, int render, int output, double jitter, FilterSpan* spans, float* weights);

// The tables of one filter and output extent on the device, for viewports up to `target`. Not thread-safe.
// Throws cl::Error.
class FilterTables {
 public:
  FilterTables(const Device::Impl& device, Filter filter, Extent target, Extent output);

  // FilterSpan of each output column, padded to whole blocks, then of each row; then the weights in the same
  // order. See TableRing::get().
  const cl::Buffer& get(const cl::CommandQueue& queue, Extent render, Vec2 jitter);

  Filter filter() const { return filter_; }
  Extent output() const { return output_; }

 private:
  Filter filter_;
  Extent output_;
  TableRing ring_;
};

}  // namespace quincunx
