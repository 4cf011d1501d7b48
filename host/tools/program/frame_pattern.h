// SPDX-License-Identifier: MIT
// FramePattern: "out/frame.%04d.png" and its relatives: a path for each frame number, and back; and frame numbers as
// people write them, "1-10x2,20".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quincunx/status.h"

namespace quincunx::tools {

// A path with at most one number in it: a single '#' stands for four digits as OpenImageIO has it, each of
// several for one as Nuke and Blender have it ("####" is four digits, too); '@' stands for one, and runs add
// up ("#@" is five digits, "@@@" three). printf's "%d", "%4d" and "%04d" work too. "%%", "%#" and "%@" stand for
// a percent sign, # and @ themselves. All this holds in the file's name; folders are taken as they are. Numbers
// wider than the field are written whole. A value; thread-safe.
class FramePattern {
 public:
  // `what` names the pattern in messages: "input pattern". Errors: kInvalidArgument for an empty path, two numbers, or
  // a conversion other than %d.
  static Result<FramePattern> parse(const std::string& pattern, const std::string& what = "output pattern");

  bool has_number() const { return has_number_; }
  const std::string& text() const { return pattern_; }

  std::string expand(std::int64_t frame) const;  // the pattern itself where it has no number

  // The number that expand() makes this path of; nothing for any other path.
  std::optional<std::int64_t> number_in(std::string_view path) const;

  // Returns the frames of which there are files, in ascending order; none where the folder cannot be read. Errors:
  // kInvalidArgument where the pattern has no number, or a file's has more than 18 digits.
  Result<std::vector<std::int64_t>> frames_on_disk() const;

  // Errors: kInvalidArgument when there is no number but more than one frame: they would overwrite one
  // another.
  Status check_count(std::int64_t frames) const;

 private:
  FramePattern() = default;

  Status bad(const std::string& reason) const;
  Status parse_fields();

  std::string what_;
  std::string pattern_;
  std::string prefix_;
  std::string suffix_;
  int digits_ = 0;
  bool zero_padded_ = true;
  bool has_number_ = false;
};

// Reads single frames and ranges (FIRST-LAST, FIRST-LASTxSTEP; -3--1 is -3 to -1) with commas between, in any order;
// the result ascends and holds each frame once. Errors: kInvalidArgument for anything else, for a range that runs
// backwards, a step below 1, a number of more than 18 digits, or more than kMostFrames frames.
inline constexpr std::int64_t kMostFrames = 10'000'000;
Result<std::vector<std::int64_t>> parse_frame_numbers(const std::string& text);

// The shortest such text of ascending numbers: {1, 2, 3, 7, 9, 11} is "1-3,7-11x2".
std::string frame_numbers_text(std::span<const std::int64_t> frames);

}  // namespace quincunx::tools
