// SPDX-License-Identifier: MIT
// PredictiveModel: what the predictive controller knows of a load and of the display, and the rung that follows.
//
// A frame's time is that of its drawing, which follows the render extent and is learnt (see cost_model.h and
// level_tracker.h), and a part `apart` that the caller knows and answers for, such as the passes of a method that may
// be another one in the next frame. Without such a part it is 0. docs/control.md has the algorithm.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cost_model.h"
#include "level_tracker.h"
#include "presentation_backlog.h"
#include "quincunx/predictive_controller.h"

namespace quincunx {

class PredictiveModel {
 public:
  // `ladder` outlives this; the settings are checked.
  PredictiveModel(const ResolutionLadder& ladder, const PredictiveSettings& settings);

  // A frame of which `apart_ms`, in [0, timing.gpu_ms), was not drawing.
  void observe(const FrameTiming& timing, double apart_ms, double target_ms);
  // Before observe(): that frame's `apart_ms` errs otherwise than those before it, so that their difference says
  // nothing of what scales.
  void part_from_frames_before() { cost_.part_from_frames_before(); }

  // What moves the rung: dead bands keep it while a move would gain little. Not where the parts of a frame are others
  // from now on.
  enum class Bands : std::uint8_t { kKeep, kNone };
  // The rung of the next frame, if the last one was `rung`; never above what blur leaves worth drawing. `apart_ms`: of
  // the next frame.
  int wanted_rung(int rung, double apart_ms, Bands bands = Bands::kKeep) const;
  // What the next frame was given; has to be told, and once for each observe().
  void choose(int from_rung, int rung, double apart_ms);

  // What a frame may take while the backlog rests, ms; where the processor is followed, its time.
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
  std::array<Chosen, kRemembered> chosen_;  // of each frame by its number
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
