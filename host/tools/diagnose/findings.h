// SPDX-License-Identifier: MIT
// Findings: the parts of diagnose(). Pure.
//   foretelling.cpp      how well one frame foretells the next at some thousand places with texture
//   motion_guesses.cpp   what motion and jitter may mean
//   find_*.cpp           each looks at one kind of mistake; in the order of their calls
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/diagnose.h"
#include "tools/program/jitter.h"

namespace quincunx::tools {

using Frames = std::span<const DiagnosedFrame>;

inline std::size_t pixel_of(const DiagnosedFrame& frame, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.render.width) +
         static_cast<std::size_t>(x);
}

inline Vec2 difference(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}

inline Vec2 product(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.y * b.y};
}

inline float square(Vec2 v) {
  return v.x * v.x + v.y * v.y;
}

// Returns a frame's depth as reversed device depth.
std::vector<float> reversed_depth(const DiagnosedFrame& frame, DepthKind kind, float near_plane);

// Foretelling.

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
float light_scale(Frames frames);

std::vector<Plane> planes_of(Frames frames);

// Whether a frame comes directly after the one before it in the list, without a cut.
bool follows(Frames frames, std::size_t i);

// The pair of a frame that follows, without places.
Pair pair_of(Frames frames, std::size_t now);

// Returns the motion of pairs in which nothing moves.
std::vector<Motion> at_rest(const std::vector<Pair>& pairs);

// Returns the step of the jitter to a pair's later frame, in the earlier frame's pixels.
inline Vec2 shift_of(const Pair& pair, Vec2 now, Vec2 before) {
  return difference(product(now, pair.ratio), before);
}

// Pairs of light, with places.
std::vector<Pair> pairs_of(Frames frames, const std::vector<Plane>& planes);

// Adds planes of depth, as light is, and returns the pairs that they make: their places are the near sides of rims.
std::vector<Pair> add_shapes(Frames frames, const DiagnosedInput& input, std::vector<Plane>& planes);

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
Comparison compare(std::span<const Pair> pairs, Frames frames, const Foretold& one, const Foretold& other);

// Gives a finding the figures of what decided it.
void weigh(Finding& finding, const Comparison& comparison);

// Votes of pixels: how many say yes, of those that say anything.
struct Votes {
  std::size_t yes = 0;
  std::size_t all = 0;

  void add(bool vote) { yes += vote ? 1 : 0, ++all; }
  double share() const { return all > 0 ? static_cast<double>(yes) / static_cast<double>(all) : 0; }
  // Whether there are enough, and most of them say yes or all but a part say no.
  bool agree(std::size_t least, double part) const { return all >= least && (share() <= part || most()); }
  bool most() const { return share() >= .8; }
  double agreed() const { return most() ? share() : 1 - share(); }
};

// Makes a finding wrong or right, where `share` of what says anything says so; the rest is of a wrong one.
Finding judged(Finding finding, bool wrong, double share, const std::string& fault, const std::string& fits,
               const std::string& option);

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
std::size_t choose(std::span<const Pair> pairs, Frames frames, const std::vector<Candidate>& candidates);

// Tells the word of the input, where it is believed, from its rivals.
struct Rivals {
  std::size_t beaten = 0;
  Comparison nearest = {};             // the least margin over those that are clearly beaten
  std::vector<std::string> open = {};  // names of the others

  void add(const Comparison& compared, const std::vector<std::string>& faults);
  void judge(Finding& finding) const;
};

// What the channels of motion may mean, and what jitter the frames may have been drawn with.

enum class Unit : std::uint8_t { kStated, kUv, kPixels, kOutputPixels, kNdc, kNothing };

struct MotionGuess {
  Unit unit = Unit::kStated;
  bool swapped = false;
  bool flip_x = false;
  bool flip_y = false;
  int later = 0;         // frames by which the motion that fits was written too early
  Vec2 length = {1, 1};  // factors beside the unit's
  Vec2 rest = {};        // values of the channels at rest

  friend bool operator==(const MotionGuess&, const MotionGuess&) = default;
};

// Returns the factors from channels to pixels of a frame of this size.
Vec2 factors_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

Motion motion_of(const Pair& pair, const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

// Whether two guesses say the same of frames of this size, but for a part of the motion.
bool same(const DiagnosedInput& input, const MotionGuess& a, const MotionGuess& b, Extent extent,
          float part = .01f);

// Whether a guess leaves unit, length and values at rest as the input says.
bool keeps_unit(const MotionGuess& guess);

// The input's word first.
std::vector<MotionGuess> motion_guesses(const DiagnosedInput& input, Extent extent);

// Returns a length with numbers from 1 to 4, or one over those, and the same on both axes, where that is near enough.
Vec2 simple(Vec2 length, float room);

// Returns those worth a second look: the input's word first, then those that foretell best with any shift, and of any
// other length or values at rest the one that does, unless one is `explained` by the camera.
std::vector<MotionGuess> best_guesses(Frames frames, const DiagnosedInput& input,
                                      const std::vector<Plane>& planes, const std::vector<Pair>& pairs,
                                      bool explained);

std::vector<std::string> faults_of(const MotionGuess& guess);
std::string text_of(const MotionGuess& guess);
std::string option_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

struct JitterGuess {
  bool swapped = false;
  bool flip_x = false;
  bool flip_y = false;
  float factor = 1;  // 0: none
  int later = 0;
  std::optional<Jitter> pattern = {};  // in place of what the input says

  friend bool operator==(const JitterGuess&, const JitterGuess&) = default;
};

JitterMend mend_of(const JitterGuess& guess);

// Jitter of frame `i`; nothing where the frame beside it that the guess means is not there.
std::optional<Vec2> jitter_at(Frames frames, const DiagnosedInput& input, const JitterGuess& guess,
                              std::size_t i);

// The input's word first.
std::vector<JitterGuess> jitter_guesses(Frames frames, const DiagnosedInput& input);

std::vector<std::string> faults_of(const JitterGuess& guess);
std::string text_of(const JitterGuess& guess);

// Findings.

// Does motion end where surfaces of its own frame do, or of the frame before or after? Needs neither texture nor units.
struct Lateness {
  bool known = false;
  int later = 0;     // frames by which the motion that fits was written too early
  double share = 0;  // of the rims that say so, where it is not 0
};

Lateness find_lateness(Frames frames, const DiagnosedInput& input);

// What depth and matrices are by themselves, whatever moves. On a flat surface device depth is affine in the picture,
// and so is the inverse of linear depth; a camera's axes are perpendicular, and it looks along a unit vector.
struct Form {
  DepthKind stated = DepthKind::kLinear;
  std::optional<DepthKind> kind = {};
  std::optional<bool> transposed = {};
  Vec2 range =
      kWholeRange;  // what 0 and 1 of depth stand for, where its values show that they are not distances
};

Form form_of(Frames frames, const DiagnosedInput& input);

// What motion and jitter are, looked at together, because each hides the other's mistakes.
struct MotionAnswer {
  std::vector<Finding> findings = {};
  bool knows_motion = false;
  std::vector<Motion> motion = {};  // of each pair, as it fits best
  std::vector<Vec2> shift = {};     // the same, of the jitter
  std::vector<Vec2> jitter = {};    // of each frame
  JitterMend mend = {};
  MotionGuess guess = {};  // what the channels mean
  float jitters = 0;       // how much of its steps is missing in them: 1 where the jitter is in them
};

MotionAnswer find_motion(Frames frames, const DiagnosedInput& input, const Form& form,
                         const std::vector<Plane>& planes, const std::vector<Pair>& pairs);

// What the other parts look at.
struct Scene {
  Frames frames;
  const DiagnosedInput& input;  // its depth is of the kind that the form says
  const Form& form;
  const std::vector<Plane>& planes;
  const std::vector<Pair>& pairs;
  const MotionAnswer& motion;
  float light_scale = 1;  // as of light_scale()
};

// Returns the pixels by which what a pixel of a pair's later frame shows has moved, by its own channels as they fit.
Vec2 own_motion(const Scene& scene, const Pair& pair, int x, int y);

enum class Camera : std::uint8_t { kStated, kLast, kNext };

struct DepthGuess {
  DepthKind kind;
  Camera camera = Camera::kStated;
  float near_factor = 1;  // the near plane's distance, over what the input says; of linear depth: the depth's
  bool other_unit = false;  // the camera's sense, against what the input says
  bool flipped = false;
};

// Returns the option by which depth goes through `range` after what the input says.
std::string range_option(const DiagnosedInput& input, Vec2 range);

// Judges depth and camera; returns the guess to believe.
DepthGuess find_depth(const Scene& scene, std::vector<Finding>& findings);

// Returns the motion of each pair's places by depth and camera; none where the input says neither.
std::vector<Motion> stated_camera_motion(Frames frames, const DiagnosedInput& input, const Form& form,
                                         const std::vector<Plane>& planes, const std::vector<Pair>& pairs);

// Whether most of what moves does so as the camera moves it: exactly, which no other motion does by chance. Motion of 0
// was not drawn. `step`: pixels between neighbouring values, where motion is stored in steps.
bool agrees(const std::vector<Pair>& pairs, const std::vector<Motion>& motion,
            const std::vector<Motion>& camera, float step = 0);

// Returns how the camera moved to the later frame of a pair, from so many frames before it (after: less than 0);
// nothing where that is not known.
std::optional<CameraMotion> camera_of(const Scene& scene, const Pair& pair, const DepthGuess& guess,
                                      int back = 1);

// Returns the pixels by which that moves a point at rest, which a frame of this size has at `at`.
Vec2 camera_moves(const CameraMotion& camera, Vec2 at, float depth, Extent extent);

// Where a nearer surface ends, does the pixel beyond it move as that does, or as its own surface?
Finding find_dilation(const Scene& scene, DepthKind kind);

// Is motion of half the size, enlarged?
Finding find_resolution(const Scene& scene);

// Does the sky stand still in the picture although the camera moves it?
Finding find_sky(const Scene& scene, const DepthGuess& guess);

// Are there things that move by themselves, yet have the motion of what is at rest? `coarse`: motion is of half the
// size, which gives thin things that of what is behind them.
Finding find_objects(const Scene& scene, const DepthGuess& guess, bool coarse);

// Is the picture encoded for a screen, and was it filtered already?
Finding find_encoding(const Scene& scene);
Finding find_filter(const Scene& scene, DepthKind kind);

// Judges whether frames follow from each other in brightness, and whether they do at all. `cuts`: frames before which
// cuts are missing; that finding is the last.
void find_light(const Scene& scene, std::vector<Finding>& findings, std::vector<std::int64_t>& cuts);

}  // namespace quincunx::tools
