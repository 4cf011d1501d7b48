// SPDX-License-Identifier: MIT
// SequenceWatch: what is wrong with a sequence and shows in no header, only in the pixels of its frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {

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
    std::vector<float> means;  // of 16x16 pixels each, tone-mapped, in [0, 1]
  };

  std::string see_motion(const SequenceFrame& frame, bool reset);
  std::string see_sky(const SequenceFrame& frame, bool reset);
  Cells cells_of(const SequenceFrame& frame) const;

  ResolvePlan plan_;
  float near_plane_ = 0;
  bool motion_is_known_ = false;  // some motion was not 0, or the sentence was said
  bool sky_is_known_ = false;     // the sentence was said
  std::optional<Cells> first_;    // of the frames that are compared
  std::optional<Matrix> last_world_to_ndc_;
};

}  // namespace quincunx::tools
