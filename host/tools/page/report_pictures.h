// SPDX-License-Identifier: MIT
// ReportPictures: some frames of a run beside their truth, small enough for a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/status.h"
#include "tools/image/change_map.h"

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

  Extent crop;  // of the output's pixels from (x, y)
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

}  // namespace quincunx::tools
