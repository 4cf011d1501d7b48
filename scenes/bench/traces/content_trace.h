// SPDX-License-Identifier: MIT
// ContentTrace: a scripted load together with what each frame shows, and the machine that it runs on: how wrong each
// method is there and what its passes take. Same seed, same trace, on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/traces/load_trace.h"
#include "quincunx/content_statistics.h"

namespace quincunx::traces {

struct FrameContent {
  SceneMix mix;         // what counts for the error
  double speed_px = 0;  // of what moves
  bool cut = false;
};

// What the program tells the controller: the shares, each wrong by a twentieth of the picture at most.
ContentStatistics told(const FrameContent& content, std::uint64_t seed, std::size_t frame);

struct ContentTrace {
  LoadTrace load;
  std::vector<FrameContent> content;  // of each frame
};

// Each feasible load of the split with one of four scripts of what is shown. Held-out scripts have other lengths, other
// mixes and other seeds.
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

// What a calibration there would measure: each error and time within some per cent.
ErrorFront measured_front(const ErrorFront& machine, std::uint64_t seed);

}  // namespace quincunx::traces
