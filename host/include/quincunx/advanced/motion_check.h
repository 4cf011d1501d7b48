// SPDX-License-Identifier: MIT
// MotionCheck: whether velocity points where samples come from, or would with another sign. Values; pure.
//
// Each frame is compared with the one before where velocity says that its samples come from, and where it would say so
// with another sign of x, of y, and of both. A verdict on an axis is what eight frames say in which something moves
// along it and in each of which one sign is better. Units, jitter and the rest: quincunx-resolve --diagnose, on
// recorded frames.
#pragma once

#include <cstdint>
#include <string>

#include "quincunx/advanced/export.h"

namespace quincunx {

enum class MotionVerdict : std::uint8_t {
  kUnknown,  // nothing moves enough, or no sign is clearly better
  kRightX,   // of y nothing is known
  kRightY,   // of x nothing is known
  kRight,
  kSignOfX,    // that of x alone is wrong, or nothing is known of y
  kSignOfY,    // the same of y
  kDirection,  // both signs are wrong
};

QUINCUNX_API const char* name_of(MotionVerdict verdict);  // "sign of y"

struct MotionCheck {
  MotionVerdict verdict = MotionVerdict::kUnknown;
  double margin_db = 0;  // by how much its sign foretells better than the opposite; of two, the lesser
};

// Returns a verdict as a sentence without its margin, "velocity.y seems to point the other way"; nothing: nullptr.
QUINCUNX_API const char* sentence_of(MotionVerdict verdict);
// Returns the same with it, "velocity.y seems to point the other way: 14.0 dB better"; or "cannot tell".
QUINCUNX_API std::string text_of(const MotionCheck& check);

}  // namespace quincunx
