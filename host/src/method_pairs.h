// SPDX-License-Identifier: MIT
// MethodPairs: each method at the resolution that the budget leaves it, with the error that is expected of it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "method_costs.h"
#include "predictive_model.h"
#include "quincunx/quality_controller.h"

namespace quincunx {

class MethodPairs {
 public:
  struct Candidate {
    std::size_t method = 0;
    double scale = 1;
    double flip = 0;
    double ms = 0;     // of the whole frame
    bool fits = true;  // the budget, at the lowest resolution at least
  };

  // Settings have been checked; they and the ladder outlive this.
  MethodPairs(const QualitySettings& settings, const ResolutionLadder& ladder);

  const FrontMethod& operator[](std::size_t method) const { return methods_[method]; }
  std::size_t least_error_at_top() const;

  // What the next frame shows, smoothed over frames but for a cut.
  void follow(const ContentStatistics& content);

  double passes_ms(std::size_t method, double scale) const { return costs_.ms(method, scale); }
  void learn(std::size_t method, double scale, double ms) { costs_.learn(method, scale, ms); }

  // One of each method, in their order; `rung`: that frames are drawn at now. Valid until the next call.
  std::span<const Candidate> evaluate(const PredictiveModel& model, int rung);
  bool both_fit(const PredictiveModel& model, std::size_t one, std::size_t other) const;

  QualityReasons reasons(const PredictiveModel& model, int rung, std::size_t method) const;

 private:
  double scale_of(int rung) const;
  double flip(std::size_t method, double scale) const;
  double frame_ms(const PredictiveModel& model, std::size_t method, double scale) const;
  Candidate candidate(const PredictiveModel& model, int rung, std::size_t method) const;
  QualityPair pair_of(const Candidate& candidate) const;
  std::optional<QualityPair> next_better(const PredictiveModel& model, double flip_now) const;

  const ErrorFront* front_;
  const ResolutionLadder* ladder_;
  std::vector<FrontMethod> methods_;
  MethodCosts costs_;
  SceneMix mix_;
  bool told_ = false;  // what pictures show
  std::vector<Candidate> candidates_;
};

// Of pairs that fit the one that errs less; a pair that fits before one that does not. Where neither does, frames are
// dropped in proportion to the time: the one with less error times the square of its time.
bool better(const MethodPairs::Candidate& a, const MethodPairs::Candidate& b);

}  // namespace quincunx
