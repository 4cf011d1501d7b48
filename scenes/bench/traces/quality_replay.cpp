// SPDX-License-Identifier: MIT
#include "bench/traces/quality_replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bench/harness/measuring.h"
#include "random.h"

namespace quincunx::traces {
namespace {

using bench::checked;
using scenes::Random;

constexpr double kToldWrong = 0.05;      // share of the picture, at most
constexpr double kFlipDeviation = 0.1;   // standard deviation of the logarithm, per class and method
constexpr double kCostDeviation = 0.2;   // per method
constexpr double kMeasuredWrong = 0.03;  // at most
constexpr std::uint64_t kHeldOutStream = 104729;
constexpr std::uint64_t kMeasuredStream = 7;

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

double rough_normal(Random& random) {  // the sum of twelve uniform ones
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

// Error added to a picture that is shown once more instead of the next one, by class.
constexpr std::array<double, kSceneClasses> kStale = {0, 0.1, 0.06, 0.05, 0.03, 0.06};
constexpr double kHistoryFrames = 6;  // until the young part of an accumulated picture has faded to 1/e
constexpr MethodVariant kWithoutHistory = {.method = Method::kBilinear};

double scale_of(double area) {
  return std::sqrt(area);
}

// A frame of a replay: how it was resolved.
struct Resolved {
  MethodVariant method;
  std::optional<MethodVariant> from = {};
  double weight = 1;
};

// How much history a method has: frames since it began or the shot did.
class History {
 public:
  double error(const QualityStage& stage, const SceneMix& mix, const MethodVariant& method,
               double area) const {
    const double steady = stage.machine->flip(mix, method, scale_of(area)).value();
    if (!uses_earlier_frames(method.method)) return steady;
    const double alone = std::max(steady, stage.machine->flip(mix, kWithoutHistory, scale_of(area)).value());
    const double frames = method.method == Method::kTemporal ? kHistoryFrames : 1;
    return steady + (alone - steady) * std::exp(-age(method) / frames);
  }
  void follow(const Resolved& how, bool cut) {
    if (cut) ages_.clear();
    std::vector<std::pair<MethodVariant, int>> kept;
    kept.emplace_back(how.method, age(how.method) + 1);
    if (how.from) kept.emplace_back(*how.from, age(*how.from) + 1);
    ages_ = std::move(kept);
  }

 private:
  int age(const MethodVariant& method) const {
    for (const auto& [of, age] : ages_) {
      if (of == method) return age;
    }
    return -1;
  }
  std::vector<std::pair<MethodVariant, int>> ages_;  // by method of the last frame, in frames; -1: none
};

QualityScore score_of(const QualityStage& stage, const std::vector<ReplayedFrame>& frames,
                      const std::vector<Resolved>& resolved) {
  QualityScore score;
  History history;
  double sum = 0;
  double shown_before = 0;
  int refreshes = 0;
  int changes = 0;
  for (std::size_t index = 0; index < frames.size(); ++index) {
    const FrameContent& content = stage.trace->content[index];
    const Resolved& how = resolved[index];
    history.follow(how, content.cut);
    double error = history.error(stage, content.mix, how.method, frames[index].area);
    if (how.from) {
      error = how.weight * error +
              (1 - how.weight) * history.error(stage, content.mix, *how.from, frames[index].area);
    }
    if (index >= kWarmUp) {
      double stale = 0;
      for (std::size_t i = 0; i < kSceneClasses; ++i)
        stale += content.mix.share[i] * kStale[i];
      for (int again = 1; again <= frames[index].dropped; ++again)
        sum += std::min(1.0, shown_before + again * stale);
      sum += error;
      refreshes += 1 + frames[index].dropped;
      score.dropped += frames[index].dropped;
      score.pixels += frames[index].area;
      changes += how.method == resolved[index - 1].method ? 0 : 1;
      ++score.frames;
    }
    shown_before = error;
  }
  score.flip = sum / refreshes;
  score.pixels /= score.frames;
  score.changes_per_second = changes * stage.display.refresh_hz / refreshes;
  return score;
}

// Replays a program that resolves frames as `next` says. `observe` is told of each what it took.
QualityScore replay_and_score(
    const QualityStage& stage, const ResolutionLadder& ladder,
    const std::function<std::pair<Extent, Resolved>()>& next,
    const std::function<void(const FrameTiming&, const Resolved&, double)>& observe) {
  std::vector<Resolved> resolved;
  std::vector<double> passes;
  const ReplayedProgram program = {
      .ladder = ladder,
      .observe =
          [&](const FrameTiming& timing) {
            observe(timing, resolved.at(timing.frame), passes.at(timing.frame));
          },
      .next =
          [&](std::size_t) {
            const auto [render, how] = next();
            const double area = ladder.area_fraction(render);
            passes.push_back(passes_ms(stage, ladder, how.method, area) +
                             (how.from ? passes_ms(stage, ladder, *how.from, area) : 0));
            resolved.push_back(how);
            return render;
          },
      .besides_ms = [&] { return passes.back(); }};
  return score_of(stage, replay(stage.trace->load, stage.display, program), resolved);
}

struct Best {
  double error = 1;
  double area = 0;
};

// Returns the best that a method can do for a frame; nothing where it does not fit into one refresh even on the lowest
// rung, but for the first method.
std::optional<Best> best_with(const QualityStage& stage, const ResolutionLadder& ladder, std::size_t index,
                              const MethodVariant& method) {
  const FrameLoad& load = stage.trace->load.frames[index];
  const double target_ms = stage.display.target_ms();
  const auto fits = [&](double area) {
    return load.gpu(area) * target_ms + passes_ms(stage, ladder, method, area) <= target_ms;
  };
  const double area = largest_area(ladder, fits);
  if (!fits(area) && !(method == stage.machine->methods().front())) return {};
  return Best{stage.machine->flip(stage.trace->content[index].mix, method, scale_of(area)).value(), area};
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
  constexpr MethodVariant kBalanced = {.method = Method::kTemporal, .preset = TemporalPreset::kBalanced};
  const double factor =
      machine.balanced_part * target_ms / built_in.resolve_ms(kBalanced, 0.71, output_megapixels).value();
  Random random(seed);
  std::map<std::pair<SceneClass, std::string>, double> flips;
  std::map<std::string, double> costs;
  std::vector<FrontPoint> points(built_in.points().begin(), built_in.points().end());
  for (FrontPoint& point : points) {
    const std::string method = name_of(point.method);
    const auto flip = flips.try_emplace({point.scene_class, method}, 0);
    if (flip.second) flip.first->second = std::exp(kFlipDeviation * rough_normal(random));
    const auto cost = costs.try_emplace(method, 0);
    if (cost.second) cost.first->second = factor * std::exp(kCostDeviation * rough_normal(random));
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

double passes_ms(const QualityStage& stage, const ResolutionLadder& ladder, const MethodVariant& method,
                 double area) {
  const double megapixels = static_cast<double>(ladder.output().area()) * 1e-6;
  return stage.machine->resolve_ms(method, scale_of(area), megapixels).value();
}

QualityScore replay_quality(const QualityStage& stage, QualityController& controller) {
  const auto next = [&] {
    const QualityChoice choice = controller.choice();
    return std::pair{choice.render_extent, Resolved{choice.method, choice.fading_from, choice.weight}};
  };
  return replay_and_score(stage, controller.ladder(), next,
                          [&](const FrameTiming& timing, const Resolved& resolved, double passes_ms) {
                            QualityFrame frame = {.timing = timing};
                            if (stage.times_passes) frame.resolve_ms = passes_ms;
                            frame.content =
                                told(stage.trace->content[timing.frame], stage.seed, timing.frame);
                            frame.content->judged = resolved.method.method == Method::kTemporal;
                            // Moving shadows have no reactive values.
                            if (!frame.content->judged) frame.content->light = 0;
                            checked(controller.observe(frame));
                          });
}

QualityScore replay_fixed(const QualityStage& stage, const ResolutionLadder& ladder,
                          ResolutionController* controller, const MethodVariant& method) {
  const auto next = [&] {
    return std::pair{controller != nullptr ? controller->next() : ladder.output(), Resolved{method}};
  };
  return replay_and_score(stage, ladder, next, [&](const FrameTiming& timing, const Resolved&, double) {
    if (controller != nullptr) checked(controller->observe(timing));
  });
}

QualityScore oracle(const QualityStage& stage, const ResolutionLadder& ladder) {
  QualityScore score;
  for (std::size_t index = kWarmUp; index < stage.trace->content.size(); ++index) {
    Best best;
    for (const MethodVariant& method : stage.machine->methods()) {
      const auto with = best_with(stage, ladder, index, method);
      if (with && with->error < best.error) best = *with;
    }
    score.flip += best.error;
    score.pixels += best.area;
    ++score.frames;
  }
  score.flip /= score.frames;
  score.pixels /= score.frames;
  return score;
}

}  // namespace quincunx::traces
