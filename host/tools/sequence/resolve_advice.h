// SPDX-License-Identifier: MIT
// Resolve advice: which method suits a sequence, from what its frames offer, and what a careful user would want to know
// before the first frame. Thread-safe.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/program/frame_pattern.h"
#include "tools/sequence/resolve_task.h"
#include "tools/sequence/sequence_input.h"

namespace quincunx::tools {

// Kind of jitter of consecutive frames. Places are apart that differ by more than 1/100 pixel.
enum class JitterKind : std::uint8_t {
  kNone,  // all at one place, one frame alone at the pixels' centres
  kFew,   // two or three places in turn
  kMany,  // as temporal wants it
};
JitterKind kind_of(std::span<const Vec2> jitters);

// Whether the samples of most frames lie half a pixel, up to 0.15, from those of the frame before in x and in y, as the
// two-frame method wants it. False for fewer than two frames.
bool alternates(std::span<const Vec2> jitters);

// Reads those of the frames about `number`, half a dozen before and after it, ascending; leaves out those that cannot
// be read. So chunks of one sequence come to the same kind.
std::vector<Vec2> jitters_about(const FramePattern& pattern, const SequenceFormat& format,
                                std::int64_t number);

struct MethodDefault {
  MethodVariant method;
  std::string why;  // "motion, depth and a jitter are known"
};

// Returns the method that is taken where nobody names one. A camera's motion, `far` and `drawn_velocity` need depth:
// where it is missing, that is for the plan to refuse, not to be passed over.
MethodDefault default_method(const SequenceFormat& format, JitterKind jitter,
                             const ResolveSettings& settings);

// Returns sentences, each once for the whole run: no motion, a jitter that does not suit the method, a compression that
// loses motion, an output of another shape than the frames or smaller. Sizes that the frames ask for themselves
// (quincunx:outputSize) are as they should be. Nothing of frames that cannot be used.
std::vector<std::string> advice_on(const ResolveTask& task);

}  // namespace quincunx::tools
