// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "device/program_cache.h"
#include "motion/blur_params.h"
#include "passes/resolve_service_impl.h"
#include "plan/inputs.h"
#include "quincunx/advanced/log.h"

namespace quincunx {
namespace {

// A plan is data that anyone may edit; the service runs what plan_for() makes and nothing else.
Status check_unedited(const ResolvePlan& plan) {
  const Result<ResolvePlan> made = plan_for(plan.needs, plan.settings);
  if (!made.ok()) return made.status();
  const ResolvePlan& own = made.value();
  if (plan == own) return {};
  const char* edited = plan.passes != own.passes             ? "passes"
                       : plan.buffers != own.buffers         ? "buffers"
                       : plan.left_out != own.left_out       ? "left_out"
                       : plan.velocity != own.velocity       ? "velocity"
                       : plan.reads_depth != own.reads_depth ? "reads_depth"
                                                             : "reads_reactive";
  return Status::invalid(fmt::format(
      "the plan's {} is not what plan_for() makes of its needs and settings; change those and plan again",
      edited));
}

Status check_events(std::span<const cl_event> events, cl_context context) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i] == nullptr) return Status::invalid(fmt::format("wait_for[{}] is null; leave it out", i));
    cl_context its = nullptr;
    const cl_int code = clGetEventInfo(events[i], CL_EVENT_CONTEXT, sizeof(its), &its, nullptr);
    if (code != CL_SUCCESS || its != context) {
      return Status::invalid(fmt::format(
          "wait_for[{}] is no event of the device's OpenCL context; make it on a queue of Device::context()",
          i));
    }
  }
  return {};
}

Status check_semaphores(const char* field, std::span<Semaphore* const> semaphores, cl_command_queue queue) {
  for (std::size_t i = 0; i < semaphores.size(); ++i) {
    if (semaphores[i] == nullptr)
      return Status::invalid(fmt::format("{}[{}] is null; leave it out", field, i));
    if (semaphores[i]->queue() != queue) {
      return Status::invalid(
          fmt::format("{}[{}] is of another device; import it by the service's own", field, i));
    }
  }
  return {};
}

void check_ok(const Status& status) {
  if (!status.ok()) throw StatusError(status);
}

// Before everything that is enqueued later on the queue, which is in-order.
void wait_in_queue(const cl::CommandQueue& queue, std::span<const cl_event> events) {
  if (events.empty()) return;
  const cl_int code =
      clEnqueueBarrierWithWaitList(queue(), static_cast<cl_uint>(events.size()), events.data(), nullptr);
  if (code != CL_SUCCESS) throw cl::Error(code, "clEnqueueBarrierWithWaitList");
}

// Returns a reference of the caller's.
cl_event retained(const cl::Event& event) {
  if (const cl_int code = clRetainEvent(event()); code != CL_SUCCESS) throw cl::Error(code, "clRetainEvent");
  return event();
}

}  // namespace

void FrameAdvice::look_at(const ResolvePlan& plan, const FrameInputs& inputs) {
  if (inputs.reset) return;
  if (looks_at_camera_) look_at_camera(inputs.camera);
  const Extent output = inputs.output_extent == Extent{} ? plan.settings.output_extent : inputs.output_extent;
  if (plan.accumulates() && plan.reads_history(inputs.render_extent, output))
    look_at_jitter(inputs.render_extent, output, inputs.jitter);
}

void FrameAdvice::look_at_camera(const CameraMotion& camera) {
  looks_at_camera_ = camera.clip_to_previous_clip == CameraMotion{}.clip_to_previous_clip;
  if (!looks_at_camera_ || ++camera_frames_ < kFrames) return;
  looks_at_camera_ = false;
  log_line(
      LogLevel::kWarning,
      fmt::format("the plan reads the camera's motion, but in the first {} frames `camera` is the identity, "
                  "as of one that stands still; where it moves, tell how",
                  kFrames));
}

void FrameAdvice::look_at_jitter(Extent render, Extent output, Vec2 jitter) {
  constexpr float kSamePlace = .01f;
  if (place_count_ == places_.size() || jitter_frames_ == kFrames) return;
  const auto end = places_.begin() + place_count_;
  const bool is_known = std::any_of(places_.begin(), end, [&](Vec2 place) {
    return std::abs(place.x - jitter.x) <= kSamePlace && std::abs(place.y - jitter.y) <= kSamePlace;
  });
  if (!is_known) places_[place_count_++] = jitter;
  const int wanted = jitter_phases(render, output);
  if (++jitter_frames_ < kFrames || 2 * place_count_ >= static_cast<std::size_t>(wanted) ||
      place_count_ == places_.size())
    return;
  log_line(
      LogLevel::kWarning,
      fmt::format("the first {} frames have samples at {} {} of a pixel, where temporal wants {}: `jitter` "
                  "is not as jitter(frame, {}x{}, {}x{}) gives it, and pictures stay coarse",
                  kFrames, place_count_, place_count_ == 1 ? "place" : "places", wanted, render.width,
                  render.height, output.width, output.height));
}

void ResolveService::Impl::warm_up() {
  picture.chain().warm_up();
  if (region) region->chain().warm_up();
  // The commands around the kernels have a first time too.
  const cl::CommandQueue& queue = device.impl()->queue;
  const cl_uint zero = 0;
  cl_uint back = 1;
  queue.enqueueFillBuffer(counter, zero, 0, sizeof(zero));
  queue.enqueueReadBuffer(counter, CL_TRUE, 0, sizeof(back), &back);  // waits: `back` must outlive it
}

Status ResolveService::Impl::check(const FrameInputs& inputs, const FocusInputs* focus,
                                   const FrameOutputs& outputs) const {
  const bool adds = picture.chain().facts().two_way;  // and shows nothing
  Status valid = validate_frame(picture.plan(), inputs, adds ? nullptr : &outputs, Memory::kAsked);
  if (!valid.ok()) return valid;
  if (Status status = picture.check_history(inputs); !status.ok()) return status;
  if (focus == nullptr) return {};
  const Status status =
      validate_focus(picture.plan(), region ? &region->plan() : nullptr, *focus, Memory::kAsked);
  return status.ok() ? region->check_history(*focus) : status;
}

void ResolveService::Impl::enqueue(const FrameInputs& inputs, const FocusInputs* focus,
                                   const FrameOutputs& outputs, FrameRing::Slot& slot) {
  const ResolveSettings& settings = picture.plan().settings;
  const FrameOutputs native = native_outputs(settings, outputs);
  const cl::CommandQueue& queue = device.impl()->queue;
  const cl_uint zero = 0;
  const Counter counted = {counter(), ring.index_of(slot)};
  const std::size_t at = static_cast<std::size_t>(counted.index) * sizeof(zero);
  queue.enqueueFillBuffer(counter, zero, at, sizeof(zero));
  PassFrame frame = picture.frame(inputs, native, counted);
  frame.other_exposure = other_exposure;
  frame.keeps_merged = keeps;
  FocusInputs laid;  // outlives the frame
  if (focus != nullptr) {
    FocusInputs exposed = *focus;
    exposed.frame.exposure = inputs.exposure;
    exposed.frame.exposure_image = inputs.exposure_image;
    region->run(exposed, counted, slot.report, slot.passes.data());
    laid = native_focus(settings, *focus);
    region->lay_over(frame, laid);
  } else if (region) {
    region->forget();
  }
  picture.chain().run(frame, native, slot.report, slot.passes.data() + slot.report.passes.size());
  // Where nothing moves there are no sums, and nothing is what there is to tell.
  slot.measures_content = settings.control.measures_content;
  if (const ImageView sums = picture.chain().newest(Resource::kContentSums); sums) {
    queue.enqueueReadBuffer(borrow<cl::Buffer>(sums.memory), CL_FALSE, 0, sizeof(slot.content),
                            &slot.content);
  }
  // The first frame and those after a cut have none, and the buffer those of a frame before.
  if (const ImageView sums = picture.chain().newest(Resource::kMotionSums);
      sums && picture.has_history(inputs)) {
    queue.enqueueReadBuffer(borrow<cl::Buffer>(sums.memory), CL_FALSE, 0, sizeof(slot.motion), &slot.motion);
  }
  queue.enqueueReadBuffer(counter, CL_FALSE, at, sizeof(slot.non_finite), &slot.non_finite, nullptr,
                          &slot.done);
  queue.flush();
}

void ResolveService::Impl::forget() {
  picture.forget();
  if (region) region->forget();
}

FrameReport ResolveService::Impl::dispatch(const FrameInputs& inputs, const FocusInputs* focus,
                                           const FrameOutputs& outputs, const FrameSync& sync) {
  if (sync.done != nullptr) *sync.done = nullptr;
  FrameReport refused;
  refused.frame_index = inputs.frame_index;
  refused.render_extent = inputs.render_extent;
  try {
    refused.status = check(inputs, focus, outputs);
    if (refused.ok()) refused.status = check_events(sync.wait_for, device.context());
    for (const auto& [field, semaphores] : {std::pair{"wait_semaphores", sync.wait_semaphores},
                                            {"signal_semaphores", sync.signal_semaphores}}) {
      if (refused.ok()) refused.status = check_semaphores(field, semaphores, device.queue());
    }
    if (!refused.ok()) return refused;
    wait_in_queue(device.impl()->queue, sync.wait_for);
    for (Semaphore* semaphore : sync.wait_semaphores)
      check_ok(semaphore->wait());
    if (observer && !observer(inputs, focus)) observer = nullptr;
    FrameRing::Slot& slot = ring.begin();
    slot.report.frame_index = inputs.frame_index;
    slot.report.render_extent = inputs.render_extent;
    const Extent output = picture.chain().output_of(inputs);
    slot.report.output_extent = output;
    slot.report.ratio = {static_cast<float>(inputs.render_extent.width) / static_cast<float>(output.width),
                         static_cast<float>(inputs.render_extent.height) / static_cast<float>(output.height)};
    slot.report.used_previous =
        picture.has_history(inputs) && picture.plan().reads_history(inputs.render_extent, output);
    enqueue(inputs, focus, outputs, slot);
    advice.look_at(picture.plan(), inputs);
    ring.commit();
    picture.keep(inputs);
    for (Semaphore* semaphore : sync.signal_semaphores)
      check_ok(semaphore->signal());
    if (sync.done != nullptr)
      *sync.done = retained(slot.done);  // last, so that no event is left of a failed frame
    return slot.report;
  } catch (...) {
    forget();  // part of the frame may be queued; what it left behind is not to be trusted as history
    refused.status = caught("dispatch", device.info().name);
    return refused;
  }
}

ClearRegionPass* ResolveService::Impl::clear_pass(const ImageView& image) const {
  for (const auto& pass : picture.chain().passes()) {
    auto* clear = dynamic_cast<ClearRegionPass*>(pass.get());
    if (clear != nullptr && clear->serves(image)) return clear;
  }
  return nullptr;
}

ResolveService::ResolveService(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ResolveService::ResolveService(ResolveService&&) noexcept = default;
ResolveService& ResolveService::operator=(ResolveService&& other) noexcept {
  ResolveService incoming(std::move(other));
  impl_.swap(incoming.impl_);  // what this one was ends as `incoming`, which waits
  return *this;
}

ResolveService::~ResolveService() {
  if (!impl_) return;
  // The device may still write the counters of the ring.
  const Status status = finish();
  if (status.ok()) return;
  log_line(LogLevel::kWarning, fmt::format("closing the resolve service: {}", status.message()));
  never_free(std::move(impl_));
}

Result<ResolveService> ResolveService::create(const Device& device, const ResolvePlan& plan) {
  return create(device, plan, false);
}

Result<ResolveService> ResolveService::create(const Device& device, const ResolvePlan& plan, bool two_way) {
  if (plan.settings.targets.storage == Storage::kImage && !device.info().images) {
    return Status::unsupported(
        fmt::format("'{}' has no images; plan with buffer storage", device.info().name));
  }
  try {
    if (Status status = check_unedited(plan); !status.ok()) return status;
    auto impl = std::make_unique<Impl>(device, plan, two_way);
    if (two_way && plan.blurs()) {
      const Extent target = plan.settings.target_extent;
      impl->shown_velocity = allocate_image(device, target, plan.settings.velocity);
      impl->shown_depth = allocate_image(device, target, PixelFormat::kR32F);
    }
    impl->warm_up();
    return ResolveService(std::move(impl));
  } catch (...) {
    return caught("creating the resolve service", device.info().name);
  }
}

FrameReport ResolveService::dispatch(const FrameInputs& inputs, const FrameOutputs& outputs,
                                     const FrameSync& sync) {
  return impl_->dispatch(inputs, nullptr, outputs, sync);
}

FrameReport ResolveService::dispatch(const FrameInputs& inputs, const FocusInputs& focus,
                                     const FrameOutputs& outputs, const FrameSync& sync) {
  FocusInputs given = focus;
  given.frame.reset |= inputs.reset;
  return impl_->dispatch(inputs, &given, outputs, sync);
}

std::optional<FrameReport> ResolveService::next_completed() {
  return impl_->ring.next_completed();
}

void ResolveService::allow_timing_waits(bool allow) {
  const bool wait = allow && pass_timer(impl_->device) == PassTimer::kHostClock;
  impl_->picture.chain().wait_for_each_pass(wait);
  if (impl_->region) impl_->region->chain().wait_for_each_pass(wait);
}

Status ResolveService::clear(const ImageView& image, Extent render, const float value[4]) {
  if (!image) return Status::invalid("the image to clear is empty; it needs an allocation");
  if (image.storage != plan().settings.targets.storage) {
    return Status::invalid("the image to clear has another storage than the plan; they must agree");
  }
  if (render.width < 1 || render.height < 1 || render.width > image.extent.width ||
      render.height > image.extent.height) {
    return Status::invalid(
        fmt::format("the rectangle to clear is {}x{}; it must lie within 1x1 and the image's {}x{}",
                    render.width, render.height, image.extent.width, image.extent.height));
  }
  if (Status status = validate_layout(plan(), "image", image); !status.ok()) return status;
  ClearRegionPass* pass = impl_->clear_pass(image);
  if (pass == nullptr) {
    return Status::invalid(
        fmt::format("a clear of {} is not in the plan; set settings.targets.clear for a scene without a "
                    "covering background",
                    name_of(image.format)));
  }
  try {
    const PassFrame frame = impl_->picture.chain().frame({}, nullptr, {}, {});
    pass->clear(frame, image, render, value, nullptr);
    frame.queue.flush();
    return {};
  } catch (...) {
    return caught(pass->spec().kernel, impl_->device.info().name);
  }
}

void ResolveService::observe(FrameObserver observer) {
  impl_->observer = std::move(observer);
  impl_->forget();
}

Status ResolveService::finish() {
  return impl_->device.finish();
}

ImageView ResolveService::picture(PictureStage stage) const {
  const bool is_scaled = plan().is_dual() && impl_->picture.last_output() != plan().settings.output_extent;
  const bool is_resolved = stage == PictureStage::kResolved;
  if (!(is_resolved && plan().blurs()) && !is_scaled) return {};
  return impl_->picture.chain().newest(is_resolved ? Resource::kResolved : Resource::kBlurred);
}

Result<TileKinds> ResolveService::tile_kinds() const {
  const ImageView tiles = impl_->picture.chain().newest(Resource::kTileBlurs);
  if (!tiles)
    return Status::invalid("the plan has no motion blur and so no tiles; set settings.blur.shutter");
  try {
    const Extent extent = extent_of(Area::kBlurTiles, {{}, {}, impl_->picture.last_output()});
    std::vector<TileBlur> blurs(static_cast<std::size_t>(extent.area()));
    impl_->device.impl()->queue.enqueueReadBuffer(borrow<cl::Buffer>(tiles.memory), CL_TRUE, 0,
                                                  blurs.size() * sizeof(TileBlur), blurs.data());
    TileKinds found{extent, std::vector<std::uint8_t>(blurs.size())};
    std::transform(blurs.begin(), blurs.end(), found.kinds.begin(),
                   [](const TileBlur& blur) { return static_cast<std::uint8_t>(blur.kind); });
    return found;
  } catch (...) {
    return caught("reading the tiles of the motion blur", impl_->device.info().name);
  }
}

Result<ImageView> ResolveService::history() const {
  if (!plan().accumulates())
    return Status::invalid("the plan accumulates no history; choose the method temporal");
  if (!impl_->picture.leaves_history()) return ImageView();
  ImageView history = impl_->picture.chain().newest(Resource::kHistory);
  history.extent = impl_->picture.last_output();
  history.pitch = 0;
  return history;
}

const ResolvePlan& ResolveService::plan() const {
  return impl_->picture.plan();
}

const Device& ResolveService::device() const {
  return impl_->device;
}

}  // namespace quincunx
