// SPDX-License-Identifier: MIT
// Foretelling: how well one frame foretells the next at some thousand places with texture, under a guess of motion and
// jitter. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tools/diagnose/diagnose.h"

namespace quincunx::tools {

inline constexpr float kMostError = .15f;  // of light: errors beyond this are all as wrong

// A frame's luminance, tone mapped into [0, 1] and softened, so that a sample between texels is no noisier than one on
// a texel: else guesses that fall between would win.
struct Plane {
  Extent extent;
  std::vector<float> values;
};

// A pixel of a frame that has texture about it.
struct Place {
  int x = 0;
  int y = 0;
  float light = 0;
  std::array<Vec2, 3> velocity = {};  // channels of the frame before, this and the next at this pixel
  Vec2 camera = {};                   // motion from depth and camera, pixels of this frame
};

// Two consecutive frames.
struct Pair {
  std::size_t now = 0;     // index of the later frame; the earlier is the one before it
  std::size_t before = 0;  // index of the earlier's plane
  Vec2 ratio = {1, 1};     // sizes of the earlier frame's in the later's
  bool has_next = false;
  bool has_second = false;  // the frame before the earlier one
  std::vector<Place> places;
};

// Else it is of shapes: planes and pairs of depth come after those of light.
inline bool is_of_light(const Pair& pair) {
  return pair.before + 1 == pair.now;
}

// Pixels of the later frame by which each place has moved since the earlier one.
using Motion = std::vector<Vec2>;

// Returns the factor of luminance before it is tone mapped.
float light_scale(std::span<const DiagnosedFrame> frames);

std::vector<Plane> planes_of(std::span<const DiagnosedFrame> frames);

// Whether a frame comes directly after the one before it in the list, without a cut.
bool follows(std::span<const DiagnosedFrame> frames, std::size_t i);

// The pair of a frame that follows, without places.
Pair pair_of(std::span<const DiagnosedFrame> frames, std::size_t now);

// Pairs of light, with places.
std::vector<Pair> pairs_of(std::span<const DiagnosedFrame> frames, const std::vector<Plane>& planes);

// Adds planes of depth, as light is, and returns the pairs that they make: their places are the near sides of rims.
std::vector<Pair> add_shapes(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                             std::vector<Plane>& planes);

// Returns the earlier frame's light where each place was, 0 and more; -1 where that is out of the picture. `shift`:
// this frame's jitter, in the earlier frame's pixels, less that frame's.
std::vector<float> foretold_light(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift);

// Returns the squared errors of that; a place that left the picture is wholly wrong.
std::vector<float> foretell(const Pair& pair, const Plane& before, const Motion& motion, Vec2 shift,
                            std::size_t stride = 1);

// Returns the sum of those of some hundred places under the shift that foretells best, within a pixel and a quarter.
double least_error(const Pair& pair, const Plane& before, const Motion& motion);

// How one guess compares with another, at the places where they differ.
struct Comparison {
  double margin_db = 0;    // by how much the first is better
  double certainty = 0;    // standard errors by which its mean over blocks of the picture is
  double share = 0;        // of the pairs in which it is
  std::size_t places = 0;  // where they differ
};

// A guess at all pairs. A pair that it says nothing of has no errors.
struct Foretold {
  const std::vector<Motion>* motion = nullptr;  // outlives this
  float apart = .2f;                            // pixels from which on it differs from another guess
  std::vector<Vec2> shift;
  std::vector<std::vector<float>> errors;
};

// By light and shapes, or by light alone, whichever is clearer.
Comparison compare(std::span<const Pair> pairs, std::span<const DiagnosedFrame> frames, const Foretold& one,
                   const Foretold& other);

// Gives a finding the figures of what decided it.
void weigh(Finding& finding, const Comparison& comparison);

// The least margin by which a guess is believed: many places make small ones certain. Other motion than is said must be
// better by more, since some surfaces foretell badly whatever moves them: thin ones, and those that mirror.
inline constexpr double kLeastDb = .3, kLeastMotionDb = 1;

// Whether that is enough to believe the first.
bool clear(const Comparison& comparison, double least_db = kLeastDb);

// A guess that deviates from what the input says in so many ways; the first of a list in none.
struct Candidate {
  std::size_t faults = 0;
  std::size_t motion = 0;  // the same number: the same motion
  Foretold foretold = {};
};

// Returns the candidate to believe: the simplest that no more complicated one clearly betters.
std::size_t choose(std::span<const Pair> pairs, std::span<const DiagnosedFrame> frames,
                   const std::vector<Candidate>& candidates);

// Tells the word of the input, where it is believed, from its rivals.
struct Rivals {
  std::size_t beaten = 0;
  Comparison nearest = {};             // the least margin over those that are clearly beaten
  std::vector<std::string> open = {};  // names of the others

  void add(const Comparison& compared, const std::vector<std::string>& faults);
  void judge(Finding& finding) const;
};

}  // namespace quincunx::tools
