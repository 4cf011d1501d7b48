// SPDX-License-Identifier: MIT
// Sequence noise: how much of a sample's light is chance, told by the frames themselves.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/program/frame_pattern.h"
#include "tools/sequence/sequence_input.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {

// A frame, or a part of it.
struct LitFrame {
  MotionSamples seen;        // depth may be empty
  std::vector<float> light;  // linear
  bool reset = false;        // motion leads to no frame before
};

// Returns the variance of a sample in parts of its square, at most 1; 0 where frames are clean, or do not tell.
// `frames` follow one another. What counts is how far samples of different frames are apart that show, by motion, the
// same place of a surface to within a sixteenth of a pixel: texture and aliasing are the same in both. What the light
// of the whole picture changes is taken off. Frames are noisy where nine tenths of the picture are; then it is what the
// fifth with most noise exceeds. Pure.
float noise_between(std::span<const LitFrame> frames);

// Reads the first 33 frames of the sequence that lie on disk, whatever is asked for, so that chunks agree. 0 where they
// have no motion; nothing where they are fewer, with a gap, broken or of several sizes.
std::optional<float> noise_of(const FramePattern& pattern, const SequenceFormat& format);

}  // namespace quincunx::tools
