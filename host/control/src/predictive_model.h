// SPDX-License-Identifier: MIT
// PredictiveModel: the predictive controller's knowledge of a load and of the display, and the rung that follows. And
// its parts: CostModel, LevelTracker and PresentationBacklog.
//
// A frame's time is that of its drawing, which follows the render extent and is learnt (CostModel,
// LevelTracker), and a part `apart` that the caller knows and answers for, such as the passes of a method that may
// be another one in the next frame. Without such a part it is 0. docs/control.md has the algorithm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "quincunx/control/predictive_controller.h"

namespace quincunx {

// A frame's time is a level (its time at the output resolution) times the work at its area fraction p:
//   work(p) = b + (1 - b) p
// b, the part that does not scale, is learned from pairs of frames of different area.
class CostModel {
 public:
  explicit CostModel(double fixed_part) : fixed_part_(fixed_part), prior_(fixed_part) {}

  double work(double area) const { return fixed_part_ + (1 - fixed_part_) * area; }
  double area_for(double work) const { return (work - fixed_part_) / (1 - fixed_part_); }

  // area_for() if less of the cost scaled than is believed, for moves away from an area that must not fall
  // short. The doubt vanishes as b becomes known.
  double cautious_area_for(double work, double from_area) const;

  // Times of frames in order. Only neighbours whose areas differ enough say something about b.
  void learn(double area, double time);
  // The next frame's time has an error that those before it had not: it is no neighbour of theirs.
  void part_from_frames_before() { last_time_ = 0; }

  double fixed_part() const { return fixed_part_; }

 private:
  double fixed_part_;
  double prior_;
  double weighted_sum_ = 0;
  double weights_ = 0;
  double last_area_ = 0;
  double last_time_ = 0;
};

// The level of a load (see CostModel), its noise, and what stands out from it.
//
// Within the noise the level follows an average whose rate grows while the residuals keep one sign (after
// Trigg and Leach, "Exponential smoothing with an adaptive response rate", 1967): slow on noise, fast on a
// trend. One residual beyond the noise is an outlier, which the level ignores; a second one in a row on the
// same side is a step.
class LevelTracker {
 public:
  // `work` is what the frame's area counts for, so that time / work is its level.
  void observe(double work, double time);

  double level() const { return level_; }
  // With what outliers, which the level leaves out, add on average.
  double mean_level() const { return level_ * (1 + bias_); }
  double sigma() const { return sigma_; }  // relative
  double trend() const { return trend_; }  // smoothed relative residual: above 0 while the load grows
  // Where the last frame was an outlier: the level if it was a step; else 0.
  double suspect() const { return suspect_; }
  // Second largest time above expectation among the last frames: what has to be expected again.
  double recurring_excess() const;

 private:
  static constexpr std::size_t kRemembered = 120;

  void follow_outlier(double residual, double level);
  void restart(double level);

  double level_ = 0;
  double sigma_ = 0.01;
  double bias_ = 0;
  double trend_ = 0;
  double magnitude_ = 0;  // smoothed absolute residual
  double suspect_ = 0;
  int outliers_ = 0;  // the last frame was one: 1 upwards, -1 downwards
  std::array<double, kRemembered> excess_ = {};
  std::size_t count_ = 0;
};

// The time by which the device is behind the display, in ms.
//
// At 0 it finished in time for the refresh before the one it has to meet, and now waits for a free buffer; the
// queue is full. At slack() it finished just in time. Beyond that a refresh is missed, and the backlog starts
// again one refresh lower. Each frame adds its time and takes away one refresh interval. As the phase of the
// display is not known, the backlog is taken for the worst until the queue is seen full, and again after a
// missed refresh that was not expected.
class PresentationBacklog {
 public:
  explicit PresentationBacklog(int buffers) : buffers_(buffers) {}

  struct Frame {
    double gpu_ms;
    double cpu_ms;
    double interval_ms;
    int queued;
    int missed_vsyncs;
  };
  void observe(const Frame& frame, double refresh_ms);

  double now() const { return backlog_; }
  double slack(double refresh_ms) const { return (buffers_ - 2) * refresh_ms; }

 private:
  int buffers_;
  double backlog_ = 0;
  double last_gpu_ms_ = 0;
  bool certain_ = false;
};

// Checks settings for every controller that is made from them. Errors: kInvalidArgument for a field outside its range,
// but for the ladder and the target.
Status check(const PredictiveSettings& settings);

class PredictiveModel {
 public:
  // `ladder` outlives this; the settings are checked.
  PredictiveModel(const ResolutionLadder& ladder, const PredictiveSettings& settings);

  // A frame of which `apart_ms`, in [0, timing.gpu_ms), was not drawing.
  void observe(const FrameTiming& timing, double apart_ms, double target_ms);
  // Before observe(): that frame's `apart_ms` errs otherwise than those before it, so that their difference says
  // nothing of what scales.
  void part_from_frames_before() { cost_.part_from_frames_before(); }

  // Rules for a move: dead bands keep the rung while a move would gain little. Not where the parts of a frame are
  // others from now on.
  enum class Bands : std::uint8_t { kKeep, kNone };
  // The rung of the next frame, if the last one was `rung`; never above what blur leaves worth drawing. `apart_ms`: of
  // the next frame.
  int wanted_rung(int rung, double apart_ms, Bands bands = Bands::kKeep) const;
  // Records what the next frame was given; has to be told, and once for each observe().
  void choose(int from_rung, int rung, double apart_ms);

  // Returns the time that a frame may take while the backlog rests, ms; where the processor is followed, its time.
  double steady_ms() const;
  // The largest rung with which drawing and `apart_ms` take steady_ms(), without dead bands; the lowest one where none
  // does.
  int steady_rung(double apart_ms) const;
  double draw_ms(double area) const { return level_.mean_level() * cost_.work(area); }

  bool has_outlier() const { return level_.suspect() > 0; }  // the last frame may have been a step
  // The processor takes longer than target and device, and is not followed.
  bool held_by_cpu() const { return cpu_bound() && !follows_cpu(); }
  std::uint64_t next_frame() const { return next_; }  // that wanted_rung() is for

 private:
  static constexpr std::uint64_t kRemembered = 16;
  struct Chosen {
    double area = 0;
    double apart_ms = 0;
  };

  double backlog_then(double level) const;
  double aim() const;
  std::optional<double> area_to_survive(double now, double apart_ms) const;
  int move_to(double area, int rung, Bands bands) const;
  double cpu_target() const;
  bool cpu_bound() const;
  bool follows_cpu() const;
  double blur_limit() const;
  double area_within(double ms, double apart_ms) const;
  bool has_slack() const { return settings_.buffers > 2; }

  const ResolutionLadder* ladder_;
  PredictiveSettings settings_;
  CostModel cost_;
  LevelTracker level_;
  PresentationBacklog backlog_;
  std::array<Chosen, kRemembered> chosen_;  // each frame's, by its number
  std::array<double, 5> cpu_ms_ = {};
  std::size_t cpu_count_ = 0;
  double target_ms_;
  double last_cpu_ms_ = 0;
  double last_gpu_ms_ = 0;
  std::uint64_t next_ = 0;
  std::uint64_t first_unknown_ = 0;
  double blur_px_ = 0;
  int since_change_ = 0;
};

}  // namespace quincunx
