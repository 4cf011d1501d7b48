// SPDX-License-Identifier: MIT
// Findings: the parts of diagnose(), each of which looks at one kind of mistake, in the order of their calls. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/foretelling.h"
#include "tools/diagnose/motion_guesses.h"

namespace quincunx::tools {

inline std::size_t pixel_of(const DiagnosedFrame& frame, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.render.width) +
         static_cast<std::size_t>(x);
}

// Does motion end where surfaces of its own frame do, or of the frame before or after? Needs neither texture nor units.
struct Lateness {
  bool known = false;
  int later = 0;     // frames by which the motion that fits was written too early
  double share = 0;  // of the rims that say so, where it is not 0
};

Lateness find_lateness(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input);

// What depth and matrices are by themselves, whatever moves. On a flat surface device depth is affine in the picture,
// and so is the inverse of linear depth; a camera's axes are perpendicular, and it looks along a unit vector.
struct Form {
  DepthKind stated = DepthKind::kLinear;
  std::optional<DepthKind> kind = {};
  std::optional<bool> transposed = {};
};

Form form_of(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input);

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

MotionAnswer find_motion(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                         const Form& form, const std::vector<Plane>& planes, const std::vector<Pair>& pairs);

// What the other parts look at.
struct Scene {
  std::span<const DiagnosedFrame> frames;
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
  float near_factor = 1;  // the near plane's distance, over what the input says; counts for device depth
};

// Judges depth and camera; returns the guess to believe.
DepthGuess find_depth(const Scene& scene, std::vector<Finding>& findings);

// Returns the motion of each pair's places by depth and camera; none where the input says neither.
std::vector<Motion> stated_camera_motion(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                                         const Form& form, const std::vector<Plane>& planes,
                                         const std::vector<Pair>& pairs);

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
