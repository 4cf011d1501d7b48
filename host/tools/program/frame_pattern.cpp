// SPDX-License-Identifier: MIT
#include "tools/program/frame_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace quincunx::tools {
namespace {

constexpr int kDigitsOfSingleHash = 4;
constexpr int kMaxDigits = 18;
constexpr std::int64_t kLargestNumber = 999'999'999'999'999'999;  // of so many digits

bool is_mark(char c) {
  return c == '#' || c == '@';
}

struct Field {
  int digits = 0;
  bool zero_padded = true;
  std::size_t length = 0;  // characters of the pattern that it takes; 0: not a field
};

Field field_of_marks(std::string_view text) {
  Field field;
  while (field.length < text.size() && is_mark(text[field.length]))
    ++field.length;
  const std::string_view marks = text.substr(0, field.length);
  const bool single_hash = std::count(marks.begin(), marks.end(), '#') == 1;
  field.digits = static_cast<int>(marks.size()) + (single_hash ? kDigitsOfSingleHash - 1 : 0);
  return field;
}

// "%04d", "%4d", "%d".
Field field_of_printf(std::string_view text) {
  std::size_t at = 1;
  Field field;
  field.zero_padded = at < text.size() && text[at] == '0';
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
    field.digits = std::min(field.digits * 10 + (text[at] - '0'), kMaxDigits + 1);
    ++at;
  }
  if (at < text.size() && text[at] == 'd') field.length = at + 1;
  return field;
}

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
  if (parsed.ec != std::errc() || number < -kLargestNumber || number > kLargestNumber) return std::nullopt;
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

Status FramePattern::bad(const std::string& reason) const {
  return Status::invalid(fmt::format("{} '{}' {}", what_, pattern_, reason));
}

Result<FramePattern> FramePattern::parse(const std::string& pattern, const std::string& what) {
  if (pattern.empty()) return Status::invalid(fmt::format("the {} is empty; try 'out/frame.%04d.png'", what));
  FramePattern result;
  result.what_ = what;
  result.pattern_ = pattern;
  if (Status status = result.parse_fields(); !status.ok()) return status;
  return result;
}

Status FramePattern::parse_fields() {
  // Folders are literal; `literal` is what stands since the start or the number.
  std::size_t at = pattern_.rfind('/') + 1;  // 0 where there is none
  std::string literal = pattern_.substr(0, at);
  while (at < pattern_.size()) {
    const std::string_view rest = std::string_view(pattern_).substr(at);
    Field field;
    if (is_mark(rest[0])) {
      field = field_of_marks(rest);
    } else if (rest.size() > 1 && rest[0] == '%' && (rest[1] == '%' || is_mark(rest[1]))) {
      literal += rest[1];
      at += 2;
      continue;
    } else if (rest[0] == '%') {
      field = field_of_printf(rest);
      if (field.length == 0) {
        return bad(
            "has a '%' that starts no frame number; write %04d, or %% for a percent sign (%# and %@ "
            "likewise)");
      }
    } else {
      literal += rest[0];
      ++at;
      continue;
    }
    if (has_number_)
      return bad("has two frame numbers; only one can be filled in (%# and %@ stand for # and @ themselves)");
    if (field.digits > kMaxDigits) return bad(fmt::format("asks for more than {} digits", kMaxDigits));
    has_number_ = true;
    digits_ = field.digits;
    zero_padded_ = field.zero_padded;
    prefix_ = std::exchange(literal, std::string());
    at += field.length;
  }
  suffix_ = literal;
  return {};
}

std::string FramePattern::expand(std::int64_t frame) const {
  if (!has_number_) return suffix_;
  return zero_padded_ ? fmt::format("{}{:0{}d}{}", prefix_, frame, digits_, suffix_)
                      : fmt::format("{}{:{}d}{}", prefix_, frame, digits_, suffix_);
}

std::optional<std::int64_t> FramePattern::number_in(std::string_view path) const {
  if (!has_number_ || path.size() <= prefix_.size() + suffix_.size()) return std::nullopt;
  if (path.substr(0, prefix_.size()) != prefix_ || path.substr(path.size() - suffix_.size()) != suffix_) {
    return std::nullopt;
  }
  std::string_view digits = path.substr(prefix_.size(), path.size() - prefix_.size() - suffix_.size());
  digits.remove_prefix(std::min(digits.find_first_not_of(' '), digits.size()));
  std::int64_t number = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (parsed.ec != std::errc() || expand(number) != path) return std::nullopt;
  return number;
}

Result<std::vector<std::int64_t>> FramePattern::frames_on_disk() const {
  const std::string folder = pattern_.substr(0, pattern_.rfind('/') + 1);
  if (!has_number_) {
    return bad("has no frame number in the file's name; put %04d, # or @ there");
  }
  std::vector<std::int64_t> frames;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string path = folder + entry->path().filename().string();
    if (const auto number = number_in(path)) {
      frames.push_back(*number);
    } else if (path.starts_with(prefix_ + '-')) {  // and a digit too many, as some programs write it
      const auto positive = number_in(prefix_ + path.substr(prefix_.size() + 1));
      if (positive && *positive > 0)
        return bad(fmt::format("leaves out '{}': it has frame {} as '{}'; rename it", path, -*positive,
                               expand(-*positive)));
    }
  }
  std::sort(frames.begin(), frames.end());
  for (const std::int64_t number : frames) {
    if (number < -kLargestNumber || number > kLargestNumber)
      return bad(fmt::format("fits '{}', whose number has more than {} digits", expand(number), kMaxDigits));
  }
  return frames;
}

Status FramePattern::check_count(std::int64_t frames) const {
  if (has_number_ || frames <= 1) return {};
  return bad(
      fmt::format("has no frame number, so {} frames would overwrite one another; put %04d into it", frames));
}

Result<std::vector<std::int64_t>> parse_frame_numbers(const std::string& text) {
  std::vector<std::int64_t> frames;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, comma - at);
    const auto range = parse_range(part);
    if (!range) {
      return Status::invalid(
          fmt::format("'{}' is no frame or range of frames; write for example 7, -3--1, 1-10 or 1-10x2, with "
                      "commas between",
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
