// SPDX-License-Identifier: MIT
#include "quincunx/predictive_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cost_model.h"
#include "level_tracker.h"
#include "presentation_backlog.h"

namespace quincunx {
namespace {

// All found on the development traces; docs/control.md says what each does.
constexpr double kHeadroom = 0.002;  // of the target, while the backlog rests
constexpr double kRest = 0.1;        // backlog that is let be, in refreshes
constexpr double kRestSigmas = 5;    // and more of it with noise
constexpr double kRecovery = 0.04;   // of the target per refresh of backlog above the rest
constexpr double kUrgentFrom = 0.4;  // in refreshes: from here the answer grows with the square, too
constexpr double kUrgent = 0.5;
constexpr double kLargestRecovery = 0.3;
constexpr double kOverdraw = 0.008;    // of the target: spent to keep a little backlog when times are noisy
constexpr double kNoisy = 0.015;       // sigma from which they are
constexpr double kUsableSlack = 0.92;  // that a frame like the worst may use up
constexpr double kWorstSigmas = 2;
constexpr double kDeepestCut = 0.6;  // of the target: lowest aim in answer to one frame
constexpr double kLargeMove = 0.9;   // area ratio below which the cost model is doubted
constexpr double kBandDown = 0.05;   // dead bands just after a change, in area
constexpr double kBandUp = 0.012;
constexpr double kBandFade = 110;  // frames; then they shrink to
constexpr double kLeastBandDown = 0.009;
constexpr double kLeastBandUp = 0.006;
constexpr double kBandSigmas = 0.7;      // but never below the noise of the level
constexpr int kRestFrames = 3;           // between a change and a rise
constexpr double kTightHeadroom = 0.01;  // without slack: this, and
constexpr double kTightSigmas = 4;
constexpr double kTightExcess = 1.1;  // of the excess that recurs
constexpr double kTightTrend = 2;
constexpr double kTightBandDown = 0.008;
constexpr double kLeastExcess = 0.04;     // of the target: smaller ones are noise
constexpr double kFollowHeadroom = 0.05;  // below the processor's time
constexpr double kBlurRate = 0.1;

class PredictiveController final : public ResolutionController {
 public:
  static Result<std::unique_ptr<ResolutionController>> create(const PredictiveSettings& settings) {
    if (Status status = check(settings); !status.ok()) return status;
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<ResolutionController>(
        new PredictiveController(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "predictive"; }

 private:
  static constexpr std::uint64_t kRemembered = 16;

  PredictiveController(ResolutionLadder steps, const PredictiveSettings& settings)
      : ResolutionController(std::move(steps), settings.target_ms),
        settings_(settings),
        cost_(first_fixed_part(settings)),
        backlog_(settings.buffers) {
    chosen_.fill(ladder().area_fraction(ladder().top()));
  }

  static Status check(const PredictiveSettings& settings) {
    if (Status status = check_target(settings.target_ms); !status.ok()) return status;
    if (settings.buffers < 2 || settings.buffers > 8) {
      return Status::invalid(fmt::format("buffers is {}; it must lie in [2, 8]", settings.buffers));
    }
    if (!(settings.fixed_part >= 0 && settings.fixed_part <= 0.9)) {
      return Status::invalid(fmt::format("fixed_part is {}; it must lie in [0, 0.9]", settings.fixed_part));
    }
    const BlurAware& blur = settings.blur_aware;
    if (!(blur.start_px >= 0 && blur.full_px > blur.start_px && std::isfinite(blur.full_px))) {
      return Status::invalid(
          fmt::format("blur_aware is {} to {} px; the first must be at least 0 and below the second",
                      blur.start_px, blur.full_px));
    }
    if (!(blur.lowest_scale > 0 && blur.lowest_scale <= 1)) {
      return Status::invalid(
          fmt::format("blur_aware.lowest_scale is {}; it must lie in (0, 1]", blur.lowest_scale));
    }
    return {};
  }

  static double first_fixed_part(const PredictiveSettings& settings) {
    return settings.calibration ? settings.calibration->fixed_part().value_or(settings.fixed_part)
                                : settings.fixed_part;
  }

  int choose(const FrameTiming& timing) override {
    const double area = ladder().area_fraction(timing.render);
    backlog_.observe({.gpu_ms = timing.gpu_ms,
                      .cpu_ms = timing.cpu_ms,
                      .interval_ms = timing.interval_ms,
                      .queued = timing.queued,
                      .missed_vsyncs = timing.missed_vsyncs},
                     target_ms());
    cost_.learn(area, timing.gpu_ms);
    level_.observe(cost_.work(area), timing.gpu_ms);
    cpu_ms_[cpu_count_++ % cpu_ms_.size()] = timing.cpu_ms;
    blur_px_ += kBlurRate * (timing.blur_px - blur_px_);
    ++since_change_;

    next_ = timing.next_frame == 0 ? timing.frame + 1 : timing.next_frame;
    first_unknown_ = timing.frame + 1;
    const int result = std::min(wanted_rung(timing), ladder().highest_within(blur_limit()));
    if (result != rung()) since_change_ = 0;
    chosen_[next_ % kRemembered] = ladder().area_fraction(result);
    return result;
  }

  // Backlog when the frames that are under way are done, if the level is this.
  double backlog_then(double level) const {
    double backlog = backlog_.now();
    const std::uint64_t known = next_ > kRemembered ? next_ - kRemembered + 1 : 0;
    for (std::uint64_t frame = std::max(first_unknown_, known); frame < next_; ++frame) {
      backlog = std::max(0.0, backlog + level * cost_.work(chosen_[frame % kRemembered]) - target_ms());
    }
    return backlog;
  }

  // The time that the next frame may take.
  double aim() const {
    const double target = target_ms();
    const double sigma = level_.sigma();
    if (!has_slack()) {
      const double expected =
          std::max(kTightSigmas * sigma, kTightExcess * level_.recurring_excess() / target);
      const double headroom = kTightHeadroom + expected + kTightTrend * std::max(0.0, level_.trend());
      return target * std::max(0.5, 1 - headroom);
    }
    const double behind = backlog_then(level_.mean_level()) / target;
    const double urgent = std::max(0.0, behind - kUrgentFrom);
    const double recovery = kRecovery * (behind - kRest - kRestSigmas * sigma) + kUrgent * urgent * urgent;
    return target * (1 - kHeadroom - std::clamp(recovery, sigma > kNoisy ? -kOverdraw : 0, kLargestRecovery));
  }

  int wanted_rung(const FrameTiming& timing) const {
    const double now = ladder().area_fraction(rung());
    if (timing.cpu_ms > std::max(target_ms(), timing.gpu_ms)) {
      if (settings_.cpu_bound == CpuBound::kFollow && cpu_target() > target_ms()) {
        return move_to(cost_.area_for(cpu_target() * (1 - kFollowHeadroom) / level_.mean_level()), now);
      }
      if (level_.level() * cost_.work(now) <= target_ms()) return rung();
    }
    if (const auto least = area_to_survive(now)) return std::min(rung(), ladder().highest_within(*least));
    if (level_.suspect() > 0) return rung();
    const double work = aim() / level_.mean_level();
    double area = cost_.area_for(work);
    if (area < kLargeMove * now) area = std::min(area, cost_.cautious_area_for(work, now));
    return move_to(area, now);
  }

  // After an outlier: the area at which the next frame would just be in time if the outlier was a step.
  // Nothing if the present one is.
  std::optional<double> area_to_survive(double now) const {
    const double target = target_ms();
    if (level_.suspect() <= 0) return std::nullopt;
    if (!has_slack() && level_.recurring_excess() >= kLeastExcess * target)
      return std::nullopt;  // aim() covers it
    const double worst = std::max(level_.suspect(), level_.level() * (1 + kWorstSigmas * level_.sigma()));
    const double time =
        has_slack() ? target + kUsableSlack * backlog_.slack(target) - backlog_then(worst) : target;
    if (worst * cost_.work(now) <= time) return std::nullopt;
    return cost_.cautious_area_for(std::max(time, kDeepestCut * target) / worst, now);
  }

  int move_to(double area, double now) const {
    const double fade = std::exp(-since_change_ / kBandFade);
    const double noise = kBandSigmas * level_.sigma();
    const double down = has_slack() ? std::max({kLeastBandDown, noise, kBandDown * fade}) : kTightBandDown;
    const double up = std::max({kLeastBandUp, noise, kBandUp * fade});
    if (area < now * (1 - down)) return std::min(rung(), ladder().highest_within(area));
    if (area > now * (1 + up) && since_change_ >= kRestFrames) return ladder().highest_within(area);
    return rung();
  }

  double cpu_target() const {
    std::array<double, 5> sorted = cpu_ms_;
    std::sort(sorted.begin(), sorted.end());
    return std::clamp(sorted[2], target_ms(), 2 * target_ms());
  }

  // Largest area fraction that the blur in view leaves worth drawing.
  double blur_limit() const {
    const BlurAware& blur = settings_.blur_aware;
    const double top = ladder().area_fraction(ladder().top());
    if (!blur.enabled) return top;
    const double part = std::clamp((blur_px_ - blur.start_px) / (blur.full_px - blur.start_px), 0.0, 1.0);
    const double scale = 1 + part * (blur.lowest_scale - 1);
    return top * scale * scale;
  }

  bool has_slack() const { return settings_.buffers > 2; }

  PredictiveSettings settings_;
  CostModel cost_;
  LevelTracker level_;
  PresentationBacklog backlog_;
  std::array<double, kRemembered> chosen_;  // area of each frame by its number
  std::array<double, 5> cpu_ms_ = {};
  std::size_t cpu_count_ = 0;
  std::uint64_t next_ = 0;
  std::uint64_t first_unknown_ = 0;
  double blur_px_ = 0;
  int since_change_ = 0;
};

}  // namespace

Result<std::unique_ptr<ResolutionController>> make_predictive_controller(const PredictiveSettings& settings) {
  return PredictiveController::create(settings);
}

}  // namespace quincunx
