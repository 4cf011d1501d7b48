// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_jitter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

using Table = std::map<std::int64_t, Vec2>;

Status bad_file(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("jitter file '{}' {}", path, reason));
}

Result<Table> parse_json(const std::string& path, const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto list = json.is_object() ? json.find("per_frame") : json.end();
  if (list == json.end() || !list->is_array()) {
    return bad_file(path, "is no JSON with per_frame: [{\"frame\": 1, \"jitter\": [0.25, 0.25]}, ...]");
  }
  Table table;
  for (const auto& item : *list) {
    const auto frame = item.is_object() ? item.find("frame") : item.end();
    const auto pair = item.is_object() ? item.find("jitter") : item.end();
    const bool good = item.is_object() && frame != item.end() && frame->is_number_integer() &&
                      pair != item.end() && pair->is_array() && pair->size() == 2 && (*pair)[0].is_number() &&
                      (*pair)[1].is_number();
    if (!good)
      return bad_file(path,
                      fmt::format("has an entry of per_frame without frame and jitter: {}", item.dump()));
    table[frame->get<std::int64_t>()] = {(*pair)[0].get<float>(), (*pair)[1].get<float>()};
  }
  return table;
}

Result<Table> parse_lines(const std::string& path, const std::string& text) {
  Table table;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    long long frame = 0;
    Vec2 jitter;
    char rest = 0;
    if (std::sscanf(line.c_str(), "%lld%*1[, \t]%f%*1[, \t]%f %c", &frame, &jitter.x, &jitter.y, &rest) != 3)
      return bad_file(path, fmt::format("line {} is not FRAME X Y: '{}'", number, line));
    table[frame] = jitter;
  }
  return table;
}

Result<Table> read_table(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Status::invalid(
        fmt::format("--jitter '{}' is neither attribute, none, quincunx, quincunx-half, halton nor a file{}",
                    path, did_you_mean(path, {"attribute", "none", "quincunx", "quincunx-half", "halton"})));
  }
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && text[first] == '{';
  auto table = json ? parse_json(path, text) : parse_lines(path, text);
  if (table.ok() && table->empty()) return bad_file(path, "names no frame");
  return table;
}

}  // namespace

Result<JitterSource> JitterSource::parse(const std::string& text) {
  JitterSource source;
  source.text_ = text;
  if (text.empty()) return source;
  if (text == "attribute") {
    source.source_ = FromAttribute{};
    return source;
  }
  for (const Jitter jitter : {Jitter::kNone, Jitter::kQuincunx, Jitter::kQuincunxHalf, Jitter::kHalton}) {
    if (text != name_of(jitter)) continue;
    source.source_ = jitter;
    return source;
  }
  auto table = read_table(text);
  if (!table.ok()) return table.status();
  source.source_ = std::make_shared<const Table>(std::move(table).value());
  return source;
}

void JitterSource::settle(const FrameAttributes& first) {
  if (!std::holds_alternative<Automatic>(source_)) return;
  text_ = first.jitter ? "attribute" : "none";
  if (first.jitter) {
    source_ = FromAttribute{};
  } else {
    source_ = Jitter::kNone;
  }
}

Result<Vec2> JitterSource::at(const std::string& path, std::int64_t number, const FrameAttributes& attributes,
                              Extent render, Extent output) const {
  if (const auto* pattern = std::get_if<Jitter>(&source_))
    return jitter_of(*pattern, attributes.index.value_or(number), render, output);
  Vec2 jitter;
  if (const auto* table = std::get_if<std::shared_ptr<const Table>>(&source_)) {
    const auto found = (*table)->find(number);
    if (found == (*table)->end()) {
      return bad_file(text_, fmt::format("says nothing of frame {} ('{}')", number, path));
    }
    jitter = found->second;
  } else {
    const auto& foreign = attributes.foreign;
    if (std::find(foreign.begin(), foreign.end(), "jitter") != foreign.end()) {
      return Status::io(fmt::format(
          "'{}' has an attribute 'jitter' that is not two numbers from -1 to 1; say --jitter", path));
    }
    if (!attributes.jitter) {
      return Status::io(
          fmt::format("'{}' has no attribute 'quincunx:jitter' or 'jitter'; say --jitter", path));
    }
    jitter = *attributes.jitter;
  }
  if (!(std::abs(jitter.x) <= 1 && std::abs(jitter.y) <= 1)) {
    return Status::io(fmt::format("'{}' has a jitter of {}, {}; each must lie within [-1, 1] pixel", path,
                                  jitter.x, jitter.y));
  }
  return jitter;
}

}  // namespace quincunx::tools
