// SPDX-License-Identifier: MIT
#include "method_choice.h"

#include <algorithm>
#include <cmath>

namespace quincunx {
namespace {

constexpr int kMostTimes = 10;           // that a factor is the mean of; a later one counts for a tenth
constexpr double kLargestStep = 0.4055;  // log 1.5: of a later time; one slow frame says little

constexpr double kMixRate = 0.2;        // weight of a new frame in the smoothed mix
constexpr double kLightMemory = 0.999;  // a frame: of judged light while nobody judges; half of it after 690
constexpr double kNotableGain = 0.02;   // part of the error that a better pair saves at least
constexpr double kScaleStep = 0.01;     // step of the search for one

std::vector<MethodVariant> methods_of(const QualitySettings& settings) {
  if (!settings.methods.empty()) return settings.methods;
  const auto all = settings.front.methods();
  return {all.begin(), all.end()};
}

constexpr std::uint64_t kYoungFrames = 12;  // frames of a new shot, in which history is worth little
constexpr int kVotes = 4;                   // frames in a row that want the same method
constexpr int kVotesYoung = 2;

}  // namespace

MethodCosts::MethodCosts(const ErrorFront& front, const std::vector<MethodVariant>& methods,
                         double output_megapixels)
    : front_(&front), methods_(methods), output_megapixels_(output_megapixels), factors_(methods.size()) {}

double MethodCosts::front_ms(std::size_t method, double scale) const {
  return front_->resolve_ms(methods_[method], scale, output_megapixels_).value_or(0);
}

double MethodCosts::ms(std::size_t method, double scale) const {
  const Factor& own = factors_[method];
  if (own.times > 0) return front_ms(method, scale) * std::exp(own.log);
  double sum = 0;
  int times = 0;
  for (const Factor& factor : factors_) {
    sum += factor.times * factor.log;
    times += factor.times;
  }
  return front_ms(method, scale) * std::exp(times > 0 ? sum / times : 0);
}

void MethodCosts::learn(std::size_t method, double scale, double ms) {
  Factor& factor = factors_[method];
  double step = std::log(ms / front_ms(method, scale)) - factor.log;
  if (factor.times > 0) step = std::clamp(step, -kLargestStep, kLargestStep);
  factor.times = std::min(factor.times + 1, kMostTimes);
  factor.log += step / factor.times;
}

bool better(const MethodPairs::Candidate& a, const MethodPairs::Candidate& b) {
  if (a.fits != b.fits) return a.fits;
  return a.fits ? a.flip < b.flip : a.flip * a.ms * a.ms < b.flip * b.ms * b.ms;
}

MethodPairs::MethodPairs(const QualitySettings& settings, const ResolutionLadder& ladder)
    : front_(&settings.front),
      ladder_(&ladder),
      methods_(methods_of(settings)),
      costs_(settings.front, methods_, static_cast<double>(ladder.output().area()) * 1e-6),
      candidates_(methods_.size()) {
  mix_.share.fill(1.0 / kSceneClasses);
}

double MethodPairs::scale_of(int rung) const {
  return std::sqrt(ladder_->area_fraction(rung));
}

double MethodPairs::flip(std::size_t method, double scale) const {
  return front_->flip(mix_, methods_[method], scale).value_or(1);
}

double MethodPairs::frame_ms(const PredictiveModel& model, std::size_t method, double scale) const {
  return model.draw_ms(scale * scale) + costs_.ms(method, scale);
}

std::size_t MethodPairs::least_error_at_top() const {
  const double top = scale_of(ladder_->top());
  std::size_t best = 0;
  for (std::size_t method = 1; method < methods_.size(); ++method) {
    if (flip(method, top) < flip(best, top)) best = method;
  }
  return best;
}

void MethodPairs::follow(const ContentStatistics& content) {
  const double remembered = content.cut ? 0 : kLightMemory * judged_light_;
  judged_light_ = content.judged ? content.light : remembered;
  ContentStatistics known = content;
  known.light = std::max(content.light, judged_light_);
  const SceneMix now = mix_of(known);
  const double rate = content.cut || !told_ ? 1 : kMixRate;
  for (std::size_t i = 0; i < kSceneClasses; ++i)
    mix_.share[i] += rate * (now.share[i] - mix_.share[i]);
  told_ = true;
}

MethodPairs::Candidate MethodPairs::candidate(const PredictiveModel& model, int rung,
                                              std::size_t method) const {
  // The time of the passes depends on the scale a little: two steps find it.
  for (int step = 0; step < 2; ++step)
    rung = model.steady_rung(costs_.ms(method, scale_of(rung)));
  const double scale = scale_of(rung);
  const double ms = frame_ms(model, method, scale);
  return {method, scale, flip(method, scale), ms, rung > 0 || ms <= model.steady_ms()};
}

std::span<const MethodPairs::Candidate> MethodPairs::evaluate(const PredictiveModel& model, int rung) {
  for (std::size_t method = 0; method < methods_.size(); ++method)
    candidates_[method] = candidate(model, rung, method);
  return candidates_;
}

bool MethodPairs::both_fit(const PredictiveModel& model, std::size_t one, std::size_t other) const {
  const double lowest = scale_of(0);
  return frame_ms(model, one, lowest) + costs_.ms(other, lowest) <= model.steady_ms();
}

QualityPair MethodPairs::pair_of(const Candidate& candidate) const {
  return {methods_[candidate.method], candidate.scale, candidate.flip, candidate.ms};
}

std::optional<QualityPair> MethodPairs::next_better(const PredictiveModel& model, double flip_now) const {
  std::optional<QualityPair> cheapest;
  const double top = scale_of(ladder_->top());
  for (std::size_t method = 0; method < methods_.size(); ++method) {
    for (double scale = scale_of(0); scale < top + kScaleStep; scale += kScaleStep) {
      const double at = std::min(scale, top);
      const double error = flip(method, at);
      if (error > flip_now * (1 - kNotableGain)) continue;
      const double ms = frame_ms(model, method, at);
      if (!cheapest || ms < cheapest->ms) cheapest = {methods_[method], at, error, ms};
      break;
    }
  }
  return cheapest;
}

QualityReasons MethodPairs::reasons(const PredictiveModel& model, int rung, std::size_t method) const {
  QualityReasons reasons = {
      .mix = mix_, .budget_ms = model.steady_ms(), .chosen = pair_of(candidate(model, rung, method))};
  std::vector<Candidate> others;
  for (std::size_t other = 0; other < methods_.size(); ++other) {
    if (other != method) others.push_back(candidate(model, rung, other));
  }
  std::sort(others.begin(), others.end(), better);
  for (const Candidate& other : others)
    reasons.others.push_back(pair_of(other));
  reasons.next_better = next_better(model, reasons.chosen.flip);
  return reasons;
}

bool MethodChoice::young() const {
  return since_cut_ < kYoungFrames && !changed_in_shot_;
}

bool MethodChoice::wants_change(const Situation& now) {
  const bool wants = now.best != method_ && (now.must || now.gain > settings_.hysteresis);
  votes_ = !wants || now.held ? 0 : now.best == wanted_ ? votes_ + 1 : 1;
  wanted_ = now.best;
  if (votes_ < (young() ? kVotesYoung : kVotes)) return false;
  return now.must || young() || since_change_ms_ >= settings_.rest_ms;
}

void MethodChoice::follow_fade(std::uint64_t next_frame) {
  const double done = static_cast<double>(next_frame - fade_start_ + 1) / (settings_.fade_frames + 1.0);
  weight_ = std::min(1.0, done);
  if (weight_ == 1) from_.reset();
}

void MethodChoice::advance(const Situation& now) {
  const std::uint64_t frames = now.next_frame - std::min(now.next_frame, last_frame_);
  last_frame_ = now.next_frame;
  since_change_ms_ += static_cast<double>(frames) * now.frame_ms;
  since_cut_ += frames;
  if (now.cut) {
    since_cut_ = 0;
    changed_in_shot_ = false;
    from_.reset();
    weight_ = 1;
  }
  if (from_) return follow_fade(now.next_frame);
  if (!wants_change(now)) return;
  const bool fades = settings_.fade_frames > 0 && !young() && !now.masked && now.both_fit;
  changed_in_shot_ = changed_in_shot_ || young();
  since_change_ms_ = 0;
  votes_ = 0;
  if (fades) {
    from_ = method_;
    fade_start_ = now.next_frame;
  }
  method_ = now.best;
  if (fades) follow_fade(now.next_frame);
}

}  // namespace quincunx
