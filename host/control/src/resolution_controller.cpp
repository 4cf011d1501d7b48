// SPDX-License-Identifier: MIT
#include "quincunx/control/resolution_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "ranges.h"

namespace quincunx {

ResolutionController::ResolutionController(ResolutionLadder ladder, double target_ms)
    : ladder_(std::move(ladder)), target_ms_(target_ms), rung_(ladder_.top()) {}

Status ResolutionController::check_target(double target_ms) {
  Ranges ranges;
  ranges.lies_in("target_ms", target_ms, 0, kMaxMs, Ends::kOpenLow);
  return ranges.status();
}

Status ResolutionController::set_target_ms(double target_ms) {
  if (Status status = check_target(target_ms); !status.ok()) return status;
  target_ms_ = target_ms;
  return {};
}

Status ResolutionController::check(const FrameTiming& timing) const {
  if (observed_ && timing.frame <= last_frame_) {
    return Status::invalid(
        fmt::format("frame is {}, late or a duplicate; the last one was {}", timing.frame, last_frame_));
  }
  if (timing.next_frame != 0 && timing.next_frame <= timing.frame) {
    return Status::invalid(
        fmt::format("next_frame is {}; it must be 0 or above frame, {}", timing.next_frame, timing.frame));
  }
  Ranges ranges;
  ranges.sides_of("render_extent", timing.render_extent);
  ranges.lies_in("gpu_ms", timing.gpu_ms, 0, kMaxMs, Ends::kOpenLow);
  ranges.lies_in("cpu_ms", timing.cpu_ms, 0, kMaxMs);
  ranges.lies_in("interval_ms", timing.interval_ms, 0, kMaxMs);
  if (!ranges.status().ok()) return ranges.status();
  if (timing.queued < FrameTiming::kUnknownQueue) {
    return Status::invalid(
        fmt::format("queued is {}; it must be at least 0, or -1 for unknown", timing.queued));
  }
  ranges.at_least("missed_vsyncs", timing.missed_vsyncs, 0);
  ranges.at_least("blur_px", timing.blur_px, 0);
  return ranges.status();
}

Status ResolutionController::observe(const FrameTiming& timing) {
  if (Status status = check(timing); !status.ok()) return status;
  last_frame_ = timing.frame;
  observed_ = true;
  rung_ = std::clamp(choose(timing), 0, ladder_.top());
  return {};
}

namespace {

// Both seeds keep one scale for both axes. It is not rounded to the ladder, or steps below a rung would be
// lost.
class ScaleController : public ResolutionController {
 protected:
  ScaleController(ResolutionLadder ladder, double target_ms, const LadderSettings& settings)
      : ResolutionController(std::move(ladder), target_ms),
        min_scale_(settings.min_scale),
        max_scale_(settings.max_scale),
        scale_(settings.max_scale) {}

  // s <- s + gain * s * (1 - time / target)
  int follow(double gain, double time_ms, double target) {
    scale_ = std::clamp(scale_ + gain * scale_ * (target - time_ms) / target, min_scale_, max_scale_);
    return ladder().max_rung_within_scale(scale_);
  }

 private:
  double min_scale_;
  double max_scale_;
  double scale_;
};

class ProportionalController final : public ScaleController {
 public:
  static Result<std::unique_ptr<ResolutionController>> create(const ProportionalSettings& settings) {
    if (Status status = check_target(settings.target_ms); !status.ok()) return status;
    Ranges ranges;
    ranges.lies_in("rate", settings.rate, 0, 1, Ends::kOpenLow);
    ranges.at_least("spike_ratio", settings.spike_ratio, 1);
    if (!ranges.status().ok()) return ranges.status();
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<ResolutionController>(
        new ProportionalController(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "proportional"; }

 private:
  ProportionalController(ResolutionLadder ladder, const ProportionalSettings& settings)
      : ScaleController(std::move(ladder), settings.target_ms, settings.ladder),
        rate_(settings.rate),
        spike_ratio_(settings.spike_ratio) {}

  int choose(const FrameTiming& timing) override {
    const bool usable = timing.interval_ms > 0 && timing.interval_ms <= spike_ratio_ * timing.gpu_ms;
    const double time_ms = usable ? (timing.gpu_ms + timing.interval_ms) / 2 : timing.gpu_ms;
    return follow(rate_, time_ms, target_ms());
  }

  double rate_;
  double spike_ratio_;
};

class MinimumOfNController final : public ScaleController {
 public:
  static Result<std::unique_ptr<ResolutionController>> create(const MinimumOfNSettings& settings) {
    constexpr int kMostTimes = 1000;
    if (Status status = check_target(settings.target_ms); !status.ok()) return status;
    Ranges ranges;
    ranges.lies_in("count", settings.count, 1, kMostTimes);
    ranges.lies_in("factor", settings.factor, 0, 1, Ends::kOpenLow);
    ranges.lies_in("margin", settings.margin, 0, 1, Ends::kOpenLow);
    if (!ranges.status().ok()) return ranges.status();
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<ResolutionController>(
        new MinimumOfNController(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "minimum-of-n"; }

 private:
  MinimumOfNController(ResolutionLadder ladder, const MinimumOfNSettings& settings)
      : ScaleController(std::move(ladder), settings.target_ms, settings.ladder),
        count_(static_cast<std::size_t>(settings.count)),
        factor_(settings.factor),
        margin_(settings.margin) {}

  int choose(const FrameTiming& timing) override {
    times_.push_back(timing.gpu_ms);
    if (times_.size() > count_) times_.pop_front();
    return follow(factor_, *std::min_element(times_.begin(), times_.end()), target_ms() * margin_);
  }

  std::size_t count_;
  double factor_;
  double margin_;
  std::deque<double> times_;
};

}  // namespace

Result<std::unique_ptr<ResolutionController>> make_proportional_controller(
    const ProportionalSettings& settings) {
  return ProportionalController::create(settings);
}

Result<std::unique_ptr<ResolutionController>> make_minimum_of_n_controller(
    const MinimumOfNSettings& settings) {
  return MinimumOfNController::create(settings);
}

}  // namespace quincunx
