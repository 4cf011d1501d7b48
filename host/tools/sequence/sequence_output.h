// SPDX-License-Identifier: MIT
// Sequence output: the files that resolved frames go to, whole or not at all, and how far the frames are from true ones
// in files, where there are any.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/image/image_io.h"
#include "tools/page/scored_frames.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/work_queue.h"

namespace quincunx::tools {

enum class Made : std::uint8_t { kNot, kOtherwise, kAsWanted };  // kOtherwise: or in part

// A value; its functions are thread-safe for different frames.
struct SequenceOutput {
  FramePattern pattern;
  Extent extent;
  ChannelType stored = ChannelType::kHalf;  // type in an EXR
  ToneMap tone_map = ToneMap::kClamp;       // of a DPX
  std::string settings = {};  // what the pixels depend on: the attribute quincunx:resolve of an EXR

  std::string path(std::int64_t frame) const { return pattern.expand(frame); }

  // Returns whether the frame's file is there as this run would make it: whole to its last pixel, of this extent, and,
  // as an EXR tells, made with these settings.
  Made made(std::int64_t frame) const;

  // Returns what the frame's file says of its settings; empty where there is no such file, or it says nothing.
  std::string settings_in(std::int64_t frame) const;

  // Whether the picture as presented is written, in 8 bits. Else light is, or what is made from it.
  bool presents() const { return has_8_bits(format_of(pattern)); }

  // Linear RGBA floats, and the attributes that the frame keeps. The same pixels make the same file, byte for
  // byte. `exposure`: of a picture as displayed. Errors: kIoFailure.
  Status write_linear(std::int64_t frame, std::span<const float> rgba, float exposure,
                      std::span<const Attribute> kept) const;

  // Whether a file cannot hold all of this light: it is above what the halves of an EXR hold.
  bool clips(std::span<const float> rgba) const;

  // RGBA8, sRGB encoded.
  Status write_presented(std::int64_t frame, std::span<const std::uint8_t> rgba,
                         std::span<const Attribute> kept) const;

  // That these frames can be written without harm. Errors: kInvalidArgument where they would overwrite one
  // another or one of `inputs` (by whatever name), kIoFailure where one is a folder.
  Status check_names(std::span<const std::int64_t> frames, std::span<const std::string> inputs) const;

  // Makes the folder, and removes the temporary files of these frames, at least one and ascending, that a killed run
  // left behind. Errors: kIoFailure where that is not possible or nothing can be written there.
  Status prepare_folder(std::span<const std::int64_t> frames) const;
};

using SharedPixels = std::shared_ptr<const std::vector<float>>;  // linear RGBA

// True pictures: linear colour of the output's size, as display windows tell it; nothing (black) beyond a data window.
struct TruthFiles {
  FramePattern pattern;
  std::string layer = {};         // as PictureWish has it
  std::string view = {};          // of the picture that is scored; counts in files that have it
  std::string colour_space = {};  // of files that say nothing of theirs, as SequenceInput has it
};

// Measures on a thread of its own, a frame or two behind who adds them.
class SequenceScores {
 public:
  // `frames`: those that will be added, ascending. Errors: kIoFailure where none of them has a true picture,
  // or one is cut short, lacks a picture or has another size than `extent`. `keep_pictures`: as ScoredFrames has it.
  static Result<std::unique_ptr<SequenceScores>> create(const TruthFiles& truth, Extent extent,
                                                        std::span<const std::int64_t> frames,
                                                        bool keep_pictures);

  // In ascending order. `motion` is copied where it is needed. Frames without truth cost nothing. Errors: of an earlier
  // frame's truth.
  Status add(std::int64_t frame, SharedPixels pixels, const MotionField& motion);
  Status finish();

  const std::vector<ScoreRow>& rows() const { return scored_->rows(); }   // after finish()
  const ReportPictures& pictures() const { return scored_->pictures(); }  // after finish()
  const std::vector<std::string>& files() const { return files_; }
  double busy_seconds() const { return queue_.busy_seconds(); }

 private:
  SequenceScores(const TruthFiles& truth, Extent extent) : truth_(truth), extent_(extent) {}
  Status measure_frame(std::int64_t frame, const std::vector<float>& pixels, const MotionField& motion);

  TruthFiles truth_;
  Extent extent_;
  std::vector<std::int64_t> known_;  // frames that have a truth
  std::vector<std::string> files_;   // theirs
  std::optional<ScoredFrames> scored_;
  WorkQueue queue_{1, 1};  // last: its thread uses the rest
};

}  // namespace quincunx::tools
