// SPDX-License-Identifier: MIT
// ScoredFrames: frames of a run measured against their truth, one after another: rows of a report, and some frames
// beside their truth, small enough for a page.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quincunx/status.h"
#include "tools/image/image_metrics.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {

struct ReportPictures {
  struct Kind {
    std::string name;     // "picture"
    bool is_map = false;  // grey, to be drawn as colours: 255 is a FLIP of 1, or a change of 1/4
  };
  struct Frame {
    std::int64_t index = 0;
    std::vector<std::vector<std::uint8_t>> pngs;  // one of each kind
  };

  Extent crop;  // size in output pixels, from (x, y)
  int x = 0;
  int y = 0;
  std::vector<Kind> kinds;
  std::vector<Frame> frames;
};

// A frame that is measured, and the one before it where there is one.
struct JudgedFrame {
  const MeasuredPicture& picture;
  const MeasuredPicture& truth;
  const MeasuredPicture* previous = nullptr;
  const MeasuredPicture* previous_truth = nullptr;
  MotionField motion = {};  // empty: not known
};

// Adds truth, picture, error (FLIP), flicker and, where the first frame's motion is known, ghosts; maps that need a
// frame before are black without. The crop is the whole picture or, of larger ones, 640x360 pixels about the place
// where the first frame errs most. Errors: of encode_png().
Status add_frame(ReportPictures& pictures, std::int64_t index, const JudgedFrame& frame);

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
