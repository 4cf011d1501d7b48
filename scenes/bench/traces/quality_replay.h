// SPDX-License-Identifier: MIT
// Quality replay: a content trace (a scripted load together with what each frame shows) on a simulated display and
// machine, with a method that is chosen or fixed; and how wrong the picture is, refresh by refresh, dropped frames
// included. Same seed, same trace, on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/traces/load_trace.h"
#include "bench/traces/replay.h"
#include "quincunx/advanced/content_statistics.h"
#include "quincunx/control/quality_controller.h"

namespace quincunx::traces {

struct FrameContent {
  SceneMix mix;         // what counts for the error
  double speed_px = 0;  // speed of the moving parts
  bool cut = false;
};

// Returns the statistics as the program tells them to the controller: each share wrong by a twentieth of the picture at
// most.
ContentStatistics told(const FrameContent& content, std::uint64_t seed, std::size_t frame);

struct ContentTrace {
  LoadTrace load;
  std::vector<FrameContent> content;  // one for each frame
};

// Returns each feasible load of the split with one of four scripts of contents. Held-out scripts have other lengths,
// other mixes and other seeds.
std::vector<ContentTrace> content_traces(Split split, std::uint64_t seed);

// A machine on which the passes of temporal:balanced at scale .71 take this part of a frame's target. Errors and times
// of each method differ at random from the front that is built in, by a standard deviation of a tenth and a fifth.
struct ScriptedMachine {
  std::string name;  // "strong"
  double balanced_part = 0;
};
std::vector<ScriptedMachine> scripted_machines();
ErrorFront front_of(const ScriptedMachine& machine, double target_ms, double output_megapixels,
                    std::uint64_t seed);

// Returns the front that a calibration on `machine` would measure: each error and time within some per cent.
ErrorFront measured_front(const ErrorFront& machine, std::uint64_t seed);

// The input of a replay.
struct QualityStage {
  const ContentTrace* trace = nullptr;
  const ErrorFront* machine = nullptr;  // its true errors and times
  Display display;
  std::uint64_t seed = 1;    // seeds the errors in what the program is told
  bool times_passes = true;  // the program knows what the resolve took; else the whole frame alone
};

// Figures of a trace, or their means.
struct QualityScore {
  int frames = 0;                 // that count
  double dropped = 0;             // refreshes without a new frame
  double flip = 0;                // mean expected FLIP of a refresh
  double changes_per_second = 0;  // changes of method
  double pixels = 0;              // mean area fraction
};

// Returns the milliseconds that the passes of a method take on the stage's machine.
double passes_ms(const QualityStage& stage, const ResolutionLadder& ladder, const MethodVariant& method,
                 double area);

// Replays with a controller that chooses the method; with a fixed method, where `controller` sizes the frames, or all
// have scale 1 if it is null.
QualityScore replay_quality(const QualityStage& stage, QualityController& controller);
QualityScore replay_fixed(const QualityStage& stage, const ResolutionLadder& ladder,
                          ResolutionController* controller, const MethodVariant& method);
// Returns the least error of any method and resolution with which each frame fits into one refresh, knowing its load
// and the machine, as if all history were there. Where none fits it takes the first method at the lowest resolution.
QualityScore oracle(const QualityStage& stage, const ResolutionLadder& ladder);

}  // namespace quincunx::traces
