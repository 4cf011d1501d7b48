// SPDX-License-Identifier: MIT
#include "tools/sequence/frame_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace quincunx::tools {
namespace {

struct Range {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
};

// Takes a number and, before it, the `mark` (if any) off the front of `text`.
std::optional<std::int64_t> take_number(std::string_view& text, char mark = 0) {
  std::string_view rest = text;
  if (mark != 0) {
    if (rest.empty() || rest.front() != mark) return std::nullopt;
    rest.remove_prefix(1);
  }
  std::int64_t number = 0;
  const auto parsed = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (parsed.ec != std::errc() || number < 0) return std::nullopt;
  text = rest.substr(static_cast<std::size_t>(parsed.ptr - rest.data()));
  return number;
}

std::optional<Range> parse_range(std::string_view text) {
  const auto first = take_number(text);
  if (!first) return std::nullopt;
  Range range = {*first, *first, 1};
  if (const auto last = take_number(text, '-')) {
    range.last = *last;
    if (const auto step = take_number(text, 'x')) range.step = *step;
  }
  if (!text.empty() || range.last < range.first || range.step < 1) return std::nullopt;
  return range;
}

}  // namespace

Result<std::vector<std::int64_t>> parse_frame_numbers(const std::string& text) {
  std::vector<std::int64_t> frames;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, comma - at);
    const auto range = parse_range(part);
    if (!range) {
      return Status::invalid(fmt::format(
          "'{}' is no frame or range of frames; write for example 7, 1-10 or 1-10x2, with commas between",
          part));
    }
    const std::int64_t steps = (range->last - range->first) / range->step;
    if (steps >= kMostFrames - static_cast<std::int64_t>(frames.size())) {
      return Status::invalid(fmt::format("'{}' is more than {} frames", text, kMostFrames));
    }
    for (std::int64_t i = 0; i <= steps; ++i)
      frames.push_back(range->first + i * range->step);
    at = comma + 1;
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string frame_numbers_text(std::span<const std::int64_t> frames) {
  std::string text;
  for (std::size_t at = 0; at < frames.size();) {
    std::size_t end = at + 1;  // one past the run of equal steps that starts here
    const std::int64_t step = end < frames.size() ? frames[end] - frames[at] : 1;
    while (end < frames.size() && frames[end] - frames[end - 1] == step)
      ++end;
    // Two frames that are not neighbours read better apart.
    if (step != 1 && end - at < 3) end = at + 1;
    if (!text.empty()) text += ',';
    text += fmt::format("{}", frames[at]);
    if (end - at > 1) text += fmt::format("-{}", frames[end - 1]);
    if (end - at > 1 && step != 1) text += fmt::format("x{}", step);
    at = end;
  }
  return text;
}

}  // namespace quincunx::tools
