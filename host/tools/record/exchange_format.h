// SPDX-License-Identifier: MIT
// Exchange format: the arithmetic between the library's motion, depth and camera and those of an EXR sequence, of this
// project or of other renderers (docs/inputs.md). Pure; thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/frame.h"
#include "quincunx/status.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {

// The format's channels.
inline const std::vector<std::string> kColourChannels = {"R", "G", "B", "A"};
inline const std::vector<std::string> kBackwardChannels = {"backward.u", "backward.v"};
// Motion to the next frame: next - this position, as Nuke has it.
inline const std::vector<std::string> kForwardChannels = {"forward.u", "forward.v"};
inline const std::string kDepthChannel = "Z";
inline const std::string kReactiveChannel = "reactive.mask";

// `Z` where no surface was seen: finite, so that a filter over Z makes no NaN, far beyond any scene, and what
// Blender writes there.
constexpr float kNoSurfaceZ = 1e10f;

// Reversed infinite depth (1 at the near plane, 0 at infinity) to linear distance along the view axis, in the
// unit of `near_plane`. 0, negative and not-a-number depths, and surfaces beyond kNoSurfaceZ, give
// kNoSurfaceZ.
float linear_z(float depth, float near_plane);

// The way back: a Z that is not below kNoSurfaceZ, or not a number, is depth 0; one before the near plane
// is 1.
float reversed_depth(float z, float near_plane);

// uv velocity (this position - previous position, +y down) to `backward.u`, `backward.v`: previous - current
// in pixels of an image of this extent, +v up.
Vec2 backward_from_velocity(Vec2 velocity, Extent extent);
Vec2 velocity_from_backward(Vec2 backward, Extent extent);

enum class VelocityConvention : std::uint8_t {
  kNuke,     // previous - this position, pixels of the image, +u right, +v up: the exchange format
  kBlender,  // X and Y of the Vector pass, which are the same
  kFsr2,     // previous - this position, pixels of the image, y down
  kNdc,      // this - previous position in normalised device coordinates, -1 to 1, y up
  kScale,    // this - previous position in uv, y down, after multiplication by a scale
};

struct VelocityUnits {
  VelocityConvention convention = VelocityConvention::kNuke;
  Vec2 scale = {1, 1};   // factor of kScale
  Vec2 offset = {};      // the channels' values at rest
  bool to_next = false;  // earlier - later is from this frame to the next, not from the previous one to this
  bool jittered =
      false;  // both positions are those in the jittered pictures; to_velocity() leaves that as it is
};

enum class DepthKind : std::uint8_t {
  kLinear,          // distance along the view axis
  kDevice,          // 0 at the near plane, 1 far away
  kDeviceReversed,  // 1 at the near plane, 0 far away: the library's own
};

// What depths of 0 and 1 stand for.
inline constexpr Vec2 kWholeRange = {0, 1};

const char* name_of(VelocityConvention convention);  // "nuke"
const char* name_of(DepthKind kind);                 // "device-reversed"
std::optional<DepthKind> depth_kind_named(std::string_view name);

// In place, to uv velocity (this position - previous position, or with `to_next` this - next, +y down) of an image of
// this extent. Without offset each value meets one rounding: a division by the extent where pixels are meant.
void to_velocity(const VelocityUnits& units, Extent extent, std::span<Vec2> motion);

// In place, to reversed infinite depth. kDeviceReversed stays bit for bit. `near_plane` counts for kLinear
// only, in the unit of the values; distances that are not positive mean that nothing was seen, as very large
// ones do.
void to_reversed_depth(DepthKind kind, float near_plane, std::span<float> depth);

// In place: 0 becomes range.x and 1 range.y. What is not a number, nothing_seen(); {0, 1} leaves all bits.
void scale_depth(Vec2 range, DepthKind kind, std::span<float> depth);

// Returns the depth of a pixel that no file says anything about: infinitely far away.
float nothing_seen(DepthKind kind);

Matrix transposed(Matrix matrix);
bool is_orthographic(const Matrix& matrix);  // for row vectors

// Whether a matrix for row vectors is that of a camera with a lens: strictly, or so that it may be one.
struct CameraForm {
  bool is = false;
  bool may_be = false;
  Vec2 centre = {};  // x and y of the optical axis
};

CameraForm camera_form(const Matrix& matrix, Extent extent);

// What the attribute worldToNDC of a file maps to, where that is not -1 to 1, +y up, or not for row vectors.
struct CameraSense {
  bool unit = false;     // 0 to 1, +y down, as OpenEXR's own header has it
  bool flipped = false;  // y the other way
  bool transposed = false;

  friend bool operator==(const CameraSense&, const CameraSense&) = default;
};

// Returns the sense that a camera with a lens shows by its form; else the default.
CameraSense sense_of(const Matrix& matrix, Extent extent);
Matrix to_screen(const Matrix& matrix, const CameraSense& sense);  // -1 to 1, +y up, for row vectors
std::string text_of(const CameraSense& sense);                     // "openexr,flipped"
std::optional<CameraSense> camera_sense_named(std::string_view text);

// Returns the camera's motion between two frames from their matrices to -1 to 1, +y up, for depth that is `near_plane`
// / distance, whatever the z of the matrices means: that of a point follows from its distance alone. Exactly the
// identity for equal matrices. Nothing where `now` cannot be inverted, or an orthographic camera turns its axis: motion
// does not follow from such depth then.
std::optional<CameraMotion> camera_motion(const Matrix& now, const Matrix& before, float near_plane);

}  // namespace quincunx::tools
