// SPDX-License-Identifier: MIT
// ScoredFrames: frames of a run measured against their truth, one after another: rows of a report, and some pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/image/image_metrics.h"
#include "tools/page/report_pictures.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {

// One thread at a time.
class ScoredFrames {
 public:
  static constexpr std::size_t kMostPictures = 6;

  // `frames`: those that will be added, ascending. Pictures are kept of up to kMostPictures of them, at even
  // distances, the last one included; of none without `keep_pictures`.
  ScoredFrames(std::span<const std::int64_t> frames, bool keep_pictures);

  // Whether a picture of this output can be measured. Errors: kInvalidArgument, by the name of `option`.
  static Status check(Extent output, const std::string& option);

  // Whether its pictures are kept. For others add() needs no motion. Constant, so any thread may ask.
  bool keeps(std::int64_t frame) const;

  // In ascending order, pictures of one extent. A frame's flicker and ghosts are known where the last one added was
  // the frame before it. Errors: of add_frame().
  Status add(std::int64_t frame, MeasuredPicture picture, MeasuredPicture truth, const MotionField& motion);

  // The frame added last was shown for one more refresh, whose truth this is; nothing where there is none.
  void repeat(const MeasuredPicture& truth);

  const std::vector<ScoreRow>& rows() const { return rows_; }
  const ReportPictures& pictures() const { return pictures_; }

 private:
  struct Measured {
    std::int64_t frame = 0;
    MeasuredPicture picture;
    MeasuredPicture truth;
  };

  std::vector<std::int64_t> kept_;
  std::optional<Measured> before_;
  ReportPictures pictures_;
  std::vector<ScoreRow> rows_;
};

}  // namespace quincunx::tools
