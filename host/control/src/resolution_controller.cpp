// SPDX-License-Identifier: MIT
#include "quincunx/control/resolution_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace quincunx {

ResolutionController::ResolutionController(ResolutionLadder ladder, double target_ms)
    : ladder_(std::move(ladder)), target_ms_(target_ms), rung_(ladder_.top()) {}

Status ResolutionController::check_target(double target_ms) {
  if (target_ms > 0 && target_ms <= kMaxMs) return {};
  return Status::invalid(fmt::format("target_ms is {}; it must lie in (0, {}]", target_ms, kMaxMs));
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
  if (timing.render_extent.width < 1 || timing.render_extent.height < 1) {
    return Status::invalid(fmt::format("render_extent is {}x{}; both sides must be at least 1",
                                       timing.render_extent.width, timing.render_extent.height));
  }
  if (!(timing.gpu_ms > 0 && timing.gpu_ms <= kMaxMs)) {
    return Status::invalid(fmt::format("gpu_ms is {}; it must lie in (0, {}]", timing.gpu_ms, kMaxMs));
  }
  const auto unusable = [](double value) { return !(value >= 0 && value <= kMaxMs); };
  if (unusable(timing.cpu_ms)) {
    return Status::invalid(fmt::format("cpu_ms is {}; it must lie in [0, {}]", timing.cpu_ms, kMaxMs));
  }
  if (unusable(timing.interval_ms)) {
    return Status::invalid(
        fmt::format("interval_ms is {}; it must lie in [0, {}]", timing.interval_ms, kMaxMs));
  }
  if (timing.queued < FrameTiming::kUnknownQueue) {
    return Status::invalid(
        fmt::format("queued is {}; it must be at least 0, or -1 for unknown", timing.queued));
  }
  if (timing.missed_vsyncs < 0) {
    return Status::invalid(fmt::format("missed_vsyncs is {}; it must be at least 0", timing.missed_vsyncs));
  }
  if (!(timing.blur_px >= 0 && std::isfinite(timing.blur_px))) {
    return Status::invalid(fmt::format("blur_px is {}; it must be finite and at least 0", timing.blur_px));
  }
  return {};
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
    if (!(settings.rate > 0 && settings.rate <= 1)) {
      return Status::invalid(fmt::format("rate is {}; it must lie in (0, 1]", settings.rate));
    }
    if (!(settings.spike_ratio >= 1 && std::isfinite(settings.spike_ratio))) {
      return Status::invalid(
          fmt::format("spike_ratio is {}; it must be finite and at least 1", settings.spike_ratio));
    }
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
    if (settings.count < 1 || settings.count > kMostTimes) {
      return Status::invalid(fmt::format("count is {}; it must lie in [1, {}]", settings.count, kMostTimes));
    }
    if (!(settings.factor > 0 && settings.factor <= 1)) {
      return Status::invalid(fmt::format("factor is {}; it must lie in (0, 1]", settings.factor));
    }
    if (!(settings.margin > 0 && settings.margin <= 1)) {
      return Status::invalid(fmt::format("margin is {}; it must lie in (0, 1]", settings.margin));
    }
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
