// SPDX-License-Identifier: MIT
#include "bench/tune/tune_storages.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace quincunx::bench {
namespace {

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
      if (Status status = copy(*view, inputs.render, image); !status.ok()) return status;
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

struct Way {
  ResolveService service;
  Storage storage;      // of what it reads
  Samples copies = {};  // whole frames, in copies of the same round
};

Result<Way> open_way(const Device& device, const ResolvePlan& like, const ResolveSettings& settings) {
  const auto plan = plan_for(like.needs, settings);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(device, plan.value());
  if (!service.ok()) return service.status();
  Way way{std::move(service).value(), settings.storage};
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
  std::optional<Way> buffers, images, floats;
};

Result<Ways> open_ways(const Device& device, const ResolvePlan& plan) {
  Ways ways;
  const auto open = [&](std::optional<Way>& way, const ResolveSettings& settings) -> Status {
    auto made = open_way(device, plan, settings);
    if (!made.ok()) return made.status();
    way.emplace(std::move(made).value());
    return {};
  };
  ResolveSettings settings = plan.settings;
  settings.storage = Storage::kBuffer;
  Status status = open(ways.buffers, settings);
  if (status.ok() && plan.accumulates()) {
    settings.temporal.history = PixelFormat::kRGBA32F;
    status = open(ways.floats, settings);
    settings.temporal.history = plan.settings.temporal.history;
  }
  settings.storage = Storage::kImage;
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
  const Storage drawn = stand->plan().settings.storage;
  StoredCopies copies(stage.device(), drawn == Storage::kImage ? Storage::kBuffer : Storage::kImage);
  for (int frame = 0; frame < TuneEffort::kWarmUp + effort.frames; ++frame) {
    auto inputs = stand->feed().next();
    if (!inputs.ok()) return inputs.status();
    auto copied = ways->images ? copies.of(inputs.value()) : inputs;
    if (!copied.ok()) return copied.status();
    const auto copy_ms = stand->time_copy();
    if (!copy_ms.ok()) return copy_ms.status();
    for (std::optional<Way>* way : {&ways->buffers, &ways->images, &ways->floats}) {
      if (!*way) continue;
      PassTimes times;
      const FrameInputs& own = (*way)->storage == drawn ? inputs.value() : copied.value();
      if (Status status = stand->resolve((*way)->service, own, &times); !status.ok()) return status;
      if (frame >= TuneEffort::kWarmUp) (*way)->copies.push_back(sum_of(times) / copy_ms.value());
    }
    stand->feed().release();
  }
  const auto median = [](const std::optional<Way>& way) { return way ? median_of(way->copies) : 0; };
  return TunedStorage{what.name, median(ways->buffers), median(ways->images), median(ways->floats)};
}

}  // namespace

Result<std::vector<TunedStorage>> time_storages(const scenes::FrameSource& stage,
                                                const std::vector<TuneCase>& cases, const TuneEffort& effort,
                                                const DeviceProfile& profile) {
  std::vector<TunedStorage> storages;
  for (const Method method : {Method::kBilinear, Method::kQuincunx, Method::kTemporal}) {
    TuneCase what{.name = name_of(method), .resolve = {}};
    what.resolve.method = method;
    what.resolve.present = false;
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
