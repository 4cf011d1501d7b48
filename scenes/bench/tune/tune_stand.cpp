// SPDX-License-Identifier: MIT
#include "bench/tune/tune_stand.h"

#include <optional>
#include <utility>

namespace quincunx::bench {
namespace {

constexpr float kScale = 0.5f;  // of the viewport, and of the particles within it

scenes::SequenceSettings sequence_of(const TuneCase& what, const TuneEffort& effort) {
  scenes::SequenceSettings sequence;
  sequence.output = effort.output;
  sequence.scale_path = scenes::ScalePath::fixed({kScale, kScale}).value();
  sequence.jitter = scenes::Jitter::kHalton;
  sequence.shading = what.resolve.shading;
  sequence.frames = TuneEffort::kWarmUp + effort.frames;
  sequence.fps = effort.fps;
  return sequence;
}

// The middle of the picture.
scenes::FocusOptions focus_of(Extent output) {
  const Rectangle middle{output.width / 4, output.height / 4, (output.width + 1) / 2,
                         (output.height + 1) / 2};
  scenes::FocusOptions focus;
  focus.target.emplace().rectangle = middle;
  return focus;
}

Result<FrameFeed> open_feed(const scenes::FrameSource& stage, const TuneCase& what,
                            const TuneEffort& effort) {
  scenes::PartsSettings parts;
  std::optional<scenes::FocusOptions> focus;
  if (what.has_parts) {
    if (stage.scene().particles) parts.particles = scenes::PartSettings{.scale = kScale};
    focus = focus_of(effort.output);
  }
  std::vector<ResolveSettings> resolves = {what.resolve};
  if (what.only_camera_moves) {
    resolves.push_back(what.resolve);  // of a method that reads depth, so that frames have it
    resolves.back().method = Method::kTemporal;
  }
  return FrameFeed::create(stage, sequence_of(what, effort), resolves, parts, focus);
}

// Milliseconds of each pass of a frame. Some run twice, for the picture and for its focus.
std::map<std::string, double> pass_times(const FrameReport& report) {
  std::map<std::string, double> times;
  for (int i = 0; i < report.pass_count; ++i) {
    const PassReport& pass = report.passes[static_cast<std::size_t>(i)];
    times[pass.kernel] += pass.ms;
  }
  return times;
}

}  // namespace

Result<TuneStand> TuneStand::create(const scenes::FrameSource& stage, const TuneCase& what,
                                    const TuneEffort& effort) {
  auto feed = open_feed(stage, what, effort);
  if (!feed.ok()) return feed.status();
  const ResolvePlan& drawn = feed->plans().front();
  SceneNeeds needs = drawn.needs;
  if (what.only_camera_moves) needs.moving_objects = false;
  auto plan = plan_for(needs, drawn.settings);
  if (!plan.ok()) return plan.status();
  auto copy = CopyKernel::create(stage.device(), effort.output);
  if (!copy.ok()) return copy.status();
  TuneStand stand(stage.device(), std::move(feed).value(), std::move(plan).value(), std::move(copy).value());
  if (Status status = stand.allocate(); !status.ok()) return status;
  return stand;
}

Status TuneStand::allocate() {
  const ResolveSettings& settings = plan_.settings;
  const auto make = [&](Image& image, PixelFormat format, Storage storage) -> Status {
    auto made = device_.allocate(settings.output, format, storage);
    if (!made.ok()) return made.status();
    image = std::move(made).value();
    return {};
  };
  Status status = make(resolved_, settings.resolved, Storage::kBuffer);
  if (status.ok() && plan_.blurs()) status = make(blurred_, settings.resolved, Storage::kBuffer);
  if (status.ok() && settings.fades) status = make(other_, settings.resolved, Storage::kBuffer);
  if (status.ok() && settings.present)
    status = make(presented_, PixelFormat::kRGBA8, plan_.presented_storage());
  return status;
}

Result<double> TuneStand::time_copy() {
  const StepClock clock;
  Result<double> ms = copy_.run();
  if (!ms.ok() || pass_timer(device_) == PassTimer::kEvents) return ms;
  return clock.elapsed().ms;
}

Status TuneStand::resolve(ResolveService& service, FrameInputs inputs, PassTimes* times) {
  if (plan_.settings.fades) inputs.fading_from = other_.view();
  const FrameOutputs outputs{
      .resolved = resolved_.view(), .presented = presented_.view(), .blurred = blurred_.view()};
  const FocusInputs* focus = feed_.focus();
  const FrameReport accepted =
      focus != nullptr ? service.dispatch(inputs, *focus, outputs) : service.dispatch(inputs, outputs);
  if (!accepted.ok()) return accepted.status;
  if (Status status = service.finish(); !status.ok()) return status;
  const auto report = service.next_completed();
  if (!report) return Status::device("a finished frame has no report");
  if (times == nullptr) return report->status;
  for (const auto& [kernel, ms] : pass_times(*report))
    (*times)[kernel].push_back(ms);
  return report->status;
}

}  // namespace quincunx::bench
