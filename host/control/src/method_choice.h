// SPDX-License-Identifier: MIT
// The parts of a quality controller that know methods: their costs (MethodCosts), the best resolution of each
// (MethodPairs), and which of them is shown (MethodChoice).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "predictive_model.h"
#include "quincunx/control/error_front.h"
#include "quincunx/control/quality_controller.h"

namespace quincunx {

// The times of each method's passes on this machine, by scale.
//
// The front's times are the first guess. Each is multiplied by what the machine has shown: a method that was timed by
// its own factor, another one by the mean factor of those. Scale costs alike on every machine, so a factor learnt at
// one scale holds at all.
class MethodCosts {
 public:
  // Every method has points in `front`.
  MethodCosts(const ErrorFront& front, const std::vector<MethodVariant>& methods, double output_megapixels);

  double ms(std::size_t method, double scale) const;

  // The passes of this method took `ms`, above 0.
  void learn(std::size_t method, double scale, double ms);

 private:
  struct Factor {
    double log = 0;  // logarithm of measured over the front's
    int times = 0;   // it was learnt from, as far as that matters
  };
  double front_ms(std::size_t method, double scale) const;

  const ErrorFront* front_;
  std::vector<MethodVariant> methods_;
  double output_megapixels_;
  std::vector<Factor> factors_;
};

// Each method at the resolution that the budget leaves it, with the error that is expected of it.
class MethodPairs {
 public:
  struct Candidate {
    std::size_t method = 0;
    double scale = 1;
    double flip = 0;
    double ms = 0;     // the whole frame's
    bool fits = true;  // the budget, at the lowest resolution at least
  };

  // Settings have been checked; they and the ladder outlive this.
  MethodPairs(const QualitySettings& settings, const ResolutionLadder& ladder);

  const MethodVariant& operator[](std::size_t method) const { return methods_[method]; }
  std::size_t least_error_at_top() const;

  // Follows the content of the next frame, smoothed over frames but for a cut. Light that a judge has seen is forgotten
  // slowly while none looks: a method that does not look must not seem the better one for that, and where the light
  // rests, one that looks gets its turn in the end.
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
  std::vector<MethodVariant> methods_;
  MethodCosts costs_;
  SceneMix mix_;
  bool told_ = false;        // what pictures show
  double judged_light_ = 0;  // share of the picture, as last judged, fading
  std::vector<Candidate> candidates_;
};

// Compares two pairs. If both fit, the one that errs less is better; a pair that fits is better than one that does not.
// Where neither does, frames are dropped in proportion to the time: the one with less error times the square of its
// time is better.
bool better(const MethodPairs::Candidate& a, const MethodPairs::Candidate& b);

// Decides when the method changes, and how. It is told each frame which method would be best, and keeps, changes
// at once or fades.
class MethodChoice {
 public:
  struct Settings {
    double hysteresis = 0;
    double rest_ms = 0;
    int fade_frames = 0;
  };
  MethodChoice(const Settings& settings, std::size_t first) : settings_(settings), method_(first) {}

  // Facts that are known when the next frame is chosen.
  struct Situation {
    std::uint64_t next_frame = 0;
    double frame_ms = 0;    // between two frames
    std::size_t best = 0;   // index of the best method of all
    double gain = 0;        // part of the present method's error that the best one saves
    bool must = false;      // the present method does not fit, the best one does
    bool held = false;      // the times of this frame are no ground for a change
    bool masked = false;    // motion is so fast that a change is not seen
    bool both_fit = false;  // the present method and the best one in one frame
    bool cut = false;       // a shot has begun
  };
  void advance(const Situation& now);

  std::size_t method() const { return method_; }
  std::optional<std::size_t> fading_from() const { return from_; }
  double weight() const { return weight_; }  // share of method(), in (0, 1]

 private:
  bool wants_change(const Situation& now);
  void follow_fade(std::uint64_t next_frame);
  bool young() const;

  Settings settings_;
  std::size_t method_;
  std::optional<std::size_t> from_;
  double weight_ = 1;
  std::uint64_t last_frame_ = 0;
  std::uint64_t fade_start_ = 0;
  double since_change_ms_ = 0;
  std::uint64_t since_cut_ = 0;   // frames
  bool changed_in_shot_ = false;  // while it was young
  std::size_t wanted_ = 0;
  int votes_ = 0;
};

}  // namespace quincunx
