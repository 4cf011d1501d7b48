// SPDX-License-Identifier: MIT
#include "passes/tables.h"

#include <algorithm>
#include <cmath>

#include "device/opencl.h"
#include "resolve_params.h"

namespace quincunx {
namespace {

// Waits for it; false where nobody can tell whether it is done.
bool has_ended(cl_event event) {
  if (clWaitForEvents(1, &event) == CL_SUCCESS) return true;
  cl_int state = CL_QUEUED;
  const cl_int code =
      clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr);
  return code == CL_SUCCESS && state <= CL_COMPLETE;  // negative: it failed
}

}  // namespace

TableRing::TableRing(const Device::Impl& device, std::size_t bytes) {
  for (Slot& slot : slots_) {
    slot.bytes.resize(bytes);
    slot.buffer = cl::Buffer(device.context, CL_MEM_READ_ONLY, bytes);
  }
}

TableRing::~TableRing() {
  for (Slot& slot : slots_) {
    if (slot.written() != nullptr && !has_ended(slot.written())) never_free(std::move(slot.bytes));
  }
}

TableRing::Slot& TableRing::find(const TableKey& key) {
  Slot* oldest = &slots_[0];
  for (Slot& slot : slots_) {
    if (slot.holds(key)) return slot;
    if (slot.last_use < oldest->last_use) oldest = &slot;
  }
  return *oldest;
}

// Only a caller eight viewports ahead of the device ever waits here.
void TableRing::wait_for(Slot& slot) {
  if (slot.written() != nullptr && slot.written.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE)
    quincunx::wait_for(slot.written);
}

void TableRing::write(const cl::CommandQueue& queue, Slot& slot, std::size_t bytes) {
  try {
    queue.enqueueWriteBuffer(slot.buffer, CL_FALSE, 0, bytes, slot.bytes.data(), nullptr, &slot.written);
  } catch (const cl::Error&) {
    slot.last_use = 0;  // it holds no table now
    throw;
  }
}

namespace {

// The weight of the right tap, a multiple of 2^-24: then both it and 1 - it are floats, and their sum is
// exactly 1.
float exact_weight(double weight) {
  constexpr double kSteps = 16777216;
  return static_cast<float>(std::nearbyint(weight * kSteps) / kSteps);
}

AxisTap tap_at(double u, int render) {
  const int last = render - 1;
  const double floor = std::floor(u);
  AxisTap tap{};
  tap.nearest = std::clamp(static_cast<int>(std::ceil(u - .5)), 0, last);
  // Beyond either end both taps clamp to the same texel, which then takes the whole weight.
  double right = u - floor;
  int base = static_cast<int>(floor);
  if (base < 0) {
    base = 0;
    right = 0;
  } else if (base >= last) {
    base = std::max(last - 1, 0);
    right = last > 0 ? 1 : 0;
  }
  tap.base = base;
  tap.weight1 = exact_weight(right);
  tap.weight0 = 1 - tap.weight1;
  return tap;
}

}  // namespace

void fill_axis(int render, int output, double jitter, AxisTap* taps) {
  for (int x = 0; x < output; ++x) {
    // (2x + 1) * render is an integer: one rounding, and none at all where the quotient is a double.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    taps[x] = tap_at(centre - .5 - jitter, render);
  }
}

namespace {

std::size_t taps_of(Extent output) {
  return static_cast<std::size_t>(padded_columns(output)) + static_cast<std::size_t>(output.height);
}

}  // namespace

AxisTables::AxisTables(const Device::Impl& device, Extent most)
    : ring_(device, taps_of(most) * sizeof(AxisTap)) {}

const cl::Buffer& AxisTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    auto* columns = reinterpret_cast<AxisTap*>(bytes);
    AxisTap* rows = columns + padded_columns(output);
    fill_axis(key.render.width, output.width, key.jitter.x, columns);
    std::fill(columns + output.width, rows, columns[output.width - 1]);
    fill_axis(key.render.height, output.height, key.jitter.y, rows);
    return taps_of(output) * sizeof(AxisTap);
  });
}

static_assert(sizeof(int) == sizeof(float), "a table holds both");

void fill_positions(int render, int output, double jitter, int* texels, float* fractions) {
  for (int x = 0; x < output; ++x) {
    // As in fill_axis: one rounding at most.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    const double u = centre - .5 - jitter;
    const double floor = std::floor(u);
    texels[x] = static_cast<int>(floor);
    fractions[x] = static_cast<float>(u - floor);
  }
}

int position_columns(Extent output) {
  constexpr int kStep = kReprojectedBlock;
  return (output.width + kStep - 1) / kStep * kStep;
}

namespace {

std::size_t positions_of(Extent output) {
  return 2 * (static_cast<std::size_t>(position_columns(output)) + static_cast<std::size_t>(output.height));
}

}  // namespace

PositionTables::PositionTables(const Device::Impl& device, Extent most)
    : ring_(device, positions_of(most) * sizeof(float)) {}

const cl::Buffer& PositionTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    const int columns = position_columns(output);
    auto* texels = reinterpret_cast<int*>(bytes);
    auto* fractions = reinterpret_cast<float*>(texels + columns);
    fill_positions(key.render.width, output.width, key.jitter.x, texels, fractions);
    std::fill(texels + output.width, texels + columns, texels[output.width - 1]);
    std::fill(fractions + output.width, fractions + columns, fractions[output.width - 1]);
    texels = reinterpret_cast<int*>(fractions + columns);
    fill_positions(key.render.height, output.height, key.jitter.y, texels,
                   reinterpret_cast<float*>(texels + output.height));
    return positions_of(output) * sizeof(float);
  });
}

namespace {

double widening(int render, int output) {
  return std::max(1.0, static_cast<double>(render) / output);
}

struct FilterAxis {
  const Filter& filter;
  int render;
  int taps;
  int inner;
  double widening;
};

// `u`: the texel coordinate of the pixel's centre, so that texel i is |i - u| away.
void fill_pixel(const FilterAxis& axis, double u, FilterSpan& span, float* weights) {
  constexpr double kLeastWeight = 0x1p-25;
  const int last = axis.render - 1;
  const int left = static_cast<int>(std::floor(u));
  const int ideal = left - axis.taps / 2 + 1;
  // The weights that one clamped texel collects from beyond the edge land inside of the span as well.
  span.base = std::clamp(ideal, 0, std::max(0, axis.render - axis.taps));
  span.inner = std::clamp(left - axis.inner / 2 + 1, 0, std::max(0, axis.render - axis.inner));

  double sum = 0;
  for (int k = 0; k < axis.taps; ++k)
    sum += axis.filter.weight(std::abs(ideal + k - u) / axis.widening);
  std::fill_n(weights, axis.taps, 0.0f);
  // The taps of one texel follow one another, so each weight is rounded once.
  for (int k = 0; k < axis.taps;) {
    const int texel = std::clamp(ideal + k, 0, last);
    double weight = 0;
    for (; k < axis.taps && std::clamp(ideal + k, 0, last) == texel; ++k)
      weight += axis.filter.weight(std::abs(ideal + k - u) / axis.widening) / sum;
    weights[texel - span.base] = std::abs(weight) < kLeastWeight ? 0 : static_cast<float>(weight);
  }
}

}  // namespace

const Filter* own_filter(Method method) {
  const Filter& filter = methods()[static_cast<std::size_t>(method)].filter;
  return filter.radius > 1 ? &filter : nullptr;
}

bool skips_samples(Method method) {
  return method == Method::kPoint || method == Method::kNoise || method == Method::kNoiseOffset;
}

const Filter& filter_of(Method method) {
  const Filter* own = own_filter(method);
  return own != nullptr ? *own : methods()[static_cast<std::size_t>(Method::kBilinear)].filter;
}

int filter_taps(const Filter& filter, int render, int output) {
  return 2 * static_cast<int>(std::ceil(filter.radius * widening(render, output)));
}

int filter_inner(int render, int output) {
  return 2 * static_cast<int>(std::ceil(widening(render, output)));
}

void fill_filter(const Filter& filter, int render, int output, double jitter, FilterSpan* spans,
                 float* weights) {
  const FilterAxis axis{filter, render, filter_taps(filter, render, output), filter_inner(render, output),
                        widening(render, output)};
  for (int x = 0; x < output; ++x) {
    // (2x + 1) * render is an integer: one rounding, and none at all where the quotient is a double.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    fill_pixel(axis, centre - .5 - jitter, spans[x], weights + static_cast<std::ptrdiff_t>(x) * axis.taps);
  }
}

namespace {

// In spans, weights counted with those of the columns that only pad a block.
std::size_t spans_of(Extent output) {
  return static_cast<std::size_t>(padded_columns(output)) + static_cast<std::size_t>(output.height);
}

// Returns the weights of an axis whose `pixels` have a table each.
std::size_t weights_of(const Filter& filter, int render, int output, int pixels) {
  return static_cast<std::size_t>(pixels) * static_cast<std::size_t>(filter_taps(filter, render, output));
}

std::size_t table_bytes(const Filter& filter, Extent render, Extent output) {
  const std::size_t weights = weights_of(filter, render.width, output.width, padded_columns(output)) +
                              weights_of(filter, render.height, output.height, output.height);
  return spans_of(output) * sizeof(FilterSpan) + weights * sizeof(float);
}

// Returns the size of the largest table within the limits. A smaller output has fewer pixels with more taps each.
std::size_t most_bytes(const Filter& filter, const TableLimits& limits) {
  std::size_t across = 0, down = 0;
  for (int width = limits.min_output_extent.width; width <= limits.output.width; ++width)
    across = std::max(across, weights_of(filter, limits.target.width, width, padded_columns({width, 1})));
  for (int height = limits.min_output_extent.height; height <= limits.output.height; ++height)
    down = std::max(down, weights_of(filter, limits.target.height, height, height));
  return spans_of(limits.output) * sizeof(FilterSpan) + (across + down) * sizeof(float);
}

}  // namespace

FilterTables::FilterTables(const Device::Impl& device, const Filter& filter, const TableLimits& limits)
    : filter_(filter), ring_(device, most_bytes(filter, limits)) {}

const cl::Buffer& FilterTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    const Extent render = key.render;
    auto* columns = reinterpret_cast<FilterSpan*>(bytes);
    FilterSpan* rows = columns + padded_columns(output);
    auto* column_weights = reinterpret_cast<float*>(columns + spans_of(output));
    float* row_weights =
        column_weights + weights_of(filter_, render.width, output.width, padded_columns(output));
    fill_filter(filter_, render.width, output.width, key.jitter.x, columns, column_weights);
    std::fill(columns + output.width, rows, columns[output.width - 1]);
    fill_filter(filter_, render.height, output.height, key.jitter.y, rows, row_weights);
    return table_bytes(filter_, render, output);
  });
}

AxisTables& PassTables::axis() {
  if (!axis_) axis_ = std::make_unique<AxisTables>(device_, limits_.output);
  return *axis_;
}

PositionTables& PassTables::positions() {
  if (!positions_) positions_ = std::make_unique<PositionTables>(device_, limits_.output);
  return *positions_;
}

FilterTables& PassTables::filter(const Filter& filter) {
  for (const auto& made : filters_) {
    if (made->filter() == filter) return *made;
  }
  return *filters_.emplace_back(std::make_unique<FilterTables>(device_, filter, limits_));
}

const cl::Memory& PassTables::stand_in(Storage storage) {
  cl::Memory& memory = stand_ins_[storage == Storage::kImage ? 1 : 0];
  if (memory() != nullptr) return memory;
  if (storage == Storage::kImage)
    memory = cl::Image2D(device_.context, CL_MEM_READ_WRITE, {CL_RGBA, CL_FLOAT}, 1, 1);
  else
    memory = cl::Buffer(device_.context, CL_MEM_READ_WRITE, sizeof(cl_float16));
  return memory;
}

}  // namespace quincunx
