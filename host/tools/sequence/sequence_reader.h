// SPDX-License-Identifier: MIT
// Sequence reader: one file of a sequence as the library wants a frame, in host memory, and what is wrong with a
// sequence that shows in no header, only in the pixels of its frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "tools/record/recorded_frame.h"
#include "tools/sequence/sequence_input.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx::tools {

// Texels are tightly packed, rows top-down, render extent. Reading another frame into the same object reuses
// its memory.
struct SequenceFrame {
  std::int64_t number = 0;
  Extent render;
  // In the plan's formats; colour and albedo as asked for, RGBA16F or RGBA32F. Empty where not read.
  PerPlane<std::vector<std::byte>> texels;
  float exposure = 0;                     // as FrameInputs has it, by the file's attribute; 0: unknown
  std::optional<Matrix> world_to_ndc;     // to -1 to 1, +y up
  bool negative_depth = false;            // in most pixels of the file
  std::optional<RecordedFrame> recorded;  // then the images above are empty
  std::vector<Attribute> kept;            // the file's (camera, rate and the like); the resolved frame's too

  // uv, this - previous position, +v down.
  std::span<Vec2> velocity() { return values_of<Vec2>(texels[InputPlane::kVelocity]); }
  std::span<const Vec2> velocity() const { return values_of<const Vec2>(texels[InputPlane::kVelocity]); }
  // Reversed infinite.
  std::span<float> depth() { return values_of<float>(texels[InputPlane::kDepth]); }
  std::span<const float> depth() const { return values_of<const float>(texels[InputPlane::kDepth]); }

 private:
  template <typename Value, typename Bytes>
  static std::span<Value> values_of(Bytes& bytes) {
    return {reinterpret_cast<Value*>(bytes.data()), bytes.size() / sizeof(Value)};
  }
};

// Reads the channels of `format` of the file that `expected` was scanned from. Where the data window leaves
// pixels of the display window open they are transparent black, at rest, infinitely far and not reactive.
// `colour`: RGBA16F or RGBA32F; halves stay what they were either way. Errors: kIoFailure, naming `path`.
Status read_frame(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                  PixelFormat colour, SequenceFrame& frame);

// A frame's motion, and what tells which surface a sample of it shows.
struct MotionSamples {
  Extent render;
  Vec2 jitter;
  std::vector<Vec2> velocity;  // as SequenceFrame has it
  std::vector<float> depth;
};

// Returns motion to the next frame, this - next position, for the samples of `now`, whose velocity does not count: that
// of `next`, turned round. Not a number where `next` shows nothing of a sample's surface. Pure.
std::vector<Vec2> turned_motion(const MotionSamples& now, const MotionSamples& next);

// Returns the variance of a sample's light, in parts of its square, at most 1; 0 where frames are clean or do not tell.
// Reads the first 33 frames of the sequence that lie on disk, whatever is asked for, so that chunks agree. 0 where they
// have no motion; nothing where they are fewer, with a gap, broken or of several sizes.
std::optional<float> noise_of(const FramePattern& pattern, const SequenceFormat& format);

// Reads a recorded frame of the plan. Errors: kIoFailure, naming the file.
Status read_recorded(const std::string& folder, const ScannedFrame& expected, const ResolvePlan& plan,
                     SequenceFrame& frame);

// Sees frames one after another. One thread.
class SequenceWatch {
 public:
  SequenceWatch(const ResolvePlan& plan, float near_plane) : plan_(plan), near_plane_(near_plane) {}

  // Sentences, each once in a sequence; most often none. `reset`: nothing of the frame before counts.
  std::vector<std::string> see(const SequenceFrame& frame, bool reset);

 private:
  struct Cells {
    std::int64_t number = 0;
    Extent render;
    std::vector<float> means;  // mean of each 16x16 pixels, tone-mapped, in [0, 1]
  };

  std::string see_motion(const SequenceFrame& frame, bool reset);
  std::string see_sky(const SequenceFrame& frame, bool reset);
  std::string see_depth(const SequenceFrame& frame);
  Cells cells_of(const SequenceFrame& frame) const;

  ResolvePlan plan_;
  float near_plane_ = 0;
  bool motion_is_known_ = false;  // some motion was not 0, or the sentence was said
  bool sky_is_known_ = false;     // the sentence was said
  bool depth_is_known_ = false;   // some frame's was not negative, or the sentence was said
  std::optional<Cells> first_;    // the first of the frames that are compared
  std::optional<Matrix> last_world_to_ndc_;
};

}  // namespace quincunx::tools
