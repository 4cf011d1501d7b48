// SPDX-License-Identifier: MIT
#include "predictive_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ranges.h"

namespace quincunx {
namespace {

// For CostModel.
constexpr double kLargestFixedPart = 0.9;
constexpr double kLeastDifference = 0.03;  // smaller differences of two areas tell nothing
constexpr double kDecay = 0.8;             // factor for older pairs, per pair
constexpr double kHeaviestPair = 1;        // as one an output apart: more would take too many pairs to forget
constexpr double kPriorWeight = 0.004;     // as much as one pair .063 apart
constexpr double kDoubt = 0.15;            // added to b as long as it is a guess
constexpr double kDoubtFade = 20;          // per weight of pairs: half gone after one pair .19 apart

// For LevelTracker.
constexpr double kOutlierSigmas = 4;
constexpr double kLeastOutlier = 0.06;
constexpr double kSigmaRate = 0.04;
constexpr double kTrendRate = 0.07;
constexpr double kSlowestRate = 0.03;
constexpr double kRatePower = 3.5;  // power of |trend| / magnitude (about .2 on noise and 1 on a trend)
constexpr double kBiasRate = 0.02;
constexpr double kSigmaPerMagnitude = 1.25;  // their ratio for a normal distribution

// For PredictiveModel: all found on the development traces; docs/control.md says what each does.
constexpr double kHeadroom = 0.002;  // part of the target, while the backlog rests
constexpr double kRest = 0.1;        // backlog that is let be, in refreshes
constexpr double kRestSigmas = 5;    // and more of it with noise
constexpr double kRecovery = 0.04;   // part of the target per refresh of backlog above the rest
constexpr double kUrgentFrom = 0.4;  // in refreshes: from here the answer grows with the square, too
constexpr double kUrgent = 0.5;
constexpr double kLargestRecovery = 0.3;
constexpr double kOverdraw = 0.008;    // part of the target: spent to keep some backlog when times are noisy
constexpr double kNoisy = 0.015;       // sigma from which they are
constexpr double kUsableSlack = 0.92;  // that a frame like the worst may use up
constexpr double kWorstSigmas = 2;
constexpr double kDeepestCut = 0.6;  // part of the target: lowest aim in answer to one frame
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
constexpr double kTightExcess = 1.1;  // factor for the excess that recurs
constexpr double kTightTrend = 2;
constexpr double kTightBandDown = 0.008;
constexpr double kLeastExcess = 0.04;     // part of the target: smaller ones are noise
constexpr double kFollowHeadroom = 0.05;  // below the processor's time
constexpr double kBlurRate = 0.1;

double first_fixed_part(const PredictiveSettings& settings) {
  return settings.calibration ? settings.calibration->fixed_part().value_or(settings.fixed_part)
                              : settings.fixed_part;
}

}  // namespace

double CostModel::cautious_area_for(double wanted, double from_area) const {
  const double doubted = std::min(kLargestFixedPart, fixed_part_ + kDoubt * std::exp(-weights_ * kDoubtFade));
  // The time at from_area was measured, so only the ratio to it is in doubt.
  const double ratio = wanted / work(from_area);
  return (ratio * (doubted + (1 - doubted) * from_area) - doubted) / (1 - doubted);
}

void CostModel::learn(double area, double time) {
  const double difference = area - last_area_;
  if (last_time_ > 0 && std::abs(difference) > kLeastDifference) {
    const double slope = (time - last_time_) / difference;
    const double level = time + slope * (1 - area);
    if (slope > 0 && level > 0) {
      const double weight = std::min(difference * difference, kHeaviestPair);
      weighted_sum_ = kDecay * weighted_sum_ + weight * std::clamp(1 - slope / level, 0.0, kLargestFixedPart);
      weights_ = kDecay * weights_ + weight;
      fixed_part_ = (weighted_sum_ + kPriorWeight * prior_) / (weights_ + kPriorWeight);
    }
  }
  last_area_ = area;
  last_time_ = time;
}

void LevelTracker::restart(double level) {
  level_ = level;
  trend_ = 0;
  outliers_ = 0;
  suspect_ = 0;
}

void LevelTracker::follow_outlier(double residual, double level) {
  const int direction = residual > 0 ? 1 : -1;
  if (outliers_ == direction) {
    bias_ = 0;
    excess_[(count_ - 1) % kRemembered] = 0;
    excess_[(count_ - 2) % kRemembered] = 0;
    return restart(std::max(level, suspect_));
  }
  outliers_ = direction;
  suspect_ = level;
  bias_ += kBiasRate * (std::clamp(residual, -0.5, 1.0) - bias_);
}

void LevelTracker::observe(double work, double time) {
  const double level = time / work;
  if (level_ <= 0) return restart(level);
  const double residual = level / level_ - 1;
  excess_[count_++ % kRemembered] = time - level_ * work;
  if (std::abs(residual) > std::max(kOutlierSigmas * sigma_, kLeastOutlier)) {
    follow_outlier(residual, level);
    return;
  }
  outliers_ = 0;
  suspect_ = 0;
  bias_ -= kBiasRate * bias_;
  trend_ += kTrendRate * (residual - trend_);
  magnitude_ += kTrendRate * (std::abs(residual) - magnitude_);
  const double tracking = magnitude_ > 0 ? std::min(1.0, std::abs(trend_) / magnitude_) : 0;
  level_ *= 1 + std::max(kSlowestRate, std::pow(tracking, kRatePower)) * residual;
  sigma_ += kSigmaRate * (kSigmaPerMagnitude * std::abs(residual) - sigma_);
}

double LevelTracker::recurring_excess() const {
  double first = 0;
  double second = 0;
  for (const double excess : excess_) {
    second = std::max(second, std::min(first, excess));
    first = std::max(first, excess);
  }
  return second;
}

void PresentationBacklog::observe(const Frame& frame, double refresh_ms) {
  const double least_wait = 0.02 * refresh_ms;
  const double most = slack(refresh_ms);
  if (!certain_ && frame.queued >= 0) backlog_ = most;
  backlog_ = std::clamp(backlog_, 0.0, most);
  const bool waited = last_gpu_ms_ > 0 && frame.interval_ms > last_gpu_ms_ + least_wait;
  last_gpu_ms_ = frame.gpu_ms;
  if (waited) {
    // For the display, because the queue was full; or for the processor, while the queue ran empty.
    certain_ = frame.cpu_ms < frame.interval_ms - least_wait;
    backlog_ = certain_ ? 0 : most;
  }
  backlog_ = std::max(0.0, backlog_ + frame.gpu_ms - refresh_ms);
  if (frame.missed_vsyncs > 0 && backlog_ < most) certain_ = false;
  if (backlog_ > most) backlog_ = most > 0 ? std::fmod(backlog_, refresh_ms) : 0;
  if (frame.queued < 0) return;
  // With q frames waiting, the backlog lies between the two multiples of the interval that q stands for.
  const double highest = (buffers_ - 1.0 - frame.queued) * refresh_ms;
  backlog_ = std::clamp(certain_ ? backlog_ : most, std::clamp(highest - refresh_ms, 0.0, most),
                        std::clamp(highest, 0.0, most));
  certain_ = certain_ || frame.queued >= buffers_ - 1;
}

PredictiveModel::PredictiveModel(const ResolutionLadder& ladder, const PredictiveSettings& settings)
    : ladder_(&ladder),
      settings_(settings),
      cost_(first_fixed_part(settings)),
      backlog_(settings.buffers),
      target_ms_(settings.target_ms) {
  chosen_.fill({ladder.area_fraction(ladder.top()), 0});
}

void PredictiveModel::observe(const FrameTiming& timing, double apart_ms, double target_ms) {
  const double area = ladder_->area_fraction(timing.render_extent);
  target_ms_ = target_ms;
  backlog_.observe({.gpu_ms = timing.gpu_ms,
                    .cpu_ms = timing.cpu_ms,
                    .interval_ms = timing.interval_ms,
                    .queued = timing.queued,
                    .missed_vsyncs = timing.missed_vsyncs},
                   target_ms);
  cost_.learn(area, timing.gpu_ms - apart_ms);
  level_.observe(cost_.work(area), timing.gpu_ms - apart_ms);
  last_cpu_ms_ = timing.cpu_ms;
  last_gpu_ms_ = timing.gpu_ms;
  cpu_ms_[cpu_count_++ % cpu_ms_.size()] = timing.cpu_ms;
  blur_px_ += kBlurRate * (timing.blur_px - blur_px_);
  next_ = timing.next_frame == 0 ? timing.frame + 1 : timing.next_frame;
  first_unknown_ = timing.frame + 1;
  ++since_change_;
}

void PredictiveModel::choose(int from_rung, int rung, double apart_ms) {
  if (rung != from_rung) since_change_ = 0;
  chosen_[next_ % kRemembered] = {ladder_->area_fraction(rung), apart_ms};
}

// Backlog when the frames that are under way are done, if the level is this.
double PredictiveModel::backlog_then(double level) const {
  double backlog = backlog_.now();
  const std::uint64_t known = next_ > kRemembered ? next_ - kRemembered + 1 : 0;
  for (std::uint64_t frame = std::max(first_unknown_, known); frame < next_; ++frame) {
    const Chosen& chosen = chosen_[frame % kRemembered];
    backlog = std::max(0.0, backlog + level * cost_.work(chosen.area) + chosen.apart_ms - target_ms_);
  }
  return backlog;
}

// The time that the next frame may take.
double PredictiveModel::aim() const {
  const double target = target_ms_;
  const double sigma = level_.sigma();
  if (!has_slack()) {
    const double expected = std::max(kTightSigmas * sigma, kTightExcess * level_.recurring_excess() / target);
    const double headroom = kTightHeadroom + expected + kTightTrend * std::max(0.0, level_.trend());
    return target * std::max(0.5, 1 - headroom);
  }
  const double behind = backlog_then(level_.mean_level()) / target;
  const double urgent = std::max(0.0, behind - kUrgentFrom);
  const double recovery = kRecovery * (behind - kRest - kRestSigmas * sigma) + kUrgent * urgent * urgent;
  return target * (1 - kHeadroom - std::clamp(recovery, sigma > kNoisy ? -kOverdraw : 0, kLargestRecovery));
}

double PredictiveModel::area_within(double ms, double apart_ms) const {
  return cost_.area_for((ms - apart_ms) / level_.mean_level());
}

int PredictiveModel::wanted_rung(int rung, double apart_ms, Bands bands) const {
  const double now = ladder_->area_fraction(rung);
  const int highest = ladder_->max_rung_within(blur_limit());
  if (cpu_bound()) {
    if (follows_cpu()) return std::min(highest, move_to(area_within(steady_ms(), apart_ms), rung, bands));
    if (level_.level() * cost_.work(now) + apart_ms <= target_ms_) return std::min(highest, rung);
  }
  if (const auto least = area_to_survive(now, apart_ms)) {
    return std::min({highest, rung, ladder_->max_rung_within(*least)});
  }
  if (has_outlier()) return std::min(highest, rung);
  const double aimed = aim();
  double area = area_within(aimed, apart_ms);
  if (area < kLargeMove * now) {
    area = std::min(area, cost_.cautious_area_for((aimed - apart_ms) / level_.mean_level(), now));
  }
  return std::min(highest, move_to(area, rung, bands));
}

double PredictiveModel::steady_ms() const {
  if (follows_cpu()) return cpu_target() * (1 - kFollowHeadroom);
  return has_slack() ? target_ms_ * (1 - kHeadroom) : aim();
}

int PredictiveModel::steady_rung(double apart_ms) const {
  if (level_.mean_level() <= 0) return ladder_->top();
  return ladder_->max_rung_within(std::min(blur_limit(), area_within(steady_ms(), apart_ms)));
}

// After an outlier: the area at which the next frame would just be in time if the outlier was a step.
// Nothing if the present one is.
std::optional<double> PredictiveModel::area_to_survive(double now, double apart_ms) const {
  const double target = target_ms_;
  if (!has_outlier()) return std::nullopt;
  if (!has_slack() && level_.recurring_excess() >= kLeastExcess * target)
    return std::nullopt;  // aim() covers it
  const double worst = std::max(level_.suspect(), level_.level() * (1 + kWorstSigmas * level_.sigma()));
  const double time =
      has_slack() ? target + kUsableSlack * backlog_.slack(target) - backlog_then(worst) : target;
  if (worst * cost_.work(now) + apart_ms <= time) return std::nullopt;
  return cost_.cautious_area_for((std::max(time, kDeepestCut * target) - apart_ms) / worst, now);
}

int PredictiveModel::move_to(double area, int rung, Bands bands) const {
  if (bands == Bands::kNone) return ladder_->max_rung_within(area);
  const double now = ladder_->area_fraction(rung);
  const double fade = std::exp(-since_change_ / kBandFade);
  const double noise = kBandSigmas * level_.sigma();
  const double down = has_slack() ? std::max({kLeastBandDown, noise, kBandDown * fade}) : kTightBandDown;
  const double up = std::max({kLeastBandUp, noise, kBandUp * fade});
  if (area < now * (1 - down)) return std::min(rung, ladder_->max_rung_within(area));
  if (area > now * (1 + up) && since_change_ >= kRestFrames) return ladder_->max_rung_within(area);
  return rung;
}

bool PredictiveModel::cpu_bound() const {
  return last_cpu_ms_ > std::max(target_ms_, last_gpu_ms_);
}

bool PredictiveModel::follows_cpu() const {
  return cpu_bound() && settings_.cpu_bound == CpuBound::kFollow && cpu_target() > target_ms_;
}

double PredictiveModel::cpu_target() const {
  std::array<double, 5> sorted = cpu_ms_;
  std::sort(sorted.begin(), sorted.end());
  return std::clamp(sorted[2], target_ms_, 2 * target_ms_);
}

// Largest area fraction that the blur in view leaves worth drawing.
double PredictiveModel::blur_limit() const {
  const BlurAware& blur = settings_.blur_aware;
  const double top = ladder_->area_fraction(ladder_->top());
  if (!blur.enabled) return top;
  const double part = std::clamp((blur_px_ - blur.start_px) / (blur.full_px - blur.start_px), 0.0, 1.0);
  const double scale = 1 + part * (blur.min_scale - 1);
  return top * scale * scale;
}

Status check(const PredictiveSettings& settings) {
  Ranges ranges;
  ranges.lies_in("buffers", settings.buffers, 2, 8);
  ranges.lies_in("fixed_part", settings.fixed_part, 0, 0.9);
  if (!ranges.status().ok()) return ranges.status();
  const BlurAware& blur = settings.blur_aware;
  if (!(blur.start_px >= 0 && blur.full_px > blur.start_px && std::isfinite(blur.full_px))) {
    return Status::invalid(fmt::format(
        "blur_aware.start_px is {} and full_px {}; the first must be at least 0 and below the second",
        blur.start_px, blur.full_px));
  }
  ranges.lies_in("blur_aware.min_scale", blur.min_scale, 0, 1, Ends::kOpenLow);
  return ranges.status();
}

namespace {

class PredictiveController final : public ResolutionController {
 public:
  static Result<std::unique_ptr<ResolutionController>> create(const PredictiveSettings& settings) {
    if (Status status = check_target(settings.target_ms); !status.ok()) return status;
    if (Status status = quincunx::check(settings); !status.ok()) return status;
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<ResolutionController>(
        new PredictiveController(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "predictive"; }

 private:
  PredictiveController(ResolutionLadder steps, const PredictiveSettings& settings)
      : ResolutionController(std::move(steps), settings.target_ms), model_(ladder(), settings) {}

  int choose(const FrameTiming& timing) override {
    model_.observe(timing, 0, target_ms());
    const int result = model_.wanted_rung(rung(), 0);
    model_.choose(rung(), result, 0);
    return result;
  }

  PredictiveModel model_;
};

}  // namespace

Result<std::unique_ptr<ResolutionController>> make_predictive_controller(const PredictiveSettings& settings) {
  return PredictiveController::create(settings);
}

}  // namespace quincunx
