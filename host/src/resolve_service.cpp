// SPDX-License-Identifier: MIT
#include "quincunx/resolve_service.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <vector>

#include "frame_ring.h"
#include "frame_traffic.h"
#include "pass_clear.h"
#include "pass_motion_blur.h"
#include "pass_present.h"
#include "pass_reproject.h"
#include "pass_resolve.h"
#include "pass_scale.h"
#include "pass_sharpen.h"
#include "pass_temporal.h"
#include "pass_velocity.h"
#include "program_cache.h"

namespace quincunx {

struct ResolveService::Impl {
  Impl(const Device& on, const ResolvePlan& to_do);

  Status allocate();
  void warm_up();
  void enqueue(const FrameInputs& inputs, const FrameOutputs& outputs, FrameRing::Slot& slot);
  int resolve_both(const FrameInputs& inputs, const ImageView& target, Counter count, FrameRing::Slot& slot,
                   cl::Event* events);
  int accumulate(const FrameInputs& inputs, const ImageView& target, Counter count, FrameRing::Slot& slot,
                 cl::Event* events);
  void show(const FrameInputs& inputs, const FrameOutputs& outputs, const ImageView& sharp, Counter count,
            FrameRing::Slot& slot, cl::Event* event);
  void add_pass(FrameRing::Slot& slot, const char* kernel, std::uint64_t bytes) const;
  Status check_history(const FrameInputs& inputs) const;
  FrameInputs with_velocity(FrameInputs inputs) const;
  ClearPass* clear_pass(const ImageView& image);
  bool uses_previous(const FrameInputs& inputs) const {
    return plan.keeps_previous_frame() && has_previous && !inputs.reset;
  }

  Device device;
  ResolvePlan plan;
  AxisTables tables;
  std::optional<VelocityPass> velocity;
  std::optional<ScalePass> scale;      // where frames are not accumulated
  std::optional<ResolvePass> resolve;  // of the two-frame forms one
  std::optional<ReprojectPass> reproject;
  std::optional<TemporalPass> temporal;
  std::optional<SharpenPass> sharpen;
  std::optional<MotionBlurPass> blur;
  std::optional<PresentPass> present;
  std::vector<std::pair<PixelFormat, ClearPass>> clears;  // by texel size
  Image resolved;                                         // where the caller gives none
  Image unsharpened;                                      // where the plan sharpens
  Image blurred;                                          // as resolved
  std::array<Image, 2> velocities;  // of VelocityPass: this frame's and the previous one's
  std::size_t next_velocity = 0;
  cl::Buffer counter;  // of non-finite pixels, one uint a slot of the ring
  FrameInputs previous;
  bool has_previous = false;
  FrameRing ring;
};

ResolveService::Impl::Impl(const Device& on, const ResolvePlan& to_do)
    : device(on),
      plan(to_do),
      tables(*on.impl(), to_do.settings.output),
      counter(on.impl()->context, CL_MEM_READ_WRITE, FrameRing::kFrames * sizeof(cl_uint)) {
  const Device::Impl& impl = *device.impl();
  if (plan.velocity == VelocitySource::kCamera) velocity.emplace(impl, plan.settings);
  if (!plan.accumulates() || plan.is_dense(plan.settings.target))
    scale.emplace(impl, plan.settings.method, plan.settings);
  if (plan.accumulates()) {
    temporal.emplace(impl, plan);
  } else if (plan.reprojects()) {
    reproject.emplace(impl, plan);
  } else if (plan.keeps_previous_frame()) {
    resolve.emplace(impl, plan);
  }
  if (plan.sharpens()) sharpen.emplace(impl, plan.settings);
  if (plan.blurs()) blur.emplace(impl, plan.settings);
  if (plan.settings.present) present.emplace(impl, plan.settings);
  for (const PixelFormat format : plan.clears()) {
    clears.emplace_back(format, ClearPass(impl, plan.settings.storage, format));
  }
}

Status ResolveService::Impl::allocate() {
  const ResolveSettings& settings = plan.settings;
  const auto make = [&](Image& image, Extent extent, PixelFormat format, Storage storage) -> Status {
    auto made = device.allocate(extent, format, storage);
    if (made.ok()) image = std::move(made).value();
    return made.status();
  };
  for (Image* image : {&resolved, sharpen ? &unsharpened : nullptr, blur ? &blurred : nullptr}) {
    if (image == nullptr) continue;
    if (Status status = make(*image, settings.output, settings.resolved, Storage::kBuffer); !status.ok())
      return status;
  }
  for (Image& image : velocities) {
    if (!velocity) break;
    if (Status status = make(image, settings.target, settings.velocity, settings.storage); !status.ok())
      return status;
  }
  return {};
}

void ResolveService::Impl::warm_up() {
  const cl::CommandQueue& queue = device.impl()->queue;
  if (velocity) velocity->warm_up(queue);
  if (scale) scale->warm_up(queue);
  if (resolve) resolve->warm_up(queue);
  if (reproject) reproject->warm_up(queue);
  if (temporal) temporal->warm_up(queue);
  if (sharpen) sharpen->warm_up(queue);
  if (blur) blur->warm_up(queue);
  if (present) present->warm_up(queue);
  for (auto& [format, pass] : clears)
    pass.warm_up(queue);
  // The commands around the kernels have a first time too.
  const cl_uint zero = 0;
  cl_uint back = 1;
  queue.enqueueFillBuffer(counter, zero, 0, sizeof(zero));
  queue.enqueueReadBuffer(counter, CL_FALSE, 0, sizeof(back), &back);
  queue.finish();
}

void ResolveService::Impl::add_pass(FrameRing::Slot& slot, const char* kernel, std::uint64_t bytes) const {
  slot.report.passes[slot.report.pass_count++] = {.kernel = kernel, .bytes = bytes};
}

// What validate() cannot see: the previous frame must still be where it was.
Status ResolveService::Impl::check_history(const FrameInputs& inputs) const {
  if (!uses_previous(inputs)) return {};
  const auto same = [](const ImageView& a, const ImageView& b) {
    return a.memory == b.memory && a.offset == b.offset;
  };
  const char* shared = nullptr;
  if (!plan.accumulates() && same(inputs.colour, previous.colour)) shared = "colour";
  if (plan.accumulates() && plan.follows() && same(inputs.depth, previous.depth)) shared = "depth";
  if (shared == nullptr) return {};
  return Status::invalid(
      fmt::format("{} is the memory of the previous frame, which this dispatch reads as history; give "
                  "consecutive frames different memory, or set reset",
                  shared));
}

// The frame as the passes see it: where velocity comes from the camera it has the service's own target.
FrameInputs ResolveService::Impl::with_velocity(FrameInputs inputs) const {
  if (!velocity) return inputs;
  inputs.velocity = velocities[next_velocity].view();
  inputs.velocity_scale = {};
  return inputs;
}

// This frame and the previous one; gives the number of kernels.
int ResolveService::Impl::resolve_both(const FrameInputs& inputs, const ImageView& target, Counter count,
                                       FrameRing::Slot& slot, cl::Event* events) {
  const cl::CommandQueue& queue = device.impl()->queue;
  if (resolve) {
    resolve->enqueue(queue, tables, inputs, previous, target, count, events);
    add_pass(slot, ResolvePass::kernel_name(), quincunx_bytes(plan, inputs.render, previous.render));
    return 1;
  }
  reproject->enqueue(queue, inputs, previous, target, count, events);
  const auto& kernels = ReprojectPass::kKernels;
  if (reproject->moves()) add_pass(slot, kernels[0], reproject_bytes(plan, inputs.render, previous.render));
  add_pass(slot, kernels[1], reprojected_bytes(plan, inputs.render, previous.render));
  return reproject->moves() ? 2 : 1;
}

// This frame and all before it; gives the number of kernels.
int ResolveService::Impl::accumulate(const FrameInputs& inputs, const ImageView& target, Counter count,
                                     FrameRing::Slot& slot, cl::Event* events) {
  const cl::CommandQueue& queue = device.impl()->queue;
  // A dense frame has left no history.
  const bool known = uses_previous(inputs) && !plan.is_dense(previous.render);
  const FrameInputs& before = known ? previous : inputs;
  if (!known) temporal->forget(queue);
  temporal->enqueue(queue, inputs, before, target, count, events);
  slot.report.used_previous = known;
  const int first = slot.report.pass_count;
  const auto& kernels = TemporalPass::kKernels;
  if (plan.follows()) add_pass(slot, kernels[0], reproject_bytes(plan, inputs.render, before.render));
  add_pass(slot, kernels[1], temporal_tiles_bytes(plan, inputs.render));
  add_pass(slot, kernels[2], temporal_light_bytes(plan));
  add_pass(slot, kernels[3], temporal_bytes(plan, inputs.render, before.render));
  if (plan.settings.temporal.view == TemporalView::kPicture)
    add_pass(slot, kernels[4], temporal_display_bytes(plan, inputs.render));
  return slot.report.pass_count - first;
}

// The optional outputs, from the resolved picture.
void ResolveService::Impl::show(const FrameInputs& inputs, const FrameOutputs& outputs,
                                const ImageView& sharp, Counter count, FrameRing::Slot& slot,
                                cl::Event* event) {
  const cl::CommandQueue& queue = device.impl()->queue;
  const ResolveSettings& settings = plan.settings;
  const ImageView* picture = &sharp;
  if (blur && (outputs.blurred || outputs.presented)) {
    picture = outputs.blurred ? &outputs.blurred : &blurred.view();
    blur->enqueue(queue, tables, inputs, sharp, *picture, event);
    event += MotionBlurPass::kKernels.size();
    add_pass(slot, MotionBlurPass::kKernels[0], motion_tiles_bytes(settings, inputs.render));
    add_pass(slot, MotionBlurPass::kKernels[1], motion_neighbours_bytes(settings));
    add_pass(slot, MotionBlurPass::kKernels[2], motion_blur_bytes(settings, inputs.render));
  }
  if (outputs.presented) {
    present->enqueue(queue, *picture, inputs.exposure, outputs.presented, count, event++);
    add_pass(slot, PresentPass::kernel_name(), present_bytes(settings));
  }
}

void ResolveService::Impl::enqueue(const FrameInputs& inputs, const FrameOutputs& outputs,
                                   FrameRing::Slot& slot) {
  const cl::CommandQueue& queue = device.impl()->queue;
  const ResolveSettings& settings = plan.settings;
  const int index = ring.index_of(slot);
  const Counter count = {counter(), index};
  const cl_uint zero = 0;
  queue.enqueueFillBuffer(counter, zero, index * sizeof(zero), sizeof(zero));

  const ImageView& resolved_view = outputs.resolved ? outputs.resolved : resolved.view();
  const ImageView& target = sharpen ? unsharpened.view() : resolved_view;
  cl::Event* event = slot.passes.data();
  if (velocity) {
    velocity->enqueue(queue, inputs, inputs.velocity, event++);
    add_pass(slot, VelocityPass::kernel_name(), velocity_bytes(settings, inputs.render));
  }
  if (temporal && !plan.is_dense(inputs.render)) {
    event += accumulate(inputs, target, count, slot, event);
  } else if (!temporal && uses_previous(inputs)) {
    event += resolve_both(inputs, target, count, slot, event);
    slot.report.used_previous = true;
  } else {
    scale->enqueue(queue, tables, inputs, target, count, event++);
    add_pass(slot, scale->kernel_name(inputs.render), scale_bytes(settings, inputs.render));
  }
  if (sharpen) {
    sharpen->enqueue(queue, target, resolved_view, event++);
    add_pass(slot, SharpenPass::kernel_name(), sharpen_bytes(settings));
  }
  show(inputs, outputs, resolved_view, count, slot, event);
  queue.enqueueReadBuffer(counter, CL_FALSE, index * sizeof(zero), sizeof(slot.non_finite), &slot.non_finite,
                          nullptr, &slot.done);
  queue.flush();
}

ClearPass* ResolveService::Impl::clear_pass(const ImageView& image) {
  for (auto& [format, pass] : clears) {
    if (image.storage == Storage::kImage || bytes_per_pixel(format) == bytes_per_pixel(image.format))
      return &pass;
  }
  return nullptr;
}

ResolveService::ResolveService(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ResolveService::ResolveService(ResolveService&&) noexcept = default;
ResolveService& ResolveService::operator=(ResolveService&&) noexcept = default;

ResolveService::~ResolveService() {
  if (!impl_) return;
  // The device may still write the counters of the ring.
  if (Status status = finish(); !status.ok())
    spdlog::warn("closing the resolve service: {}", status.message());
}

Result<ResolveService> ResolveService::create(const Device& device, const ResolvePlan& plan) {
  if (plan.settings.storage == Storage::kImage && !device.info().images) {
    return Status::unsupported(
        fmt::format("'{}' has no images; plan with buffer storage", device.info().name));
  }
  try {
    auto impl = std::make_unique<Impl>(device, plan);
    if (Status status = impl->allocate(); !status.ok()) return status;
    impl->warm_up();
    return ResolveService(std::move(impl));
  } catch (const cl::Error& error) {
    return describe(error, "creating the resolve service", device.info().name);
  } catch (const BuildError& error) {
    return Status::device(fmt::format("on '{}' {}", device.info().name, error.what()));
  }
}

FrameReport ResolveService::dispatch(const FrameInputs& inputs, const FrameOutputs& outputs) {
  FrameReport refused;
  refused.frame_index = inputs.frame_index;
  refused.render = inputs.render;
  refused.status = validate(impl_->plan, inputs, outputs);
  if (refused.ok()) refused.status = impl_->check_history(inputs);
  if (!refused.ok()) return refused;
  try {
    FrameRing::Slot& slot = impl_->ring.begin();
    slot.report.frame_index = inputs.frame_index;
    slot.report.render = inputs.render;
    const Extent output = impl_->plan.settings.output;
    slot.report.ratio = {static_cast<float>(inputs.render.width) / static_cast<float>(output.width),
                         static_cast<float>(inputs.render.height) / static_cast<float>(output.height)};
    const FrameInputs frame = impl_->with_velocity(inputs);
    impl_->enqueue(frame, outputs, slot);
    impl_->ring.commit();
    impl_->previous = frame;
    impl_->has_previous = true;
    impl_->next_velocity = 1 - impl_->next_velocity;
    return slot.report;
  } catch (const cl::Error& error) {
    // Part of the frame may be queued; what it left behind is not to be trusted as history.
    impl_->has_previous = false;
    refused.status = describe(error, "dispatch", impl_->device.info().name);
    return refused;
  }
}

std::optional<FrameReport> ResolveService::next_completed() {
  return impl_->ring.next_completed();
}

Status ResolveService::clear(const ImageView& image, Extent render, const float value[4]) {
  if (!image) return Status::invalid("the image to clear is empty; it needs an allocation");
  if (image.storage != impl_->plan.settings.storage) {
    return Status::invalid("the image to clear has another storage than the plan; they must agree");
  }
  if (render.width < 1 || render.height < 1 || render.width > image.extent.width ||
      render.height > image.extent.height) {
    return Status::invalid(
        fmt::format("the rectangle to clear is {}x{}; it must lie within 1x1 and the image's {}x{}",
                    render.width, render.height, image.extent.width, image.extent.height));
  }
  ClearPass* pass = impl_->clear_pass(image);
  if (pass == nullptr) {
    return Status::invalid(
        fmt::format("a clear of {} is not in the plan; set settings.clear for a scene without a "
                    "covering background",
                    name_of(image.format)));
  }
  try {
    pass->enqueue(impl_->device.impl()->queue, image, render, value, nullptr);
    impl_->device.impl()->queue.flush();
    return {};
  } catch (const cl::Error& error) {
    return describe(error, ClearPass::kernel_name(), impl_->device.info().name);
  }
}

Status ResolveService::finish() {
  return impl_->device.finish();
}

Result<TileKinds> ResolveService::tile_kinds() const {
  if (!impl_->blur)
    return Status::invalid("the plan has no motion blur and so no tiles; set settings.blur.shutter");
  try {
    return TileKinds{impl_->blur->tiles(), impl_->blur->tile_kinds(impl_->device.impl()->queue)};
  } catch (const cl::Error& error) {
    return describe(error, "reading the tiles of the motion blur", impl_->device.info().name);
  }
}

Result<ImageView> ResolveService::history() const {
  if (!impl_->temporal) return Status::invalid("the plan accumulates no history; choose the method temporal");
  if (!impl_->has_previous || impl_->plan.is_dense(impl_->previous.render)) return ImageView();
  return impl_->temporal->history();
}

const ResolvePlan& ResolveService::plan() const {
  return impl_->plan;
}

}  // namespace quincunx
