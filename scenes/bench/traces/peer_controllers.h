// SPDX-License-Identifier: MIT
// Stand-ins for controllers that others use, written from their public descriptions, to be replayed beside
// ours. All act on the scale of both axes, with the ladder's range as theirs, and see nothing but what they
// see at home.
#pragma once

#include <memory>

#include "quincunx/control/resolution_controller.h"

namespace quincunx::traces {

using Controller = std::unique_ptr<ResolutionController>;

// Unreal Engine's documented heuristic: the mean of the last 16 frames' estimates, each 0.9 of the next newer
// one's weight, at 10 % headroom; at most one change in 8 frames and none below 2 %; two over-budget frames
// in a row panic.
Controller make_unreal_like(const ResolutionLadder& ladder, double target_ms);

// Vlachos, "Advanced VR Rendering Performance" (The Lab), 2016: above 90 % of the budget two of ten levels
// down, also if above 85 % and a straight line through the last two times comes out above 90 %; after three
// frames below 70 % one level up; two frames of rest after a change.
Controller make_valve_like(const ResolutionLadder& ladder, double target_ms);

// Unity's DynamicResolutionSample: down at once by the excess or by a rise larger than the headroom; up in
// small steps when a counter reaches 360.
Controller make_unity_like(const ResolutionLadder& ladder, double target_ms);

// Google Filament's PID on the pixel count: error from the median of the last 15 times, gains 1 - exp(-1/8)
// and .002, dead band of 1 % down and 5 % up, headroom .05.
Controller make_filament_like(const ResolutionLadder& ladder, double target_ms);

}  // namespace quincunx::traces
