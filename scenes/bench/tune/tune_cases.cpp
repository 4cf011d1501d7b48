// SPDX-License-Identifier: MIT
#include "bench/tune/tune_cases.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace quincunx::bench {
namespace {

ResolveSettings settings_of(Method method) {
  ResolveSettings settings;
  settings.method = method;
  settings.present = false;
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

}  // namespace

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
  cases[0].resolve.present = true;
  cases[1].resolve.sharpness = 0.5f;
  cases[1].resolve.measures_content = cases[1].resolve.fades = true;
  cases[5].resolve.blur.shutter = 0.5f;
  cases[6].resolve.quincunx.form = TwoFrameForm::kReprojected;
  cases[7].only_camera_moves = true;
  cases[8].resolve.temporal.preset = TemporalPreset::kQuality;
  cases[8].resolve.far = FarMotion::kEvidence;
  cases[8].resolve.drawn_velocity = DrawnVelocity::kDilated;  // it is not, but that costs about the same
  cases[9].resolve.temporal.preset = TemporalPreset::kFast;
  cases[9].resolve.shading = Shading::kCheckerboard;
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

}  // namespace quincunx::bench
