// SPDX-License-Identifier: MIT
// BenchPlan: what will be measured: methods, scenes and scales that the options choose. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_options.h"
#include "bench/speed_error/bench_result.h"
#include "frames/focus_path.h"
#include "frames/frame_sequence.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"
#include "scene.h"

namespace quincunx::bench {

struct BenchMethod {
  std::string name;  // as --method of quincunx-render takes it
  std::string summary;
  ResolveSettings resolve;
  scenes::Jitter jitter = scenes::Jitter::kNone;  // jitter of the frames that it gets
  scenes::TextureDetail detail = {};
  bool accumulates = false;  // all frames so far: it takes many until its picture is what it will be
  bool focuses = false;      // its frames have the focus of the conditions
  bool is_default = false;   // what the programs take where no --method is given
  bool two_way = false;      // its pictures know later frames, too; its times follow from the method without
  std::string dual = {};     // as --dual; empty: its output is the picture's size
};

// Returns every method that there is.
std::vector<BenchMethod> all_methods();

struct BenchPlan {
  std::vector<BenchMethod> methods;
  std::size_t frame_method = 0;  // index: the one whose whole frames are timed
  std::vector<std::string> scenes;
  std::vector<double> scales;
  Conditions conditions;
};

// Makes a plan. Errors: kInvalidArgument, for a wrong name or number; the message says what would be right.
Result<BenchPlan> plan_from(const BenchOptions& options);

// Returns the plan of the first scene and the first method that the options name; by default the courtyard and the
// default method.
Result<BenchPlan> single_plan_from(BenchOptions options);

// Returns the frames of one scale as methods with this jitter and bias get them; their times are seconds_of().
scenes::SequenceSettings sequence_for(const BenchPlan& plan, double scale, const BenchMethod& method);

// Returns the focus of those frames; plan_from() has checked it.
scenes::FocusOptions focus_for(const Conditions& conditions, const BenchMethod& method);

// The frames of a case are numbered from 0: `warm_up` that warm up, those whose errors are measured, again
// some that warm up, and those of the timed rounds. A method that accumulates begins with earlier ones, of
// negative numbers.
int first_frame_for(const Conditions& conditions, const BenchMethod& method);
int frames_of(const Conditions& conditions);

// Returns the scene time of a frame.
double seconds_of(const Conditions& conditions, int frame);

// Returns the conditions of a scene: where it has cuts, its first measured frame is the first after a cut.
Conditions conditions_for(const Conditions& conditions, const scenes::Scene& scene);

}  // namespace quincunx::bench
