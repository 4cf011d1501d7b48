// SPDX-License-Identifier: MIT
#include "bench/tune/tune_stand.h"

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

Result<Services> open_services(const Device& device, const ResolvePlan& plan,
                               std::span<const DeviceProfile> profiles) {
  Services services(profiles.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    auto service = ResolveService::create(device.with_profile(profiles[i]), plan);
    if (service.ok()) {
      services[i] = std::move(service).value();
      services[i]->allow_timing_waits(true);
    } else if (i == 0) {
      return service.status();
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

  Result<FrameInputs> of(FrameInputs inputs) {
    std::array<Image, 4>& images = frames_[next_];
    next_ = 1 - next_;
    std::size_t at = 0;
    for (ImageView* view : {&inputs.colour, &inputs.depth, &inputs.velocity, &inputs.reactive}) {
      Image& image = images[at++];
      if (!*view) continue;
      if (Status status = copy(*view, inputs.render_extent, image); !status.ok()) return status;
      *view = image.view();
    }
    return inputs;
  }

 private:
  Status copy(const ImageView& from, Extent render, Image& to) {
    if (!to.view()) {
      auto made = device_.allocate(from.extent, from.format, storage_);
      if (!made.ok()) return made.status();
      to = std::move(made).value();
    }
    texels_.resize(static_cast<std::size_t>(render.area()) * bytes_per_pixel(from.format));
    if (Status status = device_.download(from, render, texels_.data()); !status.ok()) return status;
    return device_.upload(to.view(), render, texels_.data());
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

Result<StorageWay> open_way(const Device& device, const ResolvePlan& like, const ResolveSettings& settings) {
  const auto plan = plan_for(like.needs, settings);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(device, plan.value());
  if (!service.ok()) return service.status();
  StorageWay way{std::move(service).value(), settings.targets.storage};
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

Result<Ways> open_ways(const Device& device, const ResolvePlan& plan) {
  Ways ways;
  const auto open = [&](std::optional<StorageWay>& way, const ResolveSettings& settings) -> Status {
    auto made = open_way(device, plan, settings);
    if (!made.ok()) return made.status();
    way.emplace(std::move(made).value());
    return {};
  };
  ResolveSettings settings = plan.settings;
  settings.targets.storage = Storage::kBuffer;
  Status status = open(ways.buffers, settings);
  if (status.ok() && plan.accumulates()) {
    settings.temporal.history = PixelFormat::kRGBA32F;
    status = open(ways.floats, settings);
    settings.temporal.history = plan.settings.temporal.history;
  }
  settings.targets.storage = Storage::kImage;
  if (status.ok() && device.info().images) status = open(ways.images, settings);
  if (!status.ok()) return status;
  return ways;
}

Result<TunedStorage> time_storage(const scenes::FrameSource& stage, const TuneCase& what,
                                  const TuneEffort& effort, const DeviceProfile& profile) {
  auto stand = TuneStand::create(stage, what, effort);
  if (!stand.ok()) return stand.status();
  auto ways = open_ways(stage.device().with_profile(profile), stand->plan());
  if (!ways.ok()) return ways.status();
  const Storage drawn = stand->plan().settings.targets.storage;
  StoredCopies copies(stage.device(), drawn == Storage::kImage ? Storage::kBuffer : Storage::kImage);
  for (int frame = 0; frame < TuneEffort::kWarmUp + effort.frames; ++frame) {
    auto inputs = stand->feed().next();
    if (!inputs.ok()) return inputs.status();
    auto copied = ways->images ? copies.of(inputs.value()) : inputs;
    if (!copied.ok()) return copied.status();
    const auto copy_ms = stand->time_copy();
    if (!copy_ms.ok()) return copy_ms.status();
    for (std::optional<StorageWay>* way : {&ways->buffers, &ways->images, &ways->floats}) {
      if (!*way) continue;
      PassTimes times;
      const FrameInputs& own = (*way)->storage == drawn ? inputs.value() : copied.value();
      if (Status status = stand->resolve((*way)->service, own, &times); !status.ok()) return status;
      if (frame >= TuneEffort::kWarmUp) (*way)->copies.push_back(sum_of(times) / copy_ms.value());
    }
    stand->feed().release();
  }
  const auto median = [](const std::optional<StorageWay>& way) { return way ? median_of(way->copies) : 0; };
  return TunedStorage{what.name, median(ways->buffers), median(ways->images), median(ways->floats)};
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
    auto made = device_.allocate(settings.output_extent, format, storage);
    if (!made.ok()) return made.status();
    image = std::move(made).value();
    return {};
  };
  Status status = make(linear_, settings.output.linear, Storage::kBuffer);
  if (status.ok() && settings.control.fades) status = make(other_, settings.output.linear, Storage::kBuffer);
  if (status.ok() && settings.output.present)
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
  if (plan_.settings.control.fades) inputs.fading_from = other_.view();
  const FrameOutputs outputs{.linear = linear_.view(), .presented = presented_.view()};
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

Result<CaseTimes> time_case(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                            std::span<const DeviceProfile> profiles) {
  auto stand = TuneStand::create(stage, what, effort);
  if (!stand.ok()) return stand.status();
  auto services = open_services(stage.device(), stand->plan(), profiles);
  if (!services.ok()) return services.status();
  CaseTimes times;
  times.shapes.resize(profiles.size());
  for (int frame = 0; frame < TuneEffort::kWarmUp + effort.frames; ++frame) {
    auto inputs = stand->feed().next();
    if (!inputs.ok()) return inputs.status();
    const bool counts = frame >= TuneEffort::kWarmUp;
    auto copy_ms = stand->time_copy();
    if (!copy_ms.ok()) return copy_ms.status();
    if (counts) times.copy_ms.push_back(copy_ms.value());
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      const std::size_t at = (i + static_cast<std::size_t>(frame)) % profiles.size();
      std::optional<ResolveService>& service = services.value()[at];
      if (!service) continue;
      const Status status = stand->resolve(*service, inputs.value(), counts ? &times.shapes[at] : nullptr);
      if (!status.ok()) return status;
    }
    stand->feed().release();
  }
  return times;
}

Result<std::vector<TunedStorage>> time_storages(const scenes::FrameSource& stage,
                                                const std::vector<TuneCase>& cases, const TuneEffort& effort,
                                                const DeviceProfile& profile) {
  std::vector<TunedStorage> storages;
  for (const Method method : {Method::kBilinear, Method::kQuincunx, Method::kTemporal}) {
    TuneCase what{.name = name_of(method), .resolve = {}};
    what.resolve.method = method;
    what.resolve.output.present = false;
    const bool is_wanted = std::any_of(cases.begin(), cases.end(),
                                       [&what](const TuneCase& one) { return one.name == what.name; });
    if (!is_wanted) continue;
    auto storage = time_storage(stage, what, effort, profile);
    if (!storage.ok()) return storage.status();
    storages.push_back(std::move(storage).value());
  }
  return storages;
}

}  // namespace quincunx::bench
