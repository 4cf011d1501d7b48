// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_resolver.h"

#include <fmt/format.h>
#include <half.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "tools/program/clock.h"
#include "tools/record/exchange_format.h"

namespace quincunx::tools {
namespace {

// Inflating is several times cheaper than deflating, and inputs are smaller than outputs.
int reading_threads(int threads) {
  return std::max(threads / 4, 1);
}

int writing_threads(int threads) {
  return std::max(threads / 2, 1);
}

// Returns what multiplies light before it is displayed.
float exposure_of(const SequenceFrame& frame, const ResolvePlan& plan, float asked) {
  if (plan.settings.colour == PixelFormat::kRGBA8) return 1;  // which it went through already
  const float told = frame.recorded ? frame.recorded->inputs.exposure : frame.exposure;
  const float image = frame.recorded ? frame.recorded->exposure_image.value_or(1) : 1;
  return (asked > 0 ? asked : told > 0 ? told : 1) * image;
}

// RGBA, tightly packed.
template <typename Value>
void turn_rows(std::vector<Value>& picture, Extent extent) {
  const auto row = static_cast<std::ptrdiff_t>(extent.width) * 4;
  for (int y = 0; y < extent.height / 2; ++y)
    std::swap_ranges(picture.begin() + y * row, picture.begin() + (y + 1) * row,
                     picture.end() - (y + 1) * row);
}

}  // namespace

SequenceResolver::SequenceResolver(const Device& device, ResolveService service, SequenceJob job)
    : device_(device),
      forward_{std::move(service)},
      job_(std::move(job)),
      histories_(job_.memory),
      watch_(forward_.service.plan(), job_.format.near_plane),
      writers_(writing_threads(job_.threads), 1) {
  good_ = std::exchange(job_.scan.frames, {});
  scanned_ = good_.size();
  std::erase_if(good_, [this](const ScannedFrame& frame) {
    if (!frame.problem.empty() && frame.wanted) outcome_.skipped.push_back(frame.number);
    return !frame.problem.empty();
  });
}

Result<std::unique_ptr<SequenceResolver>> SequenceResolver::create(const Device& device,
                                                                   const ResolvePlan& plan, SequenceJob job) {
  const bool two_way = job.format.two_way > 0;
  auto service = two_way ? TwoWay::create(device, plan) : ResolveService::create(device, plan);
  if (!service.ok()) return service.status();
  service->allow_timing_waits(true);
  auto resolver = std::unique_ptr<SequenceResolver>(
      new SequenceResolver(device, std::move(service).value(), std::move(job)));
  if (two_way) {
    ResolveSettings settings = plan.settings;  // of history alone
    settings.blur.shutter = settings.sharpness = 0;
    settings.output.present = false;
    const auto make = [&](const SceneNeeds& needs) -> Result<ResolveService> {
      const auto made_plan = plan_for(needs, settings);
      return made_plan.ok() ? TwoWay::create(device, made_plan.value()) : made_plan.status();
    };
    auto backward = make(plan.needs);
    if (!backward.ok()) return backward.status();
    resolver->backward_.emplace(Stream{std::move(backward).value()});
    settings.temporal.noise = 0;
    SceneNeeds opaque = plan.needs;
    opaque.background = true;
    for (Stream* stream : {&resolver->forward_, &*resolver->backward_}) {
      if (!resolver->job_.format.channels.has(InputPlane::kAlbedo)) break;
      auto albedo = make(opaque);
      if (!albedo.ok()) return albedo.status();
      stream->albedo.emplace(std::move(albedo).value());
    }
  }
  if (Status status = resolver->allocate(); !status.ok()) return status;
  return resolver;
}

Status SequenceResolver::allocate(Stream& stream) const {
  const ResolvePlan& plan = stream.service.plan();
  const auto make = [&](Image& image, PixelFormat format) -> Status {
    auto made = device_.allocate(plan.settings.target_extent, format);
    if (made.ok()) image = std::move(made).value();
    return made.status();
  };
  for (DeviceFrame& frame : stream.ring) {
    if (!job_.format.recording.empty()) break;
    for (const InputImage& input : kInputs) {
      const PlannedBuffer* planned = planned_for(plan, input);
      if (planned == nullptr) continue;
      if (Status status = make(frame[plane_of(input)], planned->format); !status.ok()) return status;
    }
    if (stream.albedo) {
      if (Status status = make(frame[InputPlane::kAlbedo], plan.settings.colour); !status.ok()) return status;
    }
  }
  return {};
}

Status SequenceResolver::allocate() {
  if (Status status = allocate(forward_); !status.ok()) return status;
  if (backward_) {
    if (Status status = allocate(*backward_); !status.ok()) return status;
  }
  const ResolvePlan& plan = forward_.service.plan();
  auto linear = device_.allocate(plan.settings.output_extent, plan.settings.output.linear);
  if (!linear.ok()) return linear.status();
  linear_ = std::move(linear).value();
  if (forward_.albedo) {
    auto albedo = device_.allocate(plan.settings.output_extent, plan.settings.output.linear);
    if (!albedo.ok()) return albedo.status();
    albedo_ = std::move(albedo).value();
  }
  if (!presents()) return {};
  auto made = device_.allocate(plan.settings.output_extent, PixelFormat::kRGBA8, plan.presented_storage());
  if (made.ok()) presented_ = std::move(made).value();
  return made.status();
}

Status SequenceResolver::upload(const SequenceFrame& frame, const DeviceFrame& to) const {
  for (std::size_t p = 0; p < kPlaneCount; ++p) {
    if (!to.values[p]) continue;
    const Status status = device_.upload(to.values[p].view(), frame.render, frame.texels.values[p].data());
    if (!status.ok()) return status;
  }
  return {};
}

Status SequenceResolver::camera_of(const Stream& stream, const SequenceFrame& frame,
                                   FrameInputs& inputs) const {
  const ResolvePlan& plan = stream.service.plan();
  const bool moves = (plan.reads_camera() || plan.keeps_previous_frame()) && !inputs.reset;
  if (!moves || !frame.world_to_ndc || !stream.last_world_to_ndc) return {};
  const auto motion = camera_motion(*frame.world_to_ndc, *stream.last_world_to_ndc, job_.format.near_plane);
  if (!motion) {
    if (!plan.reads_camera()) return {};  // it would only have bettered the picture
    return Status::io(fmt::format("'{}' has an attribute 'worldToNDC' that cannot be inverted",
                                  job_.input.expand(frame.number)));
  }
  inputs.camera = *motion;
  return {};
}

Result<FrameReport> SequenceResolver::dispatch_recorded(const SequenceFrame& frame) {
  const Clock::time_point start = Clock::now();
  ResolveService& service = forward_.service;
  auto uploaded = quincunx::tools::upload(device_, service.plan(), *frame.recorded);
  if (!uploaded.ok()) return uploaded.status();
  outcome_.upload_ms.add(ms_since(start));
  FrameInputs& inputs = uploaded->inputs;
  if (job_.exposure > 0) inputs.exposure = job_.exposure;
  inputs.reset |= forward_.last + 1 != frame.number;
  const FrameOutputs outputs = {linear_.view(), presented_.view()};
  FrameReport report = uploaded->focus ? service.dispatch(inputs, *uploaded->focus, outputs)
                                       : service.dispatch(inputs, outputs);
  if (!report.ok())
    return Status(report.status.code(), fmt::format("frame {}: {}", frame.number, report.status.message()));
  forward_.played[static_cast<std::size_t>(forward_.count % 2)] = std::move(uploaded).value();
  forward_.last = frame.number;
  ++forward_.count;
  return report;
}

// Uploads the frame as the stream's next one.
Result<FrameInputs> SequenceResolver::inputs_of(Stream& stream, const SequenceFrame& frame,
                                                const ScannedFrame& scanned) {
  const bool backward = &stream != &forward_;
  const DeviceFrame& device_frame = stream.ring[static_cast<std::size_t>(stream.count % 2)];
  const Clock::time_point start = Clock::now();
  if (Status status = upload(frame, device_frame); !status.ok()) return status;
  outcome_.upload_ms.add(ms_since(start));
  FrameInputs inputs;
  for (const InputImage& input : kInputs) {
    if (input.viewport != nullptr) inputs.*input.image = device_frame[plane_of(input)].view();
  }
  inputs.render_extent = frame.render;
  inputs.jitter = scanned.jitter;
  inputs.exposure = job_.exposure > 0 ? job_.exposure : frame.exposure;
  // A frame that turned out bad while it was read may be missing here, too.
  inputs.reset =
      backward ? stream.last - 1 != frame.number : scanned.reset || stream.last + 1 != frame.number;
  inputs.frame_index = static_cast<std::uint64_t>(frame.number);
  if (Status status = camera_of(stream, frame, inputs); !status.ok()) return status;
  stream.last = frame.number;
  stream.last_world_to_ndc = frame.world_to_ndc;
  ++stream.count;
  if (backward) return inputs;
  for (std::string& warning : watch_.see(frame, inputs.reset)) {
    spdlog::warn("{}", warning);
    outcome_.warnings.push_back(std::move(warning));
  }
  return inputs;
}

Result<FrameReport> SequenceResolver::dispatch(const SequenceFrame& frame, const ScannedFrame& scanned) {
  if (frame.recorded) return dispatch_recorded(frame);
  const auto inputs = inputs_of(forward_, frame, scanned);
  if (!inputs.ok()) return inputs.status();
  FrameReport report = forward_.service.dispatch(inputs.value(), {linear_.view(), presented_.view()});
  if (!report.ok()) return report.status;
  return report;
}

Status SequenceResolver::download(Picture& picture) const {
  const Extent output = forward_.service.plan().settings.output_extent;
  const auto texels = static_cast<std::size_t>(output.area()) * 4;
  const bool turns =
      forward_.service.plan().settings.conventions.origin == Origin::kBottom;  // files begin at the top
  if (!presents() || job_.scores != nullptr) {
    auto pixels = std::make_shared<std::vector<float>>(texels);
    if (linear_.view().format == PixelFormat::kRGBA32F) {
      if (Status status = device_.download(linear_.view(), output, pixels->data()); !status.ok())
        return status;
    } else {
      std::vector<std::uint16_t> halves(texels);
      if (Status status = device_.download(linear_.view(), output, halves.data()); !status.ok())
        return status;
      std::transform(halves.begin(), halves.end(), pixels->begin(), imath_half_to_float);
    }
    if (turns) turn_rows(*pixels, output);
    picture.linear = std::move(pixels);
  }
  if (!presents()) return {};
  picture.presented.resize(texels);
  const Status status = device_.download(presented_.view(), output, picture.presented.data());
  if (turns) turn_rows(picture.presented, output);
  return status;
}

// To those who write and measure; waits where they cannot keep up.
Status SequenceResolver::hand_over(const SequenceFrame& frame, Picture picture) {
  const std::int64_t number = frame.number;
  if (presents()) {
    const Status status =
        writers_.push([this, number, codes = std::move(picture.presented), kept = frame.kept] {
          return job_.output->write_presented(number, codes, kept);
        });
    if (!status.ok()) return status;
  } else if (job_.output) {
    if (!has_clipped_ && job_.output->clips(*picture.linear)) {
      has_clipped_ = true;
      outcome_.warnings.push_back(
          fmt::format("frame {}, and perhaps later ones, has light above 65504, the largest half, which is "
                      "written in its "
                      "place; --store float keeps it",
                      number));
      spdlog::warn("{}", outcome_.warnings.back());
    }
    const Status status =
        writers_.push([this, number, exposure = exposure_of(frame, forward_.service.plan(), job_.exposure),
                       linear = picture.linear, kept = frame.kept] {
          return job_.output->write_linear(number, *linear, exposure, kept);
        });
    if (!status.ok()) return status;
  }
  return job_.scores != nullptr
             ? job_.scores->add(number, std::move(picture.linear), {frame.render, frame.velocity()})
             : Status();
}

// The next frame that was read; null where it is bad and may be: it is released then.
Result<SequenceFrame*> SequenceResolver::take(const ScannedFrame& scanned, bool backward) {
  auto frame = ahead_->take();
  if (frame.ok()) return frame.value();
  if (!job_.skip_bad_frames) return frame.status();
  if (!backward) {
    spdlog::warn("{}; it is skipped", frame.status().message());
    if (scanned.wanted) outcome_.skipped.push_back(scanned.number);
  }
  ahead_->release();
  return nullptr;
}

Status SequenceResolver::resolve_frame(const ScannedFrame& scanned) {
  const auto frame = take(scanned, false);
  if (!frame.ok() || frame.value() == nullptr) return frame.status();
  const Clock::time_point start = Clock::now();
  const auto report = dispatch(*frame.value(), scanned);
  if (!report.ok()) return report.status();
  if (scanned.wanted) {
    if (Status status = deliver(*frame.value(), scanned, report.value()); !status.ok()) return status;
  }
  outcome_.resolve_ms.add(ms_since(start));
  ahead_->release();
  collect_reports();
  return {};
}

// Takes the picture of a frame that is wanted to where it goes.
Status SequenceResolver::deliver(const SequenceFrame& frame, const ScannedFrame& scanned,
                                 const FrameReport& report) {
  Picture picture;
  if (Status status = download(picture); !status.ok()) return status;
  if (Status status = hand_over(frame, std::move(picture)); !status.ok()) return status;
  outcome_.resolved.push_back(scanned.number);
  outcome_.rows.push_back({.index = scanned.number,
                           .render = scanned.render,
                           .ratio = report.ratio,
                           .jitter = scanned.jitter,
                           .frame_ms = ms_since(last_delivery_),
                           .used_previous = report.used_previous});
  last_delivery_ = Clock::now();
  return {};
}

// As TwoWay::add(), for the albedo of the frame that the stream took last.
Status SequenceResolver::add_albedo(Stream& stream, FrameInputs inputs, std::size_t index, bool merges,
                                    bool keeps) {
  if (!stream.albedo) return {};
  inputs.colour = stream.ring[static_cast<std::size_t>((stream.count - 1) % 2)][InputPlane::kAlbedo].view();
  inputs.exposure = 1;  // albedo is no light
  auto history = merges ? histories_.take(~index) : KeptHistory();
  if (!history.ok()) return history.status();
  const FrameReport report = TwoWay::add(*stream.albedo, inputs, merges, keeps ? &history.value() : nullptr);
  if (!report.ok()) return report.status;
  return keeps ? histories_.put(~index, std::move(history).value()) : Status();
}

Status SequenceResolver::add_forward(std::size_t index) {
  const ScannedFrame& scanned = good_[index];
  const auto taken = take(scanned, false);
  if (!taken.ok() || taken.value() == nullptr) return taken.status();
  const Clock::time_point start = Clock::now();
  SequenceFrame& frame = *taken.value();
  const auto inputs = inputs_of(forward_, frame, scanned);
  if (!inputs.ok()) return inputs.status();
  KeptFrame kept;
  KeptHistory history;
  kept.report = TwoWay::add(forward_.service, inputs.value(), false, scanned.wanted ? &history : nullptr);
  if (!kept.report.ok()) return kept.report.status;
  if (Status status = add_albedo(forward_, inputs.value(), index, false, scanned.wanted); !status.ok())
    return status;
  if (scanned.wanted) {
    if (Status status = histories_.put(index, std::move(history)); !status.ok()) return status;
    kept.frame.number = frame.number;
    kept.frame.render = frame.render;
    kept.frame.kept = frame.kept;
    if (job_.scores != nullptr)
      kept.frame.texels[InputPlane::kVelocity] = frame.texels[InputPlane::kVelocity];
    kept.inputs = without_images(inputs.value());
    kept_.emplace(index, std::move(kept));
  }
  outcome_.resolve_ms.add(ms_since(start));
  ahead_->release();
  collect_reports();
  return {};
}

// Gives a frame that was read backwards motion to the next one, which was read before it.
void SequenceResolver::turn_motion(SequenceFrame& frame, const ScannedFrame& scanned) {
  const std::span<Vec2> motion = frame.velocity();
  MotionSamples own = {frame.render,
                       scanned.jitter,
                       {motion.begin(), motion.end()},
                       {frame.depth().begin(), frame.depth().end()}};
  if (backward_->last - 1 == frame.number) {
    std::ranges::copy(turned_motion(own, later_), motion.begin());
  } else {
    for (Vec2& velocity : motion)
      velocity = {-velocity.x, -velocity.y};  // as if it went on
  }
  later_ = std::move(own);
}

Status SequenceResolver::add_backward(std::size_t index, const TwoWayWindow& window) {
  const ScannedFrame& scanned = good_[index];
  const auto taken = take(scanned, true);
  if (!taken.ok() || taken.value() == nullptr) return taken.status();
  const Clock::time_point start = Clock::now();
  if (index == window.turn) backward_->last = -1;
  if (job_.format.next_motion == NextMotion::kTurned) turn_motion(*taken.value(), scanned);
  const auto inputs = inputs_of(*backward_, *taken.value(), scanned);
  if (!inputs.ok()) return inputs.status();
  const auto kept = kept_.find(index);
  // The frame where the run begins knows nothing of later ones; those ahead of the window wait for their own run.
  const bool merges = !inputs->reset && index <= window.last && kept != kept_.end();
  auto history = merges ? histories_.take(index) : KeptHistory();
  if (!history.ok()) return history.status();
  const FrameReport report =
      TwoWay::add(backward_->service, inputs.value(), merges, merges ? &history.value() : nullptr);
  if (!report.ok()) return report.status;
  if (Status status = add_albedo(*backward_, inputs.value(), index, merges, merges); !status.ok())
    return status;
  if (merges) {
    if (Status status = histories_.put(index, std::move(history).value()); !status.ok()) return status;
  }
  if (forward_.last == scanned.number) {
    Status status = TwoWay::turn(backward_->service, forward_.service);
    if (status.ok() && forward_.albedo) status = TwoWay::turn(*backward_->albedo, *forward_.albedo);
    if (!status.ok()) return status;
  }
  outcome_.resolve_ms.add(ms_since(start));
  ahead_->release();
  collect_reports();
  return {};
}

Status SequenceResolver::show(std::size_t index) {
  const auto found = kept_.find(index);
  if (found == kept_.end()) return {};  // it turned out bad
  const KeptFrame& kept = found->second;
  const auto history = histories_.take(index);
  if (!history.ok()) return history.status();
  if (forward_.albedo) {
    const auto albedo = histories_.take(~index);
    if (!albedo.ok()) return albedo.status();
    const FrameReport shown =
        TwoWay::show(*forward_.albedo, kept.inputs, albedo.value(), {albedo_.view(), {}});
    if (!shown.ok()) return shown.status;
  }
  const FrameReport report = TwoWay::show(forward_.service, kept.inputs, history.value(),
                                          {linear_.view(), presented_.view()}, albedo_.view());
  if (!report.ok()) return report.status;
  if (Status status = deliver(kept.frame, good_[index], kept.report); !status.ok()) return status;
  kept_.erase(found);
  collect_reports();
  return {};
}

void SequenceResolver::collect_reports() {
  while (auto report = forward_.service.next_completed())
    outcome_.measured.add(*report);
  while (auto report = backward_ ? backward_->service.next_completed() : std::nullopt)
    outcome_.measured.add(*report);
  while (forward_.albedo && (forward_.albedo->next_completed() || backward_->albedo->next_completed())) {
  }
}

Status SequenceResolver::finish() {
  Status first = writers_.finish();
  if (job_.scores != nullptr) {
    Status scored = job_.scores->finish();
    if (first.ok()) first = scored;
  }
  Status done = forward_.service.finish();
  collect_reports();
  return first.ok() ? done : first;
}

std::vector<SequenceResolver::Step> SequenceResolver::steps_of(
    const std::vector<TwoWayWindow>& windows) const {
  std::vector<Step> steps;
  std::size_t next = place_.frame;
  for (std::size_t i = place_.window; i < windows.size(); ++i) {
    while (next <= windows[i].turn)
      steps.push_back({next++});
    for (std::size_t frame = windows[i].turn + 1; frame-- > windows[i].first;)
      steps.push_back({frame, true});
  }
  while (!backward_ && next < good_.size())
    steps.push_back({next++});
  return steps;
}

Status SequenceResolver::show_window(const TwoWayWindow& window) {
  Status status;
  for (std::size_t shown = window.first; shown <= window.last && status.ok(); ++shown)
    status = show(shown);
  ++place_.window;
  return status;
}

Result<bool> SequenceResolver::run_steps(const std::function<void(std::int64_t)>& progress,
                                         const std::atomic<bool>& stop) {
  const auto windows = backward_ ? two_way_windows(good_, job_.format.two_way) : std::vector<TwoWayWindow>();
  const std::vector<Step> steps = steps_of(windows);
  const int readers = reading_threads(job_.threads);
  ahead_ = std::make_unique<ReadAhead<SequenceFrame>>(
      steps.size(), readers, readers + 1,
      [this, &steps, backward = backward_format(job_.format)](std::size_t index, SequenceFrame& frame) {
        const ScannedFrame& scanned = good_[steps[index].frame];
        const ResolvePlan& plan = forward_.service.plan();
        if (const std::string& folder = job_.format.recording; !folder.empty())
          return read_recorded(folder, scanned, plan, frame);
        return read_frame(job_.input.expand(scanned.number), steps[index].backward ? backward : job_.format,
                          scanned, plan.settings.colour, frame);
      });
  const auto done_before = place_.steps;
  std::optional<std::size_t> bad;
  Status status;
  for (std::size_t i = 0; i < steps.size() && status.ok() && !bad; ++i) {
    const auto [frame, backward] = steps[i];
    status = stop         ? Status::io("stopped by a signal; the files are whole, and --resume goes on")
             : backward   ? add_backward(frame, windows[place_.window])
             : !backward_ ? resolve_frame(good_[frame])
                          : add_forward(frame);
    if (backward && status.ok() && frame == windows[place_.window].first)
      status = show_window(windows[place_.window]);
    if (backward_ && !backward && status.ok() && forward_.last != good_[frame].number) bad = frame;
    ++place_.steps;
    progress(static_cast<std::int64_t>(place_.steps * scanned_ / (done_before + steps.size())));
  }
  outcome_.busy.front().seconds += ahead_->busy_seconds();
  ahead_.reset();  // it refers to `steps`
  if (!status.ok()) return status;
  if (!bad) return true;
  place_.frame = *bad;
  good_.erase(good_.begin() + static_cast<std::ptrdiff_t>(*bad));
  if (*bad < good_.size()) good_[*bad].reset = true;
  return false;
}

Status SequenceResolver::run(const std::function<void(std::int64_t)>& progress,
                             const std::atomic<bool>& stop) {
  const Clock::time_point start = Clock::now();
  last_delivery_ = start;
  outcome_.busy = {{"reading", 0}};
  Result<bool> ended = false;
  while (ended.ok() && !ended.value())
    ended = run_steps(progress, stop);
  const Status finished = finish();
  outcome_.busy.push_back({"resolving", outcome_.resolve_ms.total_ms() / 1000});
  outcome_.busy.push_back({"writing", writers_.busy_seconds()});
  if (job_.scores != nullptr) outcome_.busy.push_back({"measuring", job_.scores->busy_seconds()});
  outcome_.wall_seconds = ms_since(start) / 1000;
  return ended.ok() ? finished : ended.status();
}

}  // namespace quincunx::tools
