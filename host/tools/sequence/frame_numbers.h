// SPDX-License-Identifier: MIT
// Frame numbers as people write them: "1-10x2,20". Pure; thread-safe.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "quincunx/status.h"

namespace quincunx::tools {

// Single frames and ranges (FIRST-LAST, FIRST-LASTxSTEP) with commas between, in any order; the result
// ascends and holds each frame once. Errors: kInvalidArgument for anything else, for a range that runs
// backwards, a step below 1, a negative number, or more than kMostFrames frames.
inline constexpr std::int64_t kMostFrames = 10'000'000;
Result<std::vector<std::int64_t>> parse_frame_numbers(const std::string& text);

// The shortest such text of ascending numbers: {1, 2, 3, 7, 9, 11} is "1-3,7-11x2".
std::string frame_numbers_text(std::span<const std::int64_t> frames);

}  // namespace quincunx::tools
