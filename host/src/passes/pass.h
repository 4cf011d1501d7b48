// SPDX-License-Identifier: MIT
// Pass: one kernel variant of a plan, compiled for a device. Passes share layouts, launch sizes, kernel arguments and
// options; tables are in tables.h, and parameters that several kernels have in frame_params.h.
//
// A pass compiles at construction and allocates nothing afterwards. Construction may throw cl::Error and
// BuildError, enqueue() cl::Error. Not thread-safe.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "device/device_impl.h"
#include "params.h"
#include "passes/tables.h"
#include "passes/two_way.h"
#include "plan/pass_spec.h"
#include "quincunx/advanced/focus.h"
#include "quincunx/frame.h"
#include "quincunx/image.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// Where a pass adds the number of its output pixels that met NaN or Inf: uint `index` of the buffer `memory`.
struct Counter {
  cl_mem memory = nullptr;
  int index = 0;
};

struct PassSetup {
  const Device::Impl& device;
  const PlanFacts& facts;  // outlives the pass
  PassTables& tables;
};

// One frame as its passes see it, in their conventions.
struct PassFrame {
  const cl::CommandQueue& queue;
  PassTables& tables;
  FrameInputs inputs = {};  // `views` may hold other images in their place, which the service made from them
  FrameInputs previous = {};  // those of the previous frame; `inputs` where there is no history
  Vec2 jitter_motion = {};    // jitter_motion() since the last frame, whether or not that counts as history
  bool has_history = false;
  float other_exposure = 0;            // facts.two_way: of the other history; 0: there is none
  bool keeps_merged = false;           // the same: the merged one is read afterwards
  ImageView albedo = {};               // of what the picture shows, as that lies; null: it is not known
  const FocusInputs* focus = nullptr;  // null: the frame has none
  Extent focus_extent = {};            // the plan's
  Extent output = {};                  // this frame's
  Extent previous_output = {};         // the history's
  Extent display = {};                 // size of the picture that is shown: the largest output
  bool scales_output = false;          // the picture is scaled to the display by a pass of its own
  Counter counter = {};
  std::array<ImageView, kResourceCount> views = {};  // views of the resources that the plan has

  ImageView& operator[](Resource resource) { return views[index_of(resource)]; }
  const ImageView& operator[](Resource resource) const { return views[index_of(resource)]; }
  FrameExtents extents() const {
    return {inputs.render_extent,
            previous.render_extent,
            output,
            inputs.particle_render_extent,
            previous_output,
            display,
            focus_extent};
  }
  // History has another size than the picture that it becomes.
  bool resizes_history() const { return has_history && previous_output != output; }
  // The tables of this frame's viewport, and of the previous one's.
  TableKey key() const { return {output, inputs.render_extent, inputs.jitter}; }
  TableKey previous_key() const { return {output, previous.render_extent, previous.jitter}; }
};

// CLHPP takes no raw handle as an argument.
void set_memory(cl::Kernel& kernel, cl_uint index, cl_mem memory);

// Enqueues enough work-items of `columns` x `rows` pixels for the extent, in groups of one fixed size: a device
// compiles a kernel anew for each size. Where items make whole rows, groups hold fewer of more rows.
void enqueue_rows(const WorkShape& shape, const cl::CommandQueue& queue, const cl::Kernel& kernel,
                  Extent extent, int columns, cl::Event* event, int rows = 1);

// Returns the shape with its group halved, the longer side first, until it has at most `most` work-items. Pure.
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

  // Enqueues the kernel; `event`, if not null, is its event. The resources of spec().uses are bound in the frame.
  virtual void enqueue(const PassFrame& frame, cl::Event* event) = 0;

 protected:
  const WorkShape& shape() const { return shape_; }
  // The pixels that a work-item makes at once: 8 or 1.
  int lanes() const { return lanes_; }
  const PlanFacts& facts() const { return facts_; }
  const ResolveSettings& settings() const { return facts_.settings; }
  bool uses(Resource resource) const { return uses_[index_of(resource)]; }
  Resource picture() const { return picture_of(facts_); }

  // As enqueue_rows().
  void launch(const PassFrame& frame, Extent extent, int columns, cl::Event* event, int rows = 1) {
    enqueue_rows(shape_, frame.queue, kernel_, extent, columns, event, rows);
  }

  // Enqueues one work-group.
  void launch_group(const PassFrame& frame, cl::Event* event);

  // Enqueues as many work-items as the device has at work at once. They share the tiles of a list among them, whose
  // length only the device knows (layers/tile_runs.h).
  void launch_over_list(const PassFrame& frame, cl::Event* event);

  // Sets the kernel's arguments in order: structs by value, buffers, the memory of resources, images and counters. A
  // resource that the variant does not use gets memory that stands for it.
  template <typename... Arguments>
  void bind(const PassFrame& frame, const Arguments&... arguments) {
    cl_uint index = 0;
    (set(frame, index++, arguments), ...);
  }

 private:
  template <typename Argument>
  void set(const PassFrame& frame, cl_uint index, const Argument& argument) {
    if constexpr (std::is_same_v<Argument, Resource>) {
      set_memory(kernel_, index, uses(argument) ? frame[argument].memory : stand_in_for(argument));
    } else if constexpr (std::is_same_v<Argument, ImageView> || std::is_same_v<Argument, Counter>) {
      set_memory(kernel_, index, argument.memory);
    } else {
      kernel_.setArg(index, argument);
    }
  }

  cl_mem stand_in_for(Resource resource) const;

  const PlanFacts& facts_;
  PassSpec spec_;
  std::array<bool, kResourceCount> uses_ = {};
  std::array<cl::Memory, 2> stand_ins_;  // a buffer, and an image where inputs are images
  cl::Kernel kernel_;
  WorkShape shape_;
  int lanes_;
  int items_at_once_;
  std::size_t items_of_one_group_;  // of launch_group()
};

// A pass's `make`.
template <typename Made>
std::unique_ptr<Pass> make_pass(const PassSetup& setup, const PassSpec& spec) {
  return std::make_unique<Made>(setup, spec);
}

// Returns it in texels; zeros for an image.
TexelLayout layout_of(const ImageView& view);

// Returns the same of a buffer; of an image, where a kernel turns its rows: those of the `height` first ones, counted
// from where `origin` says.
TexelLayout rows_of(const ImageView& view, int height, Origin origin);

// From a frame's velocity, in its own units, to pixels of an extent.
struct VelocityScale {
  double x;
  double y;
};
VelocityScale velocity_scale_to(const FrameInputs& inputs, Extent extent);

// From one extent to another on each axis, rounded once.
struct Ratio {
  float x, y;
};
Ratio ratio_of(Extent to, Extent from);

// Returns the pixels of a row that one work-item makes: a multiple of `block`, which is 1 where a kernel sees to it.
int columns_per_item(const WorkShape& shape, int width, int block = kBlock);

// The -D options that several kernels share. An image carries its format with it, so the options name it for
// buffers only.
const char* precision_of(PixelFormat format);          // "HALF" or "FLOAT"
const char* storage_option(Storage storage);           // "IMAGE" or "BUFFER"
std::string colour_options(const ResolveSettings&);    // SOURCE_STORAGE, SOURCE_FORMAT
std::string scale_options(const ResolveSettings&);     // the same and OUTPUT_FORMAT
std::string velocity_options(const ResolveSettings&);  // SOURCE_STORAGE, VELOCITY_FORMAT

}  // namespace quincunx
