// SPDX-License-Identifier: MIT
#include "tools/frame_pattern.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace quincunx::tools {

namespace {

constexpr int kDigitsOfHash = 4;
constexpr int kMaxDigits = 18;

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
  while (field.length < text.size() && is_mark(text[field.length])) {
    field.digits += text[field.length] == '#' ? kDigitsOfHash : 1;
    ++field.length;
  }
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

Status bad(const std::string& pattern, const std::string& reason) {
  return Status::invalid(fmt::format("output pattern '{}' {}", pattern, reason));
}

Result<FileFormat> format_of(const std::string& pattern, const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".png") return FileFormat::kPng;
  if (extension == ".exr") return FileFormat::kExr;
  if (extension.empty()) return bad(pattern, "has no extension; it must end in .png or .exr");
  return bad(pattern, fmt::format("ends in '{}'; it must end in .png or .exr", extension));
}

}  // namespace

Result<FramePattern> FramePattern::parse(const std::string& pattern) {
  if (pattern.empty()) return Status::invalid("the output pattern is empty; try 'out/frame.%04d.png'");
  FramePattern result;
  result.pattern_ = pattern;
  std::string literal;  // since the start or the number
  for (std::size_t at = 0; at < pattern.size();) {
    const std::string_view rest = std::string_view(pattern).substr(at);
    Field field;
    if (is_mark(rest[0])) {
      field = field_of_marks(rest);
    } else if (rest.substr(0, 2) == "%%") {
      literal += '%';
      at += 2;
      continue;
    } else if (rest[0] == '%') {
      field = field_of_printf(rest);
      if (field.length == 0) {
        return bad(pattern, "has a '%' that starts no frame number; write %04d, or %% for a percent sign");
      }
    } else {
      literal += rest[0];
      ++at;
      continue;
    }
    if (result.has_number_) return bad(pattern, "has two frame numbers; only one can be filled in");
    if (field.digits > kMaxDigits) {
      return bad(pattern, fmt::format("asks for more than {} digits", kMaxDigits));
    }
    result.has_number_ = true;
    result.digits_ = field.digits;
    result.zero_padded_ = field.zero_padded;
    result.prefix_ = std::exchange(literal, std::string());
    at += field.length;
  }
  result.suffix_ = literal;
  Result<FileFormat> format = format_of(pattern, result.expand(0));
  if (!format.ok()) return format.status();
  result.format_ = format.value();
  return result;
}

std::string FramePattern::expand(std::int64_t frame) const {
  if (!has_number_) return suffix_;
  return zero_padded_ ? fmt::format("{}{:0{}d}{}", prefix_, frame, digits_, suffix_)
                      : fmt::format("{}{:{}d}{}", prefix_, frame, digits_, suffix_);
}

Status FramePattern::check_count(std::int64_t frames) const {
  if (has_number_ || frames <= 1) return {};
  return bad(pattern_, fmt::format("has no frame number, so {} frames would overwrite one another; put %04d "
                                   "into it",
                                   frames));
}

}  // namespace quincunx::tools
