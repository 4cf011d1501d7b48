// SPDX-License-Identifier: MIT
// sequence_dump: a whole run as a sequence in the exchange format (docs/inputs.md), with truth on request.
#pragma once

#include <string>

#include "programs/picture_options.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

struct SequenceDump {
  std::string pattern;            // of the frames: "seq/courtyard.%04d.exr"
  bool linear_depth = true;       // else Z is the reversed device depth as it was drawn: nothing is rounded
  bool dilates_velocity = false;  // dilate_velocity()
  int truth = 0;                  // N: N x N samples a pixel into truth.%04d.exr beside the frames; 0: none
};

// Draws every frame of the options and writes it with all its targets, and sequence.json with what is
// constant. Errors: of any part, as it words them.
Status dump_sequence(const PictureOptions& options, const SequenceDump& dump);

}  // namespace quincunx::scenes
