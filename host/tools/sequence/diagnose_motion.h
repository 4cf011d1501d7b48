// SPDX-License-Identifier: MIT
// The part of diagnose() that looks at motion and jitter together, because each hides the other's mistakes. Pure.
#pragma once

#include <span>
#include <vector>

#include "tools/sequence/diagnose.h"
#include "tools/sequence/foretelling.h"

namespace quincunx::tools {

struct MotionAnswer {
  std::vector<Finding> findings = {};
  bool knows_motion = false;
  std::vector<Motion> motion = {};  // of each pair, as it fits best
  std::vector<Vec2> shift = {};     // the same, of the jitter
  std::vector<Vec2> jitter = {};    // of each frame
  JitterMend mend = {};
};

MotionAnswer find_motion(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input,
                         const std::vector<Plane>& planes, const std::vector<Pair>& pairs);

}  // namespace quincunx::tools
