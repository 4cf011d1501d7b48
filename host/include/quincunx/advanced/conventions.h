// SPDX-License-Identifier: MIT
// InputConventions: the meaning of depth, velocity, rows and camera in an engine's frames.
//
// Stated once, in ResolveSettings. docs/inputs.md has a table of engines.
#pragma once

#include <cstdint>

#include "quincunx/advanced/export.h"

namespace quincunx {

// Values of FrameInputs::depth and particle_depth. Exactly the value of the far end means that nothing was drawn there:
// it is infinitely far. d: the distance along the view axis; n, f: near_plane and far_plane.
enum class DepthConvention : std::uint8_t {
  kReversedInfinite,  // n / d: 1 at the near plane, 0 at infinity
  kReversed,          // n (f - d) / (d (f - n)): 1 at the near plane, 0 at the far plane
  kInfinite,          // 1 - n / d: 0 at the near plane, 1 at infinity
  kForward,           // f (d - n) / (d (f - n)): 0 at the near plane, 1 at the far plane
  kLinear,            // d; infinity, 0 and less: nothing is there
};

// Return whether a frame needs FrameInputs::far_plane, and near_plane.
constexpr bool needs_far_plane(DepthConvention depth) {
  return depth == DepthConvention::kReversed || depth == DepthConvention::kForward;
}
constexpr bool needs_near_plane(DepthConvention depth) {
  return needs_far_plane(depth) || depth == DepthConvention::kLinear;
}

// Clip space of CameraMotion's matrix.
enum class ClipSpace : std::uint8_t {
  kDirect3D,  // +y up, depth as in the image
  kOpenGl,    // +y up, depth -1 to 1 where the image has 0 to 1
  kVulkan,    // +y down, depth as in the image
};

enum class VelocityUnit : std::uint8_t {
  kUv,      // 1: the viewport
  kPixels,  // 1: a pixel of the viewport
  kNdc,     // 2: the viewport
};

// The row that is first in the memory of images.
enum class Origin : std::uint8_t { kTop, kBottom };

// Source of the motion of samples that are infinitely far away and have a velocity of exactly 0, as many renderers
// write it for the sky whatever the camera does.
enum class SkyMotion : std::uint8_t {
  kAsDrawn,  // none: they stand still in the picture
  kCamera,   // the camera's rotation, from FrameInputs::camera
  kEvidence,  // the camera's motion, found in the drawn motion of all else, where the colour of the far samples agrees
};

// The owner of the velocity that a drawn sample has.
enum class DrawnVelocity : std::uint8_t {
  kOwn,      // the surface that it shows
  kDilated,  // the nearest of its 3x3 samples, as many renderers write it: each gets its own back first
};

// The defaults are the library's own, which cost nothing. Other depth than kReversedInfinite, velocity with jitter in
// it, and image2d_t from the bottom take a pass that writes images of the service's own; the rest takes none.
struct InputConventions {
  DepthConvention depth = DepthConvention::kReversedInfinite;
  ClipSpace clip_space =
      ClipSpace::kDirect3D;  // with kLinear the matrix's depth is always near_plane / distance
  VelocityUnit velocity_unit = VelocityUnit::kUv;
  bool velocity_backward = false;  // previous position - this one
  bool velocity_up = false;        // +y up
  // Both positions are those in the jittered pictures. A velocity of exactly (0, 0) was not drawn, and stays.
  bool velocity_jittered = false;
  // kBottom: all images of a frame, inputs and outputs, begin with the lowest row, from which viewports and the parts
  // of smaller outputs reach upwards; and what counts rows or pixels counts from there: jitter.y, parity, and a
  // focus's y and rectangles. The camera's matrix, velocity and Halton's order are as they are.
  Origin origin = Origin::kTop;
  // Where velocity is drawn.
  DrawnVelocity drawn_velocity = DrawnVelocity::kOwn;
  SkyMotion sky_motion = SkyMotion::kAsDrawn;

  friend bool operator==(const InputConventions&, const InputConventions&) = default;
};

QUINCUNX_API const char* name_of(DepthConvention depth);  // "reversed infinite"
QUINCUNX_API const char* name_of(ClipSpace clip_space);   // "OpenGL"
QUINCUNX_API const char* name_of(VelocityUnit unit);      // "pixels"
QUINCUNX_API const char* name_of(Origin origin);          // "bottom"
QUINCUNX_API const char* name_of(SkyMotion motion);       // "as-drawn"
QUINCUNX_API const char* name_of(DrawnVelocity drawn);    // "dilated"

}  // namespace quincunx
