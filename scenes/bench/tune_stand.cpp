// SPDX-License-Identifier: MIT
#include "bench/tune_stand.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace quincunx::bench {
namespace {

constexpr float kScale = 0.5f;  // scale of the viewport, and of the particles within it

scenes::SequenceSettings sequence_of(const TuneCase& what, const TuneEffort& effort) {
  scenes::SequenceSettings sequence;
  sequence.output = effort.output;
  sequence.scale_path = scenes::ScalePath::fixed({kScale, kScale}).value();
  sequence.jitter = scenes::Jitter::kHalton;
  sequence.shading = what.resolve.targets.shading;
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

FrameFeed open_feed(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort) {
  scenes::PartsSettings parts;
  std::optional<scenes::FocusOptions> focus;
  if (what.has_parts) {
    if (stage.scene().particles) parts.particles = scenes::PartSettings{.scale = kScale};
    focus = focus_of(effort.output);
  }
  std::vector<ResolveSettings> resolves = {what.resolve};
  if (what.only_camera_moves) {
    resolves.push_back(what.resolve);  // for a method that reads depth, so that frames have it
    resolves.back().method = Method::kTemporal;
  }
  return FrameFeed::create(stage, sequence_of(what, effort), resolves, parts, focus);
}

// Milliseconds of each pass of a frame. Some run twice, for the picture and for its focus.
std::map<std::string, double> pass_times(const FrameReport& report) {
  std::map<std::string, double> times;
  for (const PassReport& pass : report.passes)
    times[pass.kernel] += pass.ms;
  return times;
}

ResolveSettings settings_of(Method method) {
  ResolveSettings settings;
  settings.method = method;
  settings.output.present = false;
  return settings;
}

using Services = std::vector<std::optional<ResolveService>>;

Services open_services(const Device& device, const ResolvePlan& plan,
                       std::span<const DeviceProfile> profiles) {
  Services services(profiles.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    auto service = ResolveService::create(device.with_profile(profiles[i]), plan);
    if (i == 0 || service.ok()) {
      services[i] = checked(std::move(service));
      services[i]->allow_timing_waits(true);
    } else {
      spdlog::info("a shape is not tried: {}", service.status().message());
    }
  }
  return services;
}

// A frame's inputs in another storage, copied by the host. Those of the frame before stay as they are: a method may
// read them.
class StoredCopies {
 public:
  StoredCopies(const Device& device, Storage storage) : device_(device), storage_(storage) {}

  FrameInputs of(FrameInputs inputs) {
    std::array<Image, 4>& images = frames_[next_];
    next_ = 1 - next_;
    std::size_t at = 0;
    for (ImageView* view : {&inputs.colour, &inputs.depth, &inputs.velocity, &inputs.reactive}) {
      Image& image = images[at++];
      if (!*view) continue;
      copy(*view, inputs.render_extent, image);
      *view = image.view();
    }
    return inputs;
  }

 private:
  void copy(const ImageView& from, Extent render, Image& to) {
    if (!to.view()) to = checked(device_.allocate(from.extent, from.format, storage_));
    texels_.resize(static_cast<std::size_t>(render.area()) * bytes_per_pixel(from.format));
    checked(device_.download(from, render, texels_.data()));
    checked(device_.upload(to.view(), render, texels_.data()));
  }

  Device device_;
  Storage storage_;
  std::array<std::array<Image, 4>, 2> frames_;
  std::size_t next_ = 0;
  std::vector<unsigned char> texels_;
};

struct StorageWay {
  ResolveService service;
  Storage storage;      // storage of its inputs
  Samples copies = {};  // whole frames, in copies of the same round
};

StorageWay open_way(const Device& device, const ResolvePlan& like, const ResolveSettings& settings) {
  const auto plan = checked(plan_for(like.needs, settings));
  auto service = checked(ResolveService::create(device, plan));
  StorageWay way{std::move(service), settings.targets.storage};
  way.service.allow_timing_waits(true);
  return way;
}

double sum_of(const PassTimes& times) {
  double sum = 0;
  for (const auto& [kernel, samples] : times)
    sum += samples.back();
  return sum;
}

// Buffers, images where the device has them, float history where there is one.
struct Ways {
  std::optional<StorageWay> buffers, images, floats;
};

Ways open_ways(const Device& device, const ResolvePlan& plan) {
  Ways ways;
  ResolveSettings settings = plan.settings;
  settings.targets.storage = Storage::kBuffer;
  ways.buffers.emplace(open_way(device, plan, settings));
  if (plan.accumulates()) {
    settings.temporal.history = PixelFormat::kRGBA32F;
    ways.floats.emplace(open_way(device, plan, settings));
    settings.temporal.history = plan.settings.temporal.history;
  }
  settings.targets.storage = Storage::kImage;
  if (device.info().images) ways.images.emplace(open_way(device, plan, settings));
  return ways;
}

TunedStorage time_storage(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                          const DeviceProfile& profile) {
  auto stand = TuneStand::create(stage, what, effort);
  auto ways = open_ways(stage.device().with_profile(profile), stand.plan());
  const Storage drawn = stand.plan().settings.targets.storage;
  StoredCopies copies(stage.device(), drawn == Storage::kImage ? Storage::kBuffer : Storage::kImage);
  for (int frame = 0; frame < TuneEffort::kWarmUp + effort.frames; ++frame) {
    const FrameInputs inputs = stand.feed().next();
    const FrameInputs copied = ways.images ? copies.of(inputs) : inputs;
    const auto copy_ms = stand.time_copy();
    for (std::optional<StorageWay>* way : {&ways.buffers, &ways.images, &ways.floats}) {
      if (!*way) continue;
      PassTimes times;
      const FrameInputs& own = (*way)->storage == drawn ? inputs : copied;
      stand.resolve((*way)->service, own, &times);
      if (frame >= TuneEffort::kWarmUp) (*way)->copies.push_back(sum_of(times) / copy_ms);
    }
    stand.feed().release();
  }
  const auto median = [](const std::optional<StorageWay>& way) {
    return way ? std::optional(median_of(way->copies)) : std::nullopt;
  };
  return TunedStorage{what.name, median_of(ways.buffers->copies), median(ways.images), median(ways.floats)};
}

}  // namespace

TuneStand TuneStand::create(const scenes::FrameSource& stage, const TuneCase& what,
                            const TuneEffort& effort) {
  auto feed = open_feed(stage, what, effort);
  const ResolvePlan& drawn = feed.plans().front();
  SceneNeeds needs = drawn.needs;
  if (what.only_camera_moves) needs.moving_objects = false;
  auto plan = checked(plan_for(needs, drawn.settings));
  auto copy = checked(CopyKernel::create(stage.device(), effort.output));
  TuneStand stand(stage.device(), std::move(feed), std::move(plan), std::move(copy));
  stand.allocate();
  return stand;
}

void TuneStand::allocate() {
  const ResolveSettings& settings = plan_.settings;
  const auto make = [&](PixelFormat format, Storage storage) {
    return checked(device_.allocate(settings.output_extent, format, storage));
  };
  linear_ = make(settings.output.linear, Storage::kBuffer);
  if (settings.control.fades) other_ = make(settings.output.linear, Storage::kBuffer);
  if (settings.output.present) presented_ = make(PixelFormat::kRGBA8, plan_.presented_storage());
}

double TuneStand::time_copy() {
  const StepClock clock;
  const double ms = checked(copy_.run());
  return pass_timer(device_) == PassTimer::kEvents ? ms : clock.elapsed().ms;
}

void TuneStand::resolve(ResolveService& service, FrameInputs inputs, PassTimes* times) {
  if (plan_.settings.control.fades) inputs.fading_from = other_.view();
  const FrameOutputs outputs{.linear = linear_.view(), .presented = presented_.view()};
  const FocusInputs* focus = feed_.focus();
  const FrameReport accepted =
      focus != nullptr ? service.dispatch(inputs, *focus, outputs) : service.dispatch(inputs, outputs);
  checked(accepted.status);
  checked(service.finish());
  const auto report = service.next_completed();
  if (!report) throw Failure(Status::device("a finished frame has no report"));
  checked(report->status);
  if (times == nullptr) return;
  for (const auto& [kernel, ms] : pass_times(*report))
    (*times)[kernel].push_back(ms);
}

std::vector<TuneCase> tune_cases() {
  std::vector<TuneCase> cases = {{"point", settings_of(Method::kPoint)},
                                 {"bilinear", settings_of(Method::kBilinear)},
                                 {"lanczos2", settings_of(Method::kLanczos2)},
                                 {"noise", settings_of(Method::kNoise)},
                                 {"noise-offset", settings_of(Method::kNoiseOffset)},
                                 {"quincunx", settings_of(Method::kQuincunx)},
                                 {"reprojected", settings_of(Method::kQuincunx)},
                                 {"camera", settings_of(Method::kQuincunx)},
                                 {"temporal", settings_of(Method::kTemporal)},
                                 {"checkerboard", settings_of(Method::kTemporal)}};
  cases[0].resolve.output.present = true;
  cases[1].resolve.sharpness = 0.5f;
  cases[1].resolve.control.measures_content = cases[1].resolve.control.fades = true;
  cases[5].resolve.blur.shutter = 0.5f;
  cases[5].resolve.checks_motion = true;
  cases[6].resolve.quincunx.form = TwoFrameForm::kReprojected;
  cases[6].resolve.conventions.velocity_jittered = true;  // it is not, but this costs the same
  cases[7].only_camera_moves = true;
  cases[8].resolve.temporal.preset = TemporalPreset::kQuality;
  cases[8].resolve.temporal.noise = 0.1f;
  cases[8].resolve.conventions.sky_motion = SkyMotion::kEvidence;
  cases[8].resolve.conventions.drawn_velocity = DrawnVelocity::kDilated;  // nor is this; about the same
  cases[9].resolve.temporal.preset = TemporalPreset::kFast;
  cases[9].resolve.targets.shading = Shading::kCheckerboard;
  cases[9].has_parts = true;
  return cases;
}

Result<std::vector<TuneCase>> tune_cases(const std::vector<std::string>& names) {
  const std::vector<TuneCase> all = tune_cases();
  if (names.empty()) return all;
  std::vector<TuneCase> chosen;
  std::string known;
  for (const TuneCase& one : all) {
    known += (known.empty() ? "" : ", ") + one.name;
    if (std::find(names.begin(), names.end(), one.name) != names.end()) chosen.push_back(one);
  }
  for (const std::string& name : names) {
    const bool is_known =
        std::any_of(all.begin(), all.end(), [&name](const TuneCase& one) { return one.name == name; });
    if (!is_known)
      return Status::invalid(fmt::format("--tune-cases has '{}'; the cases are {}", name, known));
  }
  return chosen;
}

CaseTimes time_case(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                    std::span<const DeviceProfile> profiles) {
  auto stand = TuneStand::create(stage, what, effort);
  auto services = open_services(stage.device(), stand.plan(), profiles);
  CaseTimes times;
  times.shapes.resize(profiles.size());
  for (int frame = 0; frame < TuneEffort::kWarmUp + effort.frames; ++frame) {
    const FrameInputs inputs = stand.feed().next();
    const bool counts = frame >= TuneEffort::kWarmUp;
    auto copy_ms = stand.time_copy();
    if (counts) times.copy_ms.push_back(copy_ms);
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      const std::size_t at = (i + static_cast<std::size_t>(frame)) % profiles.size();
      std::optional<ResolveService>& service = services[at];
      if (service) stand.resolve(*service, inputs, counts ? &times.shapes[at] : nullptr);
    }
    stand.feed().release();
  }
  return times;
}

std::vector<TunedStorage> time_storages(const scenes::FrameSource& stage, const std::vector<TuneCase>& cases,
                                        const TuneEffort& effort, const DeviceProfile& profile) {
  std::vector<TunedStorage> storages;
  for (const Method method : {Method::kBilinear, Method::kQuincunx, Method::kTemporal}) {
    TuneCase what{.name = name_of(method), .resolve = {}};
    what.resolve.method = method;
    what.resolve.output.present = false;
    const bool is_wanted = std::any_of(cases.begin(), cases.end(),
                                       [&what](const TuneCase& one) { return one.name == what.name; });
    if (is_wanted) storages.push_back(time_storage(stage, what, effort, profile));
  }
  return storages;
}

}  // namespace quincunx::bench
