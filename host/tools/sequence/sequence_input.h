// SPDX-License-Identifier: MIT
// Sequence input: what a command line says of a sequence, and what that comes to with the first frame at
// hand.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "quincunx/resolve_plan.h"
#include "tools/sequence/frame_pattern.h"
#include "tools/sequence/sequence_attributes.h"
#include "tools/sequence/sequence_channels.h"
#include "tools/sequence/sequence_conventions.h"
#include "tools/sequence/sequence_jitter.h"

namespace quincunx::tools {

// Stands for a near plane that nobody names: nearer than any surface, in whatever unit. What compares depths
// compares their ratios, and a power of two keeps those exact.
inline constexpr float kUnknownNear = 0x1p-10f;

// Where motion comes from.
enum class MotionSource : std::uint8_t {
  kAutomatic,  // backward.u and backward.v where the first frame has them, else nothing moves
  kChannels,
  kCamera,  // only the camera moves: depth and the attribute worldToNDC of each frame
  kNone,
};

struct SequenceInput {
  std::string colour_layer;  // "ViewLayer.Combined"; empty: R, G, B, A, or Y
  MotionSource motion = MotionSource::kAutomatic;
  std::array<std::string, 2> velocity;  // of kChannels
  std::optional<VelocityUnits> units;   // needed for other channels than backward.u/.v
  std::optional<std::string> depth;     // absent: Z where there is one; empty: none
  std::optional<DepthKind> depth_kind;  // absent: the attribute depthKind, else linear
  std::optional<float> near_plane;      // absent: the attribute near, else kUnknownNear
  std::optional<std::string> reactive;  // absent: reactive.mask where there is one; empty: none
  JitterSource jitter;
  std::optional<Extent> output;  // absent: the attribute outputSize
};

// Nothing is left open.
struct SequenceFormat {
  ChannelNames channels;
  MotionSource motion = MotionSource::kNone;  // never kAutomatic
  bool needs_camera = false;                  // the attribute worldToNDC of each frame is read
  VelocityUnits units;
  bool background = true;  // each frame's colour covers it, without alpha: known when all headers were read
  DepthKind depth_kind = DepthKind::kLinear;
  float near_plane = kUnknownNear;
  JitterSource jitter;
  Extent output;

  Vec2 ratio_of(Extent render) const;  // render / output
};

// Errors: kInvalidArgument where the command line says too little (the message names the option), kIoFailure
// where the first frame lacks what the command line counts on.
Result<SequenceFormat> settle(const SequenceInput& input, const std::string& first_path,
                              const ImageHeader& first, const FrameAttributes& attributes);

// What a scene of this format needs of the resolve: only what the frames bring can be used.
SceneNeeds needs_of(const SequenceFormat& format);

// Forgets the channels that the plan does not read. Errors: kIoFailure where the plan reads depth, but the
// frames have none.
Status keep_what_is_read(SequenceFormat& format, const ResolvePlan& plan);

// Text that tells two formats apart, for people too: "velocity motion.X,motion.Y fsr2, jitter attribute".
std::string summary_of(const SequenceFormat& format);

}  // namespace quincunx::tools
