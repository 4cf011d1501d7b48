// SPDX-License-Identifier: MIT
// Replays a content trace on a simulated display and machine, with a method that is chosen or fixed, and says how wrong
// what was shown is: refresh by refresh, dropped frames included.
#pragma once

#include <vector>

#include "bench/traces/content_trace.h"
#include "bench/traces/replay.h"
#include "quincunx/quality_controller.h"

namespace quincunx::traces {

// What a replay runs on.
struct QualityStage {
  const ContentTrace* trace = nullptr;
  const ErrorFront* machine = nullptr;  // its true errors and times
  Display display;
  std::uint64_t seed = 1;    // of what the program is told wrongly
  bool times_passes = true;  // the program knows what the resolve took; else the whole frame alone
};

struct QualityScore {
  int frames = 0;                 // that count
  int dropped = 0;                // refreshes without a new frame
  double error = 0;               // mean expected FLIP of a refresh
  double changes_per_second = 0;  // of method
  double area = 0;                // mean area fraction
};

// What the passes of a method take there.
double passes_ms(const QualityStage& stage, const ResolutionLadder& ladder, const FrontMethod& method,
                 double area);

QualityScore replay_quality(const QualityStage& stage, QualityController& controller);
// The method stays; `controller` sizes frames, null: all at scale 1.
QualityScore replay_fixed(const QualityStage& stage, const ResolutionLadder& ladder,
                          ResolutionController* controller, const FrontMethod& method);
// The least error of any method and resolution with which each frame fits into one refresh, knowing its load and the
// machine, as if all history were there. Where none fits it takes the first method at the lowest resolution.
QualityScore oracle(const QualityStage& stage, const ResolutionLadder& ladder);

}  // namespace quincunx::traces
