// SPDX-License-Identifier: MIT
#include "bench/traces/quality_replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace quincunx::traces {
namespace {

// What is added to the error of a picture that is shown once more instead of the next one, by class.
constexpr std::array<double, kSceneClasses> kStale = {0, 0.1, 0.06, 0.05, 0.03, 0.06};
constexpr double kHistoryFrames = 6;  // until the young part of an accumulated picture has faded to 1/e
constexpr FrontMethod kWithoutHistory = {.method = Method::kBilinear};

double scale_of(double area) {
  return std::sqrt(area);
}

// A frame of a replay: how it was resolved.
struct Resolved {
  FrontMethod method;
  std::optional<FrontMethod> from = {};
  double weight = 1;
};

// Frames with a method whose passes the program times; a controller is told of them.
class Program : public ReplayedProgram {
 public:
  Program(const QualityStage& stage, const ResolutionLadder& ladder) : stage_(&stage), ladder_(&ladder) {}
  const ResolutionLadder& ladder() const override { return *ladder_; }
  double besides_ms(std::size_t index) const override { return passes_.at(index); }
  const std::vector<Resolved>& resolved() const { return resolved_; }

 protected:
  Extent resolve(Extent render, const Resolved& how) {
    resolved_.push_back(how);
    const double area = ladder_->area_fraction(render);
    passes_.push_back(passes_ms(*stage_, *ladder_, how.method, area) +
                      (how.from ? passes_ms(*stage_, *ladder_, *how.from, area) : 0));
    return render;
  }
  const QualityStage& stage() const { return *stage_; }

 private:
  const QualityStage* stage_;
  const ResolutionLadder* ladder_;
  std::vector<Resolved> resolved_;
  std::vector<double> passes_;
};

class QualityProgram final : public Program {
 public:
  QualityProgram(const QualityStage& stage, QualityController& controller)
      : Program(stage, controller.ladder()), controller_(&controller) {}
  void observe(const FrameTiming& timing) override {
    QualityFrame frame = {.timing = timing};
    if (stage().times_passes) frame.resolve_ms = besides_ms(timing.frame);
    frame.content = told(stage().trace->content[timing.frame], stage().seed, timing.frame);
    const Status status = controller_->observe(frame);
    if (!status.ok()) throw std::logic_error(status.message());
  }
  Extent next(std::size_t) override {
    const QualityChoice choice = controller_->choice();
    return resolve(choice.render, {choice.method, choice.fading_from, choice.weight});
  }

 private:
  QualityController* controller_;
};

class FixedProgram final : public Program {
 public:
  FixedProgram(const QualityStage& stage, const ResolutionLadder& ladder, ResolutionController* controller,
               const FrontMethod& method)
      : Program(stage, ladder), controller_(controller), method_(method) {}
  void observe(const FrameTiming& timing) override {
    if (controller_ == nullptr) return;
    const Status status = controller_->observe(timing);
    if (!status.ok()) throw std::logic_error(status.message());
  }
  Extent next(std::size_t) override {
    return resolve(controller_ != nullptr ? controller_->next() : ladder().output(), {method_});
  }

 private:
  ResolutionController* controller_;
  FrontMethod method_;
};

// How much history a method has: frames since it began or the shot did.
class History {
 public:
  double error(const QualityStage& stage, const SceneMix& mix, const FrontMethod& method, double area) const {
    const double steady = stage.machine->flip(mix, method, scale_of(area)).value();
    if (!uses_earlier_frames(method.method)) return steady;
    const double alone = std::max(steady, stage.machine->flip(mix, kWithoutHistory, scale_of(area)).value());
    const double frames = method.method == Method::kTemporal ? kHistoryFrames : 1;
    return steady + (alone - steady) * std::exp(-age(method) / frames);
  }
  void follow(const Resolved& how, bool cut) {
    if (cut) ages_.clear();
    std::vector<std::pair<FrontMethod, int>> kept;
    kept.emplace_back(how.method, age(how.method) + 1);
    if (how.from) kept.emplace_back(*how.from, age(*how.from) + 1);
    ages_ = std::move(kept);
  }

 private:
  int age(const FrontMethod& method) const {
    for (const auto& [of, age] : ages_) {
      if (of == method) return age;
    }
    return -1;
  }
  std::vector<std::pair<FrontMethod, int>> ages_;  // of the methods of the last frame; -1: none
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
      score.area += frames[index].area;
      changes += how.method == resolved[index - 1].method ? 0 : 1;
      ++score.frames;
    }
    shown_before = error;
  }
  score.error = sum / refreshes;
  score.area /= score.frames;
  score.changes_per_second = changes * stage.display.refresh_hz / refreshes;
  return score;
}

}  // namespace

double passes_ms(const QualityStage& stage, const ResolutionLadder& ladder, const FrontMethod& method,
                 double area) {
  const double megapixels = static_cast<double>(ladder.output().area()) * 1e-6;
  return stage.machine->resolve_ms(method, scale_of(area), megapixels).value();
}

QualityScore replay_quality(const QualityStage& stage, QualityController& controller) {
  QualityProgram program(stage, controller);
  const auto frames = replay(stage.trace->load, stage.display, program);
  return score_of(stage, frames, program.resolved());
}

QualityScore replay_fixed(const QualityStage& stage, const ResolutionLadder& ladder,
                          ResolutionController* controller, const FrontMethod& method) {
  FixedProgram program(stage, ladder, controller, method);
  const auto frames = replay(stage.trace->load, stage.display, program);
  return score_of(stage, frames, program.resolved());
}

}  // namespace quincunx::traces
