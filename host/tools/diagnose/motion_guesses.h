// SPDX-License-Identifier: MIT
// Motion guesses: what the channels of motion may mean, and what jitter the frames may have been drawn with. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/foretelling.h"
#include "tools/program/jitter.h"

namespace quincunx::tools {

enum class Unit : std::uint8_t { kStated, kUv, kPixels, kOutputPixels, kNdc, kNothing };

struct MotionGuess {
  Unit unit = Unit::kStated;
  bool swapped = false;
  bool flip_x = false;
  bool flip_y = false;
  int later = 0;  // frames by which the motion that fits was written too early

  friend bool operator==(const MotionGuess&, const MotionGuess&) = default;
};

// Returns the factors from channels to pixels of a frame of this size.
Vec2 factors_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

Motion motion_of(const Pair& pair, const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

// Whether two guesses say the same of frames of this size.
bool same(const DiagnosedInput& input, const MotionGuess& a, const MotionGuess& b, Extent extent);

// The input's word first, for both.
std::vector<MotionGuess> motion_guesses(const DiagnosedInput& input, Extent extent);

std::vector<std::string> faults_of(const MotionGuess& guess);
std::string text_of(const MotionGuess& guess);
std::string option_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent);

struct JitterGuess {
  bool swapped = false;
  bool flip_x = false;
  bool flip_y = false;
  float factor = 1;  // 0: none
  int later = 0;
  std::optional<Jitter> pattern = {};  // in place of what the input says

  friend bool operator==(const JitterGuess&, const JitterGuess&) = default;
};

JitterMend mend_of(const JitterGuess& guess);

// Jitter of frame `i`; nothing where the frame beside it that the guess means is not there.
std::optional<Vec2> jitter_at(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                              const JitterGuess& guess, std::size_t i);

std::vector<JitterGuess> jitter_guesses(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input);

std::vector<std::string> faults_of(const JitterGuess& guess);
std::string text_of(const JitterGuess& guess);

}  // namespace quincunx::tools
