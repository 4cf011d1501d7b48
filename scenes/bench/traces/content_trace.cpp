// SPDX-License-Identifier: MIT
#include "bench/traces/content_trace.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include "random.h"

namespace quincunx::traces {
namespace {

using scenes::Random;

constexpr double kToldWrong = 0.05;      // of the picture, at most
constexpr double kFlipDeviation = 0.1;   // of the logarithm, per class and method
constexpr double kCostDeviation = 0.2;   // per method
constexpr double kMeasuredWrong = 0.03;  // at most
constexpr std::uint64_t kHeldOutStream = 104729;
constexpr std::uint64_t kMeasuredStream = 7;

ErrorFront checked(Result<ErrorFront> front) {
  if (!front.ok()) throw std::logic_error(front.status().message());
  return std::move(front).value();
}

// Still, pan, objects, thin, light, zoom; scaled to sum 1.
SceneMix mix_from(std::array<double, kSceneClasses> shares) {
  double sum = 0;
  for (const double share : shares)
    sum += share;
  for (double& share : shares)
    share /= sum;
  return {shares};
}

SceneMix between(const SceneMix& a, const SceneMix& b, double part) {
  SceneMix mix;
  for (std::size_t i = 0; i < kSceneClasses; ++i)
    mix.share[i] = a.share[i] + part * (b.share[i] - a.share[i]);
  return mix;
}

double normal(Random& random) {  // the sum of twelve uniform ones
  double sum = -6;
  for (int i = 0; i < 12; ++i)
    sum += static_cast<double>(random.unit());
  return sum;
}

using Script = std::vector<FrameContent>;

// Shots of random length; `mix` is asked once a shot.
Script shots(Random& random, int shortest, int longest, bool cuts,
             const std::function<FrameContent(Random&)>& mix) {
  Script script;
  FrameContent at = mix(random);
  int left = 0;
  while (script.size() < kFrames) {
    at.cut = false;
    if (left-- == 0) {
      at = mix(random);
      at.cut = cuts;
      left = shortest + random.below(longest - shortest);
    }
    script.push_back(at);
  }
  return script;
}

// A walk with rests: one mix flows into the next.
Script walk(Random& random, int period, const FrameContent& from, const FrameContent& to) {
  Script script;
  const int start = random.below(period);
  for (int frame = 0; frame < kFrames; ++frame) {
    const double turn = static_cast<double>((frame + start) % period) / period;
    const double part = std::clamp(2 - std::abs(8 * turn - 4), 0.0, 1.0);
    script.push_back({between(from.mix, to.mix, part), from.speed_px + part * (to.speed_px - from.speed_px)});
  }
  return script;
}

std::vector<Script> development_scripts(Random& random) {
  const FrameContent still = {SceneMix::only(SceneClass::kStill)};
  const FrameContent pan = {mix_from({0, 9, 1, 0, 0, 0}), 8};
  const FrameContent fight = {mix_from({2, 2, 4, 0, 3, 0}), 12};
  const FrameContent wires = {mix_from({1, 2, 0, 3, 0, 0}), 3};
  const FrameContent lamps = {mix_from({2, 0, 0, 0, 3, 0}), 0};
  const FrameContent dolly = {mix_from({0, 1, 0, 0, 0, 4}), 5};
  const std::vector<FrameContent> all = {still, pan, fight, wires, lamps, dolly};
  const auto any = [all](Random& r) {
    return all[static_cast<std::size_t>(r.below(static_cast<int>(all.size())))];
  };
  return {walk(random, 600, still, pan), walk(random, 900, wires, fight), shots(random, 150, 400, true, any),
          shots(random, 60, 300, false, any)};
}

std::vector<Script> held_out_scripts(Random& random) {
  const auto any = [](Random& r) {
    std::array<double, kSceneClasses> shares{};
    for (double& share : shares)
      share = std::pow(static_cast<double>(r.unit()), 4.0);  // few of them count
    return FrameContent{mix_from(shares), 20 * static_cast<double>(r.unit())};
  };
  return {shots(random, 200, 700, true, any), shots(random, 90, 240, false, any),
          walk(random, 1100, any(random), any(random)), walk(random, 430, any(random), any(random))};
}

}  // namespace

ContentStatistics told(const FrameContent& content, std::uint64_t seed, std::size_t frame) {
  Random random(seed, frame);
  const auto share = [&](SceneClass scene_class) {
    const double wrong = kToldWrong * static_cast<double>(random.signed_unit());
    return std::clamp(content.mix.share[static_cast<std::size_t>(scene_class)] + wrong, 0.0, 1.0);
  };
  ContentStatistics told;
  told.thin = share(SceneClass::kThin);
  told.apart = std::min(1.0, share(SceneClass::kObjects) + told.thin);
  told.light = share(SceneClass::kLight);
  told.zoom = share(SceneClass::kZoom);
  told.moving = std::min(1.0, share(SceneClass::kPan) + told.apart + told.zoom);
  told.speed_px = content.speed_px;
  told.cut = content.cut;
  return told;
}

std::vector<ContentTrace> content_traces(Split split, std::uint64_t seed) {
  const bool held_out = split == Split::kHeldOut;
  std::vector<ContentTrace> list;
  std::size_t index = 0;
  for (LoadTrace& load : traces_of(split, seed)) {
    if (load.kind != TraceKind::kFeasible) continue;
    Random random(seed + (held_out ? kHeldOutStream : 0), index);
    std::vector<Script> scripts = held_out ? held_out_scripts(random) : development_scripts(random);
    list.push_back({std::move(load), std::move(scripts[index % scripts.size()])});
    ++index;
  }
  return list;
}

std::vector<ScriptedMachine> scripted_machines() {
  return {{"strong", 0.05}, {"weak", 0.3}};
}

ErrorFront front_of(const ScriptedMachine& machine, double target_ms, double output_megapixels,
                    std::uint64_t seed) {
  const ErrorFront& built_in = ErrorFront::built_in();
  constexpr FrontMethod kBalanced = {.method = Method::kTemporal, .preset = TemporalPreset::kBalanced};
  const double factor =
      machine.balanced_part * target_ms / built_in.resolve_ms(kBalanced, 0.71, output_megapixels).value();
  Random random(seed);
  std::map<std::pair<SceneClass, std::string>, double> flips;
  std::map<std::string, double> costs;
  std::vector<FrontPoint> points(built_in.points().begin(), built_in.points().end());
  for (FrontPoint& point : points) {
    const std::string method = name_of(point.method);
    const auto flip = flips.try_emplace({point.scene_class, method}, 0);
    if (flip.second) flip.first->second = std::exp(kFlipDeviation * normal(random));
    const auto cost = costs.try_emplace(method, 0);
    if (cost.second) cost.first->second = factor * std::exp(kCostDeviation * normal(random));
    point.flip = std::min(1.0, point.flip * flip.first->second);
    point.ms_per_megapixel *= cost.first->second;
    point.ms_spread *= cost.first->second;
  }
  return checked(ErrorFront::create(built_in.source(), std::move(points)));
}

ErrorFront measured_front(const ErrorFront& machine, std::uint64_t seed) {
  Random random(seed, kMeasuredStream);
  std::vector<FrontPoint> points(machine.points().begin(), machine.points().end());
  for (FrontPoint& point : points) {
    point.flip *= 1 + kMeasuredWrong * static_cast<double>(random.signed_unit());
    point.ms_per_megapixel *= 1 + kMeasuredWrong * static_cast<double>(random.signed_unit());
  }
  return checked(ErrorFront::create(machine.source(), std::move(points)));
}

}  // namespace quincunx::traces
