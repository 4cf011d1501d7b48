// SPDX-License-Identifier: MIT
// Diagnose: what is wrong with the motion, jitter, depth and camera of frames, found from the frames alone. Each frame
// is foretold from the one before under what the input says and under every likely mistake; whichever foretells best
// is what the input means. Pure; thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/record/exchange_format.h"

namespace quincunx::tools {

// A frame as it was given. Images are tightly packed, rows top-down, of the render extent; all but colour may be empty.
struct DiagnosedFrame {
  std::int64_t number = 0;
  std::int64_t index = 0;  // what patterns of jitter count by
  Extent render = {};
  bool reset = false;                 // a cut is marked
  Vec2 jitter = {};                   // as the input says
  std::vector<float> luminance = {};  // linear
  std::vector<std::array<float, 3>> colour =
      {};                                   // the same in R, G and B; a few frames of a sequence suffice
  std::vector<Vec2> velocity = {};          // values of the channels, whatever they mean
  std::vector<float> depth = {};            // the same
  std::optional<Matrix> world_to_ndc = {};  // the same
};

// What the input says that they mean.
struct DiagnosedInput {
  VelocityUnits units = {};  // without offset
  DepthKind depth_kind = DepthKind::kLinear;
  Vec2 depth_range = kWholeRange;  // which the frames' depth has gone through
  Vec2 velocity_offset = {};       // which their velocity has lost
  CameraSense camera = {};
  float near_plane = 1;
  Extent output = {};
  bool dilated = false;    // velocity is said to be
  bool sky_moves = false;  // what moves a sky of velocity 0 is said
  // Names of velocity's channels, for the options that mend.
  std::vector<std::string> channels = kBackwardChannels;
};

enum class Verdict : std::uint8_t {
  kRight,
  kWrong,
  kUnknown,  // the frames do not tell: nothing moves, no texture, or too few frames
};

const char* name_of(Verdict verdict);  // "right", "wrong", "cannot tell"

struct Finding {
  std::string subject;  // "velocity"
  Verdict verdict = Verdict::kUnknown;
  std::vector<std::string> faults = {};  // "sign of x"; some where the verdict is wrong, none else
  std::string says = {};                 // what the input says: "nuke"
  std::string fits = {};                 // what the frames say; empty: as the input
  std::vector<std::string> open = {};  // faults that these frames cannot show: nothing differs, or too little
  double margin_db = 0;     // how much better that foretells than the next best; 0: not a prediction
  double certainty = 0;     // standard errors of that, over blocks of the pictures
  double share = 0;         // of the pairs of frames that say so
  std::string option = {};  // what mends it
};

// What makes the input's jitter the one that fits, where that is no other pattern.
struct JitterMend {
  bool swapped = false;  // x and y, first
  Vec2 factors = {1, 1};
  int later = 0;  // -1: the last frame's fits this one, 1: the next one's

  Vec2 of(Vec2 told) const;
};

struct Diagnosis {
  std::vector<Finding> findings;
  JitterMend jitter = {};
  bool wrong() const;  // some finding is
};

// Where the input's word fails: pictures of a frame's size, tightly packed, both from 0 to 1.
struct FailureMap {
  std::int64_t number = 0;  // the frame's
  Extent extent = {};
  std::vector<float> light = {};  // as it is seen, tone mapped
  std::vector<float> error = {};  // of what the frame before foretold; 1: by .15 or more of that light
  double mean = 0;                // of the errors
};

// Returns the maps of those frames, at most so many, that their input's word foretells worst; the worst first.
// Takes some 0.1 s a frame of 1280x720 on one core.
std::vector<FailureMap> failure_maps(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                                     std::size_t most = 3);

// Looks at consecutive frames, of which a dozen are enough and three the least; those after a gap in the numbers begin
// anew. Takes some 0.2 s a frame of 1280x720 on one core.
Diagnosis diagnose(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input);

}  // namespace quincunx::tools
