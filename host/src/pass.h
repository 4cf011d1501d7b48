// SPDX-License-Identifier: MIT
// Pass: one kernel variant of a plan, compiled for a device. What passes share: tables, layouts, launch sizes,
// kernel arguments.
//
// A pass compiles at construction and allocates nothing afterwards. Construction may throw cl::Error and
// BuildError, enqueue() cl::Error. Not thread-safe.
#pragma once

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "axis_table.h"
#include "device_impl.h"
#include "filter_table.h"
#include "params.h"
#include "pass_spec.h"
#include "position_table.h"
#include "quincunx/focus.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"

namespace quincunx {

// Where a pass adds the number of its output pixels that met NaN or Inf: uint `index` of the buffer `memory`.
struct Counter {
  cl_mem memory = nullptr;
  int index = 0;
};

// The tables that passes read. Each is made when a pass first asks for it, at construction.
class PassTables {
 public:
  PassTables(const Device::Impl& device, const TableLimits& limits) : device_(device), limits_(limits) {}

  AxisTables& axis();
  PositionTables& positions();
  FilterTables& filter(const Filter& filter);

 private:
  const Device::Impl& device_;
  TableLimits limits_;
  std::unique_ptr<AxisTables> axis_;
  std::unique_ptr<PositionTables> positions_;
  std::vector<std::unique_ptr<FilterTables>> filters_;
};

struct PassSetup {
  const Device::Impl& device;
  const PlanFacts& facts;  // outlives the pass
  PassTables& tables;
};

// One frame as its passes see it.
struct PassFrame {
  const cl::CommandQueue& queue;
  PassTables& tables;
  FrameInputs current =
      {};  // `views` may hold another velocity: the one that the service makes from the camera
  FrameInputs previous = {};  // the current one where there is no history
  bool has_history = false;
  const FocusInputs* focus = nullptr;  // null: the frame has none
  Extent focus_extent = {};            // of the plan
  Extent output = {};                  // of this frame
  Extent previous_output = {};         // of the history
  Extent display = {};                 // of the picture that is shown: the largest output
  bool scales_output = false;          // the picture is scaled to the display by a pass of its own
  Counter counter = {};
  std::array<ImageView, kResources> views = {};  // of the resources that the plan has

  ImageView& operator[](Resource resource) { return views[static_cast<std::size_t>(resource)]; }
  const ImageView& operator[](Resource resource) const { return views[static_cast<std::size_t>(resource)]; }
  FrameExtents extents() const {
    return {current.render,  previous.render, output,      current.particle_render,
            previous_output, display,         focus_extent};
  }
  // History has another size than the picture that it becomes.
  bool resizes_history() const { return has_history && previous_output != output; }
  // The tables of this frame's viewport, and of the previous one's.
  TableKey key() const { return {output, current.render, current.jitter}; }
  TableKey previous_key() const { return {output, previous.render, previous.jitter}; }
};

// CLHPP takes no raw handle as an argument.
void set_memory(cl::Kernel& kernel, cl_uint index, cl_mem memory);

// Enough work-items of `columns` x `rows` pixels for the extent, in groups of one fixed size: a device compiles a
// kernel anew for each size. Groups hold fewer items where these have more rows.
void enqueue_rows(const WorkShape& shape, const cl::CommandQueue& queue, const cl::Kernel& kernel,
                  Extent extent, int columns, cl::Event* event, int rows = 1);

// The shape with its group halved, the longer side first, until it has at most `most` work-items. Pure.
WorkShape with_smaller_group(WorkShape shape, std::size_t most);

class Pass {
 public:
  Pass(const PassSetup& setup, const PassSpec& spec);
  virtual ~Pass() = default;
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  const PassSpec& spec() const { return spec_; }

  // Whether the pass takes part in this frame.
  bool takes_part(const PassFrame& frame) const;

  // Enqueues the kernel; `event`, if not null, is its event. What spec().uses names is bound in the frame.
  virtual void enqueue(const PassFrame& frame, cl::Event* event) = 0;

 protected:
  const WorkShape& shape() const { return shape_; }
  const PlanFacts& facts() const { return facts_; }
  const ResolveSettings& settings() const { return facts_.settings; }
  // What a variant does not read may be any memory: `other`'s.
  bool uses(Resource resource) const;
  const ImageView& view_or(const PassFrame& frame, Resource resource, Resource other) const {
    return frame[uses(resource) ? resource : other];
  }
  TexelLayout layout_if_used(const PassFrame& frame, Resource resource) const;
  Resource picture() const { return picture_of(facts_); }

  // As enqueue_rows().
  void launch(const PassFrame& frame, Extent extent, int columns, cl::Event* event, int rows = 1) {
    enqueue_rows(shape_, frame.queue, kernel_, extent, columns, event, rows);
  }

  // Sets the kernel's arguments in order: structs by value, buffers, the memory of images and counters.
  template <typename... Arguments>
  void bind(const Arguments&... arguments) {
    cl_uint index = 0;
    (set(index++, arguments), ...);
  }

 private:
  template <typename Argument>
  void set(cl_uint index, const Argument& argument) {
    if constexpr (std::is_same_v<Argument, ImageView> || std::is_same_v<Argument, Counter>) {
      set_memory(kernel_, index, argument.memory);
    } else {
      kernel_.setArg(index, argument);
    }
  }

  const PlanFacts& facts_;
  PassSpec spec_;
  cl::Kernel kernel_;
  WorkShape shape_;
};

// A pass's `make`.
template <typename Made>
std::unique_ptr<Pass> make_pass(const PassSetup& setup, const PassSpec& spec) {
  return std::make_unique<Made>(setup, spec);
}

// In texels; zeros for an image.
TexelLayout layout_of(const ImageView& view);

// From a frame's velocity, in its own units, to pixels of an extent.
struct VelocityScale {
  double x;
  double y;
};
VelocityScale velocity_scale_to(const FrameInputs& frame, Extent extent);

// From one extent to another on each axis, rounded once.
struct Ratio {
  float x, y;
};
Ratio ratio_of(Extent to, Extent from);

// Pixels of a row that one work-item makes: a multiple of `block`.
int columns_per_item(const WorkShape& shape, int width, int block = kBlock);

}  // namespace quincunx
