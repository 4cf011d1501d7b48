// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "bench/harness/measuring.h"
#include "bench/traces/trace_run.h"
#include "quincunx/control/predictive_controller.h"

namespace quincunx::traces {
namespace {

using bench::checked;

// Stand-ins for controllers that others use, written from their public descriptions. All act on the scale of both axes,
// with the ladder's range as theirs, and see nothing but what they see at home.
class PeerController : public ResolutionController {
 public:
  PeerController(const ResolutionLadder& steps, double target_ms)
      : ResolutionController(steps, target_ms),
        min_scale_(std::sqrt(steps.area_fraction(0))),
        max_scale_(std::sqrt(steps.area_fraction(steps.top()))) {}

 protected:
  double clamp_scale(double scale) const { return std::clamp(scale, min_scale_, max_scale_); }
  double min_scale() const { return min_scale_; }
  double max_scale() const { return max_scale_; }

 private:
  double min_scale_;
  double max_scale_;
};

// Unreal Engine's documented heuristic: the mean of the last 16 frames' estimates, each 0.9 of the next newer
// one's weight, at 10 % headroom; at most one change in 8 frames and none below 2 %; two over-budget frames
// in a row panic.
class UnrealLike final : public PeerController {
 public:
  UnrealLike(const ResolutionLadder& steps, double target_ms)
      : PeerController(steps, target_ms), scale_(max_scale()) {}
  const char* name() const override { return "unreal-like"; }

 private:
  static constexpr std::size_t kHistory = 16;
  static constexpr double kWeight = 0.9;
  static constexpr double kHeadroom = 0.1;
  static constexpr int kPeriod = 8;
  static constexpr double kThreshold = 0.02;
  static constexpr double kIncreaseBlend = 0.9;
  static constexpr int kPanic = 2;

  struct Past {
    double scale;
    double gpu_ms;
  };

  double suggestion(std::size_t count) const {
    double sum = 0;
    double weights = 0;
    double weight = 1;
    for (std::size_t frame = 0; frame < count; ++frame, weight *= kWeight) {
      const Past& past = history_[frame];
      sum += weight * past.scale * std::sqrt(target_ms() * (1 - kHeadroom) / past.gpu_ms);
      weights += weight;
    }
    return clamp_scale(sum / weights);
  }

  int choose(const FrameTiming& timing) override {
    history_.push_front({std::sqrt(ladder().area_fraction(timing.render_extent)), timing.gpu_ms});
    if (history_.size() > kHistory) history_.pop_back();
    over_budget_ = timing.gpu_ms > target_ms() ? over_budget_ + 1 : 0;
    ++since_change_;
    if (over_budget_ >= kPanic) {
      change(suggestion(static_cast<std::size_t>(over_budget_)));
      history_.clear();
      over_budget_ = 0;
    } else if (since_change_ >= kPeriod) {
      double wanted = suggestion(history_.size());
      if (wanted > scale_) wanted = scale_ + kIncreaseBlend * (wanted - scale_);
      const bool reaches_end = wanted == max_scale() || wanted == min_scale();
      if (std::abs(wanted / scale_ - 1) > kThreshold || (reaches_end && wanted != scale_)) change(wanted);
    }
    return ladder().max_rung_within_scale(scale_);
  }

  void change(double scale) {
    scale_ = scale;
    since_change_ = 0;
  }

  std::deque<Past> history_;
  double scale_;
  int over_budget_ = 0;
  int since_change_ = 0;
};

// Vlachos, "Advanced VR Rendering Performance" (The Lab), 2016: above 90 % of the budget two of ten levels
// down, also if above 85 % and a straight line through the last two times comes out above 90 %; after three
// frames below 70 % one level up; two frames of rest after a change.
class ValveLike final : public PeerController {
 public:
  using PeerController::PeerController;
  const char* name() const override { return "valve-like"; }

 private:
  static constexpr int kLevels = 10;

  int choose(const FrameTiming& timing) override {
    const double used = timing.gpu_ms / target_ms();
    const double expected = used + (used - before_);
    low_ = used < 0.7 ? low_ + 1 : 0;
    if (rest_ > 0) {
      --rest_;
    } else if (used > 0.9 || (used > 0.85 && expected > 0.9)) {
      change(-2);
    } else if (low_ >= 3) {
      change(1);
    }
    before_ = used;
    const double scale = min_scale() + (max_scale() - min_scale()) * level_ / (kLevels - 1);
    return ladder().max_rung_within_scale(scale);
  }

  void change(int by) {
    level_ = std::clamp(level_ + by, 0, kLevels - 1);
    rest_ = 2;
    low_ = 0;
  }

  int level_ = kLevels - 1;
  int rest_ = 0;
  int low_ = 0;
  double before_ = 0;
};

// Unity's DynamicResolutionSample: down at once by the excess or by a rise larger than the headroom; up in
// small steps when a counter reaches 360.
class UnityLike final : public PeerController {
 public:
  using PeerController::PeerController;
  const char* name() const override { return "unity-like"; }

 private:
  static constexpr double kHeadroomThreshold = 0.06;
  static constexpr double kDeltaThreshold = 0.035;
  static constexpr int kRaiseLimit = 360;

  int choose(const FrameTiming& timing) override {
    const double used = timing.gpu_ms / target_ms();
    const double headroom = 1 - used;
    const double delta = before_ > 0 ? used - before_ : 0;
    before_ = used;
    if (headroom < 0 || delta > headroom) {
      factor_ = std::clamp(factor_ - (headroom < 0 ? -headroom : delta), 0.0, 1.0);
      counter_ = 0;
    } else {
      if (delta < 0) {
        counter_ += 10;
      } else if (headroom > kHeadroomThreshold && delta < kDeltaThreshold) {
        counter_ += 3;
      }
      if (counter_ >= kRaiseLimit) {
        counter_ = 0;
        const double remapped = (std::clamp(headroom, 0.1, 0.5) - 0.1) / 0.4;
        factor_ = std::clamp(factor_ + kDeltaThreshold * (0.25 + 0.75 * remapped), 0.0, 1.0);
      }
    }
    return ladder().max_rung_within_scale(min_scale() + (max_scale() - min_scale()) * factor_);
  }

  double factor_ = 1;
  double before_ = 0;
  int counter_ = 0;
};

// Google Filament's PID on the pixel count: error from the median of the last 15 times, gains 1 - exp(-1/8)
// and .002, dead band of 1 % down and 5 % up, headroom .05.
class FilamentLike final : public PeerController {
 public:
  FilamentLike(const ResolutionLadder& steps, double target_ms)
      : PeerController(steps, target_ms), area_(max_scale() * max_scale()) {}
  const char* name() const override { return "filament-like"; }

 private:
  static constexpr std::size_t kHistory = 15;
  static constexpr double kHeadroom = 0.05;
  static constexpr double kIntegralGain = 0.002;

  int choose(const FrameTiming& timing) override {
    times_.push_back(timing.gpu_ms);
    if (times_.size() > kHistory) times_.pop_front();
    std::vector<double> sorted(times_.begin(), times_.end());
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    const double error = 1 - sorted[sorted.size() / 2] / (target_ms() * (1 - kHeadroom));
    integral_ = std::clamp(integral_ + error, -100.0, 100.0);
    double out = (1 - std::exp(-1.0 / 8)) * error + kIntegralGain * integral_;
    if (out > -0.01 && out < 0.05) out = 0;
    const double command = out < 0 ? 1 / (1 - out) : 1 + out;
    area_ = std::clamp(area_ * command, min_scale() * min_scale(), max_scale() * max_scale());
    return ladder().max_rung_within(area_);
  }

  std::deque<double> times_;
  double integral_ = 0;
  double area_;
};

template <typename Peer>
ControllerKind peer(const std::string& name) {
  return {name, false, [](const LadderSettings& ladder, const Display& display) {
            return std::make_unique<Peer>(checked(ResolutionLadder::create(ladder)), display.target_ms());
          }};
}

}  // namespace

std::vector<ControllerKind> controller_kinds() {
  return {
      {"predictive", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_predictive_controller(
             {.ladder = ladder, .target_ms = display.target_ms(), .buffers = display.buffers}));
       }},
      {"proportional [W]", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_proportional_controller({.ladder = ladder, .target_ms = display.target_ms()}));
       }},
      {"minimum of N [N]", true,
       [](const LadderSettings& ladder, const Display& display) {
         return checked(make_minimum_of_n_controller({.ladder = ladder, .target_ms = display.target_ms()}));
       }},
      peer<UnrealLike>("Unreal-like"),
      peer<ValveLike>("Valve-like"),
      peer<UnityLike>("Unity-like"),
      peer<FilamentLike>("Filament-like"),
  };
}

}  // namespace quincunx::traces
