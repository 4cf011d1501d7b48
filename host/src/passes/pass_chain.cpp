// SPDX-License-Identifier: MIT
#include "passes/pass_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "device/opencl.h"
#include "quincunx/advanced/log.h"

namespace quincunx {
namespace {

// The host's clock on a queue that has nothing to do at each look. May throw cl::Error.
class QueueStopwatch {
 public:
  explicit QueueStopwatch(const cl::CommandQueue* queue) : queue_(queue) {
    lap_ms();
  }  // null: nothing is timed

  // Waits for the queue. Since the last lap; -1 where nothing is timed.
  double lap_ms() {
    if (queue_ == nullptr) return -1;
    queue_->finish();
    const auto before = std::exchange(last_, std::chrono::steady_clock::now());
    return std::chrono::duration<double, std::milli>(last_ - before).count();
  }

 private:
  const cl::CommandQueue* queue_;
  std::chrono::steady_clock::time_point last_;
};

void fill_zero(const cl::CommandQueue& queue, cl_mem memory, std::size_t bytes) {
  const auto buffer = borrow<cl::Buffer>(memory);
  if (bytes % sizeof(cl_uint) == 0)
    queue.enqueueFillBuffer(buffer, cl_uint{0}, 0, bytes);
  else
    queue.enqueueFillBuffer(buffer, cl_uchar{0}, 0, bytes);
}

// Sets to zero all that the pass adds to.
void clear_sums(const PassFrame& frame, const PassSpec& spec) {
  for (const Use& use : spec.uses) {
    if (use.access != Access::kAccumulate) continue;
    const auto elements = static_cast<std::size_t>(extent_of(use.area, frame.extents()).area());
    fill_zero(frame.queue, frame[use.resource].memory, elements * use.element_bytes());
  }
}

// Memory for warm-up: four elements of any kind, all zero in a buffer, since a kernel follows what tiles say.
ImageView scratch_view(const Device::Impl& device, const Use& use, Storage storage,
                       std::vector<cl::Memory>& kept) {
  constexpr int kSide = 2;
  ImageView view{.storage = storage, .format = use.format, .extent = {kSide, kSide}};
  if (storage == Storage::kImage) {
    // Kernels take images of any format; these two exist everywhere.
    const cl::ImageFormat channels(CL_RGBA, use.format == PixelFormat::kRGBA8 ? CL_UNORM_INT8 : CL_FLOAT);
    kept.push_back(cl::Image2D(device.context, CL_MEM_READ_WRITE, channels, kSide, kSide));
  } else {
    const std::size_t bytes = kSide * kSide * use.element_bytes();
    kept.push_back(cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes));
    fill_zero(device.queue, kept.back()(), bytes);
  }
  view.memory = kept.back()();
  return view;
}

// Where targets are placed, so are the service's own images of a viewport.
void place(ImageView& view, Area area, Extent render) {
  if (area != Area::kViewport || view.format == PixelFormat::kNone || view.storage == Storage::kImage) return;
  view.extent = render;
  view.pitch = 0;
}

}  // namespace

Image allocate_image(const Device& device, Extent extent, PixelFormat format, Storage storage) {
  Result<Image> made = device.allocate(extent, format, storage);
  if (!made.ok()) throw StatusError(made.status());
  return std::move(made).value();
}

void CompileNotice::before_kernel(std::size_t kernels, const std::string& device) {
  if (said_ || std::chrono::steady_clock::now() - start_ < patience_) return;
  said_ = true;
  log_line(LogLevel::kInfo, fmt::format("compiling {} kernels for '{}', once", kernels, device));
}

PassChain::PassChain(const Device& device, const PlanFacts& facts)
    : device_(device),
      facts_(facts),
      tables_(*device_.impl(), {facts_.settings.target_extent, facts_.settings.output.min_extent,
                                facts_.settings.output_extent}) {
  const PassList list = list_passes(facts_);
  resources_ = resources_of(list.passes);
  const PassSetup setup{*device_.impl(), facts_, tables_};
  for (const PassSpec& spec : list.passes) {
    notice_.before_kernel(list.passes.size(), device.info().name);
    passes_.push_back(spec.make(setup, spec));
  }
  needed_.resize(passes_.size());
  for (const ResourceUse& use : resources_) {
    if (use.written && !is_previous(use.resource) && use.resource != Resource::kPresented) allocate(use);
    kept_[index_of(use.resource)] = keeps(use.resource);
  }
}

bool PassChain::has(Resource resource) const {
  return std::any_of(resources_.begin(), resources_.end(),
                     [resource](const ResourceUse& use) { return use.resource == resource; });
}

void PassChain::allocate(const ResourceUse& use) {
  const Extent extent = extent_of(use.largest.area, largest_extents(facts_.settings));
  Owned& owned = owned_.emplace_back(Owned{use.resource, use.largest.area, {}, is_resampled(use.resource)});
  for (std::size_t i = 0; i < (keeps(use.resource) ? 2 : 1); ++i) {
    if (use.largest.format != PixelFormat::kNone) {
      owned.images[i] = allocate_image(device_, extent, use.largest.format, storage_of(use.resource, facts_));
      continue;
    }
    const std::size_t bytes = static_cast<std::size_t>(extent.area()) * use.largest.record_bytes;
    const cl::Buffer records(device_.impl()->context, device_.impl()->picture_flags(), bytes);
    fill_zero(device_.impl()->queue, records(), bytes);
    owned.images[i] = Image::borrow({.memory = records(), .extent = extent});
  }
}

bool PassChain::is_resampled(Resource resource) const {
  return std::any_of(passes_.begin(), passes_.end(), [resource](const auto& pass) {
    const std::vector<Use>& uses = pass->spec().uses;
    return pass->spec().frames == Frames::kResized &&
           std::any_of(uses.begin(), uses.end(), [resource](const Use& use) {
             return use.resource == resource && use.access != Access::kRead;
           });
  });
}

Pass* PassChain::find(std::string_view kernel) const {
  for (const auto& pass : passes_) {
    if (pass->spec().kernel == kernel) return pass.get();
  }
  return nullptr;
}

ImageView PassChain::newest(Resource resource) const {
  for (const Owned& owned : owned_) {
    if (owned.resource == resource) return owned.images[owned.images[1] ? 1 - next_ : 0].view();
  }
  return {};
}

void bind_inputs(PassFrame& frame) {
  for (std::size_t i = 0; i < kResourceCount; ++i) {
    const ResourceInfo& info = info_of(static_cast<Resource>(i));
    if (info.input == nullptr) continue;
    const FrameInputs& inputs = info.is_previous ? frame.previous : frame.inputs;
    frame.views[i] = inputs.*info.input->image;
  }
}

PassFrame PassChain::frame(const FrameInputs& inputs, const FrameInputs* previous,
                           const FrameOutputs& outputs, Counter counter) {
  PassFrame frame{.queue = device_.impl()->queue,
                  .tables = tables_,
                  .inputs = inputs,
                  .previous = previous != nullptr ? *previous : inputs,
                  .has_history = previous != nullptr,
                  .focus_extent = facts_.settings.focus.extent,
                  .output = output_of(inputs),
                  .previous_output = output_of(previous != nullptr ? *previous : inputs),
                  .display = facts_.settings.output_extent,
                  .counter = counter};
  if (facts_.velocity == VelocitySource::kCamera) {  // the service's own target, in uv
    frame.inputs.velocity_scale = {};
    frame.previous.velocity_scale = {};
  }
  bind_inputs(frame);
  for (const Owned& owned : owned_) {
    const bool paired = static_cast<bool>(owned.images[1]);
    frame[owned.resource] = owned.images[paired ? next_ : 0].view();
    if (paired) frame[previous_of(owned.resource)] = owned.images[1 - next_].view();
    if (!facts_.places_targets()) continue;
    place(frame[owned.resource], owned.area, frame.inputs.render_extent);
    if (paired) place(frame[previous_of(owned.resource)], owned.area, frame.previous.render_extent);
  }
  frame[Resource::kFadingFrom] = inputs.fading_from;
  if (outputs.linear) frame[shown_of(facts_)] = outputs.linear;
  frame[Resource::kPresented] = outputs.presented;
  // A picture that has the size in which it is shown is made where it is shown.
  frame.scales_output = facts_.is_dual() && frame.output != frame.display;
  if (!frame.scales_output) frame[finished_of(facts_)] = frame[shown_of(facts_)];
  return frame;
}

// Exchanges resampled resources with the history: this frame writes to the memory that the history had.
void PassChain::take_resampled(PassFrame& frame) {
  for (Owned& owned : owned_) {
    if (!owned.is_resampled) continue;
    std::swap(owned.images[0], owned.images[1]);
    std::swap(frame[owned.resource], frame[previous_of(owned.resource)]);
  }
}

// Clears the history that accumulating passes will read. The service's own targets of a viewport are
// images where the caller's are.
void PassChain::forget(const PassFrame& frame) {
  for (const ResourceUse& use : resources_) {
    if (!is_previous(use.resource) || !use.written) continue;
    FrameExtents extents = largest_extents(facts_.settings);
    extents.output = extents.previous_output = frame.output;
    const Extent extent = extent_of(use.largest.area, extents);
    const ImageView& view = frame[use.resource];
    if (view.storage == Storage::kImage) {
      frame.queue.enqueueFillImage(
          borrow<cl::Image2D>(view.memory), cl_float4{}, {0, 0, 0},
          {static_cast<std::size_t>(extent.width), static_cast<std::size_t>(extent.height), 1});
      continue;
    }
    fill_zero(frame.queue, view.memory,
              static_cast<std::size_t>(extent.area()) * use.largest.element_bytes());
  }
}

// Marks the passes whose results the outputs or the next frame need, from the last to the first.
void PassChain::mark_needed(const PassFrame& frame, const FrameOutputs& outputs, std::size_t first) {
  const bool shows = !facts_.two_way || outputs.linear || outputs.presented;
  std::array<bool, kResourceCount> wanted = kept_;
  wanted[index_of(Resource::kContentSums)] = wanted[index_of(Resource::kMotionSums)] = true;
  wanted[index_of(Resource::kMergedHistory)] = frame.keeps_merged;
  wanted[index_of(shown_of(facts_))] = shows;
  wanted[index_of(Resource::kPresented)] = static_cast<bool>(outputs.presented);
  if (!frame.scales_output) wanted[index_of(finished_of(facts_))] = shows;
  for (std::size_t i = passes_.size(); i-- > 0;) {
    const std::vector<Use>& uses = passes_[i]->spec().uses;
    needed_[i] = i >= first && passes_[i]->takes_part(frame) &&
                 std::any_of(uses.begin(), uses.end(), [&](const Use& use) {
                   return use.access != Access::kRead && wanted[index_of(use.resource)];
                 });
    if (!needed_[i]) continue;
    for (const Use& use : uses)
      wanted[index_of(use.resource)] |= use.access != Access::kWrite;
  }
}

void PassChain::enqueue(Pass& pass, const PassFrame& frame, cl::Event* event) {
  clear_sums(frame, pass.spec());
  pass.enqueue(frame, event);
}

void PassChain::run(PassFrame frame, const FrameOutputs& outputs, FrameReport& report, cl::Event* events) {
  if (facts_.accumulates() && !frame.has_history && !is_dense(frame.inputs.render_extent, frame.output))
    forget(frame);
  mark_needed(frame, outputs, 0);
  run_needed(frame, report, events);
  next_ = 1 - next_;
}

void PassChain::show(const PassFrame& frame, const FrameOutputs& outputs, FrameReport& report,
                     cl::Event* events) {
  const auto merge = std::find_if(passes_.begin(), passes_.end(), [](const auto& pass) {
    return std::string_view(pass->spec().kernel) == "merge_histories";
  });
  mark_needed(frame, outputs, static_cast<std::size_t>(merge - passes_.begin()) + 1);
  PassFrame shown = frame;
  run_needed(shown, report, events);
}

void PassChain::run_needed(PassFrame& frame, FrameReport& report, cl::Event* events) {
  bool resizes = frame.resizes_history();
  QueueStopwatch stopwatch(waits_ ? &frame.queue : nullptr);
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (!needed_[i]) continue;
    const PassSpec& spec = passes_[i]->spec();
    if (resizes && spec.frames != Frames::kResized) {
      take_resampled(frame);
      resizes = false;
    }
    enqueue(*passes_[i], frame, events != nullptr ? events++ : nullptr);
    report.passes.push_back(
        {.kernel = spec.kernel, .ms = stopwatch.lap_ms(), .bytes = bytes_of(spec, frame.extents())});
  }
}

void PassChain::warm_up() {
  constexpr Extent kPixel = {1, 1};
  const Device::Impl& device = *device_.impl();
  std::vector<cl::Memory> kept;
  PassTables tables(device, {kPixel, kPixel, kPixel});
  const cl::Buffer counter(device.context, CL_MEM_READ_WRITE, sizeof(cl_uint));
  const FocusInputs focus = {.rectangles = {{{0, 0, 1, 1}}}, .rectangle_count = 1};
  PassFrame frame{.queue = device.queue,
                  .tables = tables,
                  .focus = &focus,
                  .focus_extent = kPixel,
                  .output = kPixel,
                  .previous_output = kPixel,
                  .display = kPixel,
                  .counter = {counter(), 0}};
  frame.inputs.render_extent = kPixel;
  frame.inputs.particle_render_extent = kPixel;
  frame.previous.render_extent = kPixel;
  for (const auto& pass : passes_) {
    for (const Use& use : pass->spec().uses) {
      if (!frame[use.resource])
        frame[use.resource] = scratch_view(device, use, storage_of(use.resource, facts_), kept);
    }
  }
  for (const auto& pass : passes_) {
    notice_.before_kernel(passes_.size(), device.info.name);
    enqueue(*pass, frame, nullptr);
    device.queue.finish();  // some drivers compile only here
  }
}

}  // namespace quincunx
