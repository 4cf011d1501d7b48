// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_resolver.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>

#include "tools/program/clock.h"
#include "tools/sequence/exchange_format.h"

namespace quincunx::tools {
namespace {

// Inflating is several times cheaper than deflating, and inputs are smaller than outputs.
int reading_threads(int threads) {
  return std::max(threads / 4, 1);
}

int writing_threads(int threads) {
  return std::max(threads / 2, 1);
}

float float_of(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16, rest = static_cast<std::uint32_t>(half & 0x7fffu) << 13;
  const bool finite = (half & 0x7c00u) != 0x7c00u;
  const float value =
      finite ? std::bit_cast<float>(rest) * 0x1p112f : std::bit_cast<float>(rest | 0x7f800000u);
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) | sign);
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
      service_(std::move(service)),
      job_(std::move(job)),
      watch_(service_.plan(), job_.format.near_plane),
      writers_(writing_threads(job_.threads), 1) {}

Result<std::unique_ptr<SequenceResolver>> SequenceResolver::create(const Device& device,
                                                                   const ResolvePlan& plan, SequenceJob job) {
  auto service = ResolveService::create(device, plan);
  if (!service.ok()) return service.status();
  service->allow_timing_waits(true);
  auto resolver = std::unique_ptr<SequenceResolver>(
      new SequenceResolver(device, std::move(service).value(), std::move(job)));
  if (Status status = resolver->allocate(); !status.ok()) return status;
  return resolver;
}

Status SequenceResolver::allocate() {
  const ResolvePlan& plan = service_.plan();
  const auto make = [&](Image& image, Extent extent, PixelFormat format) -> Status {
    auto made = device_.allocate(extent, format);
    if (made.ok()) image = std::move(made).value();
    return made.status();
  };
  const Extent target = plan.settings.target_extent;
  for (DeviceFrame& frame : ring_) {
    if (!job_.format.recording.empty()) break;
    if (Status status = make(frame.colour, target, plan.settings.colour); !status.ok()) return status;
    if (plan.velocity == VelocitySource::kTarget) {
      if (Status status = make(frame.velocity, target, plan.settings.velocity); !status.ok()) return status;
    }
    if (plan.reads_depth) {
      if (Status status = make(frame.depth, target, PixelFormat::kR32F); !status.ok()) return status;
    }
    if (plan.reads_reactive) {
      if (Status status = make(frame.reactive, target, PixelFormat::kR8); !status.ok()) return status;
    }
  }
  if (Status status = make(linear_, plan.settings.output_extent, plan.settings.output.linear); !status.ok())
    return status;
  if (!presents()) return {};
  auto made = device_.allocate(plan.settings.output_extent, PixelFormat::kRGBA8, plan.presented_storage());
  if (made.ok()) presented_ = std::move(made).value();
  return made.status();
}

Status SequenceResolver::upload(const SequenceFrame& frame, const DeviceFrame& to) const {
  const auto copy = [&](const Image& image, const void* texels) {
    return image ? device_.upload(image.view(), frame.render, texels) : Status();
  };
  if (Status status = copy(to.colour, frame.colour.data()); !status.ok()) return status;
  if (Status status = copy(to.velocity, frame.velocity.data()); !status.ok()) return status;
  if (Status status = copy(to.depth, frame.depth.data()); !status.ok()) return status;
  return copy(to.reactive, frame.reactive.data());
}

Status SequenceResolver::camera_of(const SequenceFrame& frame, FrameInputs& inputs) const {
  const ResolvePlan& plan = service_.plan();
  const bool moves = (plan.reads_camera() || plan.keeps_previous_frame()) && !inputs.reset;
  if (!moves || !frame.world_to_ndc || !last_world_to_ndc_) return {};
  const auto motion = camera_motion(*frame.world_to_ndc, *last_world_to_ndc_, job_.format.near_plane);
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
  auto uploaded = quincunx::tools::upload(device_, service_.plan(), *frame.recorded);
  if (!uploaded.ok()) return uploaded.status();
  outcome_.upload_ms.push_back(ms_since(start));
  FrameInputs& inputs = uploaded->inputs;
  if (job_.exposure > 0) inputs.exposure = job_.exposure;
  inputs.reset |= last_ + 1 != frame.number;
  const FrameOutputs outputs = {linear_.view(), presented_.view()};
  FrameReport report = uploaded->focus ? service_.dispatch(inputs, *uploaded->focus, outputs)
                                       : service_.dispatch(inputs, outputs);
  if (!report.ok())
    return Status(report.status.code(), fmt::format("frame {}: {}", frame.number, report.status.message()));
  played_[static_cast<std::size_t>(count_ % 2)] = std::move(uploaded).value();
  last_ = frame.number;
  ++count_;
  return report;
}

Result<FrameReport> SequenceResolver::dispatch(const SequenceFrame& frame, const ScannedFrame& scanned) {
  if (frame.recorded) return dispatch_recorded(frame);
  const DeviceFrame& device_frame = ring_[static_cast<std::size_t>(count_ % 2)];
  const Clock::time_point start = Clock::now();
  if (Status status = upload(frame, device_frame); !status.ok()) return status;
  outcome_.upload_ms.push_back(ms_since(start));
  FrameInputs inputs;
  inputs.colour = device_frame.colour.view();
  inputs.velocity = device_frame.velocity.view();
  inputs.depth = device_frame.depth.view();
  inputs.reactive = device_frame.reactive.view();
  inputs.render_extent = frame.render;
  inputs.jitter = scanned.jitter;
  inputs.exposure = job_.exposure;
  // A frame that turned out bad while it was read may be missing here, too.
  inputs.reset = scanned.reset || last_ + 1 != frame.number;
  inputs.frame_index = static_cast<std::uint64_t>(frame.number);
  for (std::string& warning : watch_.see(frame, inputs.reset)) {
    spdlog::warn("{}", warning);
    outcome_.warnings.push_back(std::move(warning));
  }
  if (Status status = camera_of(frame, inputs); !status.ok()) return status;
  FrameReport report = service_.dispatch(inputs, {linear_.view(), presented_.view()});
  if (!report.ok()) return report.status;
  last_ = frame.number;
  last_world_to_ndc_ = frame.world_to_ndc;
  ++count_;
  return report;
}

Status SequenceResolver::download(Picture& picture) const {
  const Extent output = service_.plan().settings.output_extent;
  const auto texels = static_cast<std::size_t>(output.area()) * 4;
  const bool turns =
      service_.plan().settings.conventions.origin == Origin::kBottom;  // files begin at the top
  if (!presents() || job_.scores != nullptr) {
    auto pixels = std::make_shared<std::vector<float>>(texels);
    if (linear_.view().format == PixelFormat::kRGBA32F) {
      if (Status status = device_.download(linear_.view(), output, pixels->data()); !status.ok())
        return status;
    } else {
      std::vector<std::uint16_t> halves(texels);
      if (Status status = device_.download(linear_.view(), output, halves.data()); !status.ok())
        return status;
      std::transform(halves.begin(), halves.end(), pixels->begin(), float_of);
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
    const Status status = writers_.push([this, number, codes = std::move(picture.presented)] {
      return job_.output->write_presented(number, codes);
    });
    if (!status.ok()) return status;
  } else if (job_.output) {
    const Status status = writers_.push([this, number, linear = picture.linear, kept = frame.kept] {
      return job_.output->write_linear(number, *linear, kept);
    });
    if (!status.ok()) return status;
  }
  return job_.scores != nullptr
             ? job_.scores->add(number, std::move(picture.linear), {frame.render, frame.velocity})
             : Status();
}

Status SequenceResolver::resolve_frame(const ScannedFrame& scanned) {
  auto frame = ahead_->take();
  if (!frame.ok()) {
    if (!job_.skip_bad_frames) return frame.status();
    spdlog::warn("{}; it is skipped", frame.status().message());
    if (scanned.wanted) outcome_.skipped.push_back(scanned.number);
    ahead_->release();
    return {};
  }
  const Clock::time_point start = Clock::now();
  const auto report = dispatch(*frame.value(), scanned);
  if (!report.ok()) return report.status();
  Picture picture;
  if (scanned.wanted) {
    if (Status status = download(picture); !status.ok()) return status;
  }
  outcome_.resolve_ms.push_back(ms_since(start));
  if (scanned.wanted) {
    if (Status status = hand_over(*frame.value(), std::move(picture)); !status.ok()) return status;
    outcome_.resolved.push_back(scanned.number);
    outcome_.rows.push_back({.index = scanned.number,
                             .render = scanned.render,
                             .ratio = report->ratio,
                             .jitter = scanned.jitter,
                             .frame_ms = ms_since(last_delivery_),
                             .used_previous = report->used_previous});
    last_delivery_ = Clock::now();
  }
  ahead_->release();
  collect_reports();
  return {};
}

void SequenceResolver::collect_reports() {
  while (auto report = service_.next_completed())
    outcome_.reports.push_back(*report);
}

Status SequenceResolver::finish() {
  Status first = writers_.finish();
  if (job_.scores != nullptr) {
    Status scored = job_.scores->finish();
    if (first.ok()) first = scored;
  }
  Status done = service_.finish();
  collect_reports();
  return first.ok() ? done : first;
}

Status SequenceResolver::run(const std::function<void(std::int64_t)>& progress,
                             const std::atomic<bool>& stop) {
  std::vector<ScannedFrame> good;
  for (const ScannedFrame& frame : job_.scan.frames) {
    if (frame.problem.empty()) {
      good.push_back(frame);
    } else if (frame.wanted) {
      outcome_.skipped.push_back(frame.number);
    }
  }
  const Clock::time_point start = Clock::now();
  last_delivery_ = start;
  const int readers = reading_threads(job_.threads);
  ahead_ = std::make_unique<ReadAhead<SequenceFrame>>(
      good.size(), readers, readers + 1, [this, &good](std::size_t index, SequenceFrame& frame) {
        if (const std::string& folder = job_.format.recording; !folder.empty())
          return read_recorded(folder, good[index], service_.plan(), frame);
        return read_frame(job_.input.expand(good[index].number), job_.format, good[index],
                          service_.plan().settings.colour, frame);
      });
  Status status;
  for (std::size_t i = 0; i < good.size() && status.ok(); ++i) {
    status = stop ? Status::io("stopped by a signal; the files are whole, and --resume goes on")
                  : resolve_frame(good[i]);
    progress(static_cast<std::int64_t>(i) + 1);
  }
  const Status finished = finish();
  double resolving = 0;
  for (const double ms : outcome_.resolve_ms)
    resolving += ms / 1000;
  outcome_.busy = {
      {"reading", ahead_->busy_seconds()}, {"resolving", resolving}, {"writing", writers_.busy_seconds()}};
  if (job_.scores != nullptr) outcome_.busy.push_back({"measuring", job_.scores->busy_seconds()});
  outcome_.wall_seconds = ms_since(start) / 1000;
  ahead_.reset();  // it refers to `good`
  return status.ok() ? finished : status;
}

}  // namespace quincunx::tools
