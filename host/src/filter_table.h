// SPDX-License-Identifier: MIT
// Filter tables: which texels each output column and row reads through a separable filter, and with what
// weights; made in double precision on the host.
//
// Pixel x has its centre at p = (x + .5) * render / output render pixels, the sample of texel i lies at i +
// .5 + jitter (see axis_table.h). With r = max(1, render / output) a sample at the distance d weighs filter(d
// / r), over the sum of all: above scale 1 the filter widens, so that what lies between output pixels is
// averaged and not skipped.
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
// texel, whose weight takes what falls there. A weight below 2^-25 is 0. `render` and `output` >= 1, |jitter|
// <= 1. Pure, no allocation.
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
