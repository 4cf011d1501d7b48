// SPDX-License-Identifier: MIT
// Sequence scores: how far resolved frames are from true ones in files, where there are any.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/page/scored_frames.h"
#include "tools/program/work_queue.h"
#include "tools/sequence/frame_pattern.h"

namespace quincunx::tools {

using SharedPixels = std::shared_ptr<const std::vector<float>>;  // linear RGBA

// True pictures: linear colour of the output's size, as display windows tell it; nothing (black) beyond a data window.
struct TruthFiles {
  FramePattern pattern;
  std::string colour_layer = {};  // as SequenceInput has it
};

// Measures on a thread of its own, a frame or two behind who adds them.
class SequenceScores {
 public:
  // `frames`: those that will be added, ascending. Errors: kIoFailure where none of them has a true picture,
  // or one is damaged or has another size than `extent`. `keep_pictures`: as ScoredFrames has it.
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
