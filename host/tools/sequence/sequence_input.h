// SPDX-License-Identifier: MIT
// Sequence input: what a command line says of a sequence, and what that comes to with the first frame at hand. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "tools/image/image_reader.h"
#include "tools/program/frame_pattern.h"
#include "tools/record/exchange_format.h"
#include "tools/sequence/sequence_channels.h"
#include "tools/sequence/sequence_jitter.h"

namespace quincunx::tools {

// Stands for a near plane that nobody names: nearer than any surface, in whatever unit. Passes that compare depths
// compare their ratios, and a power of two keeps those exact.
inline constexpr float kUnknownNear = 0x1p-10f;

// Where motion comes from.
enum class MotionSource : std::uint8_t {
  kAutomatic,  // backward.u and backward.v where the first frame has them, else nothing moves
  kChannels,
  kCamera,  // only the camera moves: depth and the attribute worldToNDC of each frame
  kNone,
};

struct SequenceInput {
  PictureWish picture;
  std::string colour_space;  // as InputColour has it; empty: as the files say
  MotionSource motion = MotionSource::kAutomatic;
  std::vector<std::string> velocity;                      // names of kChannels
  std::optional<std::vector<std::string>> next_velocity;  // channels of motion to the next frame
  std::optional<VelocityUnits> units;                     // needed for other channels than backward.u/.v
  Vec2 velocity_offset = {};                              // as VelocityUnits has it
  bool velocity_jittered = false;                         // the same
  std::optional<std::string> depth;                       // absent: Z where there is one; empty: none
  std::optional<DepthKind> depth_kind;                    // absent: the attribute depthKind, else linear
  Vec2 depth_range = kWholeRange;                         // as of scale_depth()
  std::optional<float> near_plane;                        // absent: the attribute near, else kUnknownNear
  std::optional<CameraSense> camera;                      // absent: as the first frame's matrix shows
  std::optional<std::string>
      reactive;  // absent: reactive.mask where there is one; empty: none; or files' pattern
  JitterSource jitter;
  std::vector<std::int64_t> cuts;  // frames that begin another shot, ascending, whatever their attributes say
  std::optional<Extent> output;    // absent: the attribute outputSize
  std::optional<int> two_way;      // frames to look ahead; 0: none; absent: as settle_two_way() has it
};

// Where motion to the next frame comes from, for resolving both ways.
enum class NextMotion : std::uint8_t {
  kChannels,
  kCamera,   // as kCamera of MotionSource
  kNothing,  // nothing moves
  kTurned,   // the next frame's own motion, turned round
};

// Nothing is left open.
struct SequenceFormat {
  std::string recording;  // the folder of recorded frames; empty: they are none
  ChannelNames channels;
  std::string view;                            // the picture's; empty: none
  std::string colour_space;                    // as SequenceInput has it
  std::optional<FramePattern> reactive_files;  // files of their own; channels.reactive is then empty
  std::string converted_from;                  // the first frame's colour space; empty: light as it is wanted
  MotionSource motion = MotionSource::kNone;   // never kAutomatic
  bool needs_camera = false;                   // the attribute worldToNDC of each frame is read
  CameraSense camera;                          // its sense
  VelocityUnits units;
  int two_way = 0;                                // frames to look ahead; 0: only earlier frames count
  NextMotion next_motion = NextMotion::kNothing;  // told where the plan accumulates
  std::vector<std::string> next_velocity;         // channels of kChannels, if the frames have such
  VelocityUnits next_units;
  bool background = true;  // each frame's colour covers it, without alpha: known when all headers were read
  DepthKind depth_kind = DepthKind::kLinear;
  Vec2 depth_range = kWholeRange;
  float near_plane = kUnknownNear;
  JitterSource jitter;
  bool has_exposure = false;       // the first frame's attributes tell it
  std::vector<std::int64_t> cuts;  // as SequenceInput has them
  Extent output;
  bool has_reactive() const { return channels.has(InputPlane::kReactive) || reactive_files; }

  float samples = 0;                 // a pixel, as Cycles says in the first frame; 0: it does not
  std::vector<std::string> ignored;  // the first frame's attributes that look like another program's
};

// A reactive mask of its own: the first channel of a file, of the picture's view where that has it.
struct Mask {
  ImageReader reader;
  ChannelPlace place;
};

// Errors: kIoFailure, also where it has another size or cannot be used.
Result<Mask> open_mask(const std::string& path, Extent render, const std::string& view);

// Errors: kInvalidArgument where the command line says too little (the message names the option), kIoFailure
// where the first frame lacks what the command line counts on.
Result<SequenceFormat> settle(const SequenceInput& input, const std::string& first_path,
                              const ImageHeader& first, const FrameAttributes& attributes);

// Returns the pixels' aspect in an output of frames whose pixels have `aspect`: the same, or 1, where the rounding of
// sides allows it.
float output_aspect(float aspect, Extent render, Extent output);

// Returns the needs of a scene of this format: only what the frames bring can be used.
SceneNeeds needs_of(const SequenceFormat& format);

// Forgets the channels that the plan does not read. Errors: kIoFailure where the plan reads depth, but the
// frames have none.
Status keep_what_is_read(SequenceFormat& format, const ResolvePlan& plan);

// Frames to look ahead by default, where motion to the next frame is known: more are not better.
inline constexpr int kDefaultAhead = 8;

// Settles how far each frame looks ahead, once it is known what the plan reads. Errors: kInvalidArgument where `input`
// asks for what the plan or the frames cannot give.
Status settle_two_way(const SequenceInput& input, const ResolvePlan& plan, SequenceFormat& format);

// Returns how the frames are read by who resolves them backwards: their motion is that to the next frame.
SequenceFormat backward_format(const SequenceFormat& format);

// Text that tells two formats apart, for people too: "velocity motion.X,motion.Y fsr2, jitter attribute".
std::string summary_of(const SequenceFormat& format);

}  // namespace quincunx::tools
