// SPDX-License-Identifier: MIT
// MotionCheck: checks the signs of velocity. Values; pure.
//
// Each frame is compared with the previous one, at the places that its samples come from by their velocity, and by
// velocity with the sign of x, of y, or of both flipped. A verdict on an axis needs eight frames in which something
// moves along it and one sign is better. quincunx-resolve --diagnose checks units, jitter and the rest on recorded
// frames.
#pragma once

#include <cstdint>
#include <string>

#include "quincunx/advanced/export.h"

namespace quincunx {

enum class MotionVerdict : std::uint8_t {
  kUnknown,  // nothing moves enough, or no sign is clearly better
  kRightX,   // x is right, y unknown
  kRightY,   // y is right, x unknown
  kRight,
  kSignOfX,    // the sign of x is wrong; y is right or unknown
  kSignOfY,    // the sign of y is wrong; x is right or unknown
  kDirection,  // both signs are wrong
};

QUINCUNX_API const char* name_of(MotionVerdict verdict);  // "sign of y"

struct MotionCheck {
  MotionVerdict verdict = MotionVerdict::kUnknown;
  double margin_db = 0;  // advantage of its sign over the opposite; of two axes, the lesser
};

// Returns a verdict as a sentence without its margin, "velocity.y seems to point the other way"; nothing: nullptr.
QUINCUNX_API const char* sentence_of(MotionVerdict verdict);
// Returns the same with it, "velocity.y seems to point the other way: 14.0 dB better"; or "cannot tell".
QUINCUNX_API std::string text_of(const MotionCheck& check);

}  // namespace quincunx
