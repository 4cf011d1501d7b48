// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

namespace quincunx::tools {
namespace {

std::optional<Vec2> as_pair(const AttributeValue& value) {
  if (const auto* pair = std::get_if<Vec2>(&value)) return *pair;
  Vec2 pair;
  char rest = 0;
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && std::sscanf(text->c_str(), " %f%*1[, ]%f %c", &pair.x, &pair.y, &rest) == 2)
    return pair;
  return std::nullopt;
}

std::optional<double> as_number(const AttributeValue& value) {
  if (const auto* number = std::get_if<int>(&value)) return *number;
  if (const auto* number = std::get_if<float>(&value)) return *number;
  double number = 0;
  char rest = 0;
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && std::sscanf(text->c_str(), "%lf %c", &number, &rest) == 1) return number;
  return std::nullopt;
}

// Reads the attributes of one header and keeps the first thing that is wrong.
class AttributeReader {
 public:
  AttributeReader(const std::string& path, const ImageHeader& header) : path_(path), header_(header) {}

  std::optional<Vec2> pair(const char* name, const char* what) {
    const Attribute* attribute = header_.attribute(name);
    if (attribute == nullptr) return std::nullopt;
    const auto value = as_pair(attribute->value);
    if (!value || !std::isfinite(value->x) || !std::isfinite(value->y)) complain(name, what);
    return value;
  }

  std::optional<double> number(const char* name, const char* what) {
    const Attribute* attribute = header_.attribute(name);
    if (attribute == nullptr) return std::nullopt;
    const auto value = as_number(attribute->value);
    if (!value || !std::isfinite(*value)) complain(name, what);
    return value;
  }

  std::optional<Extent> size(const char* name) {
    const auto value = pair(name, "a width and a height");
    if (!value) return std::nullopt;
    if (!(value->x >= 1 && value->y >= 1 && value->x <= kLargest && value->y <= kLargest)) {
      complain(name, "a width and a height");
      return std::nullopt;
    }
    return Extent{static_cast<int>(value->x), static_cast<int>(value->y)};
  }

  std::optional<DepthKind> depth_kind(const char* name) {
    const Attribute* attribute = header_.attribute(name);
    if (attribute == nullptr) return std::nullopt;
    const auto* text = std::get_if<std::string>(&attribute->value);
    const auto kind = text != nullptr ? depth_kind_named(*text) : std::nullopt;
    if (!kind) complain(name, "linear, device or device-reversed");
    return kind;
  }

  void complain(const char* name, const char* what) {
    if (!status_.ok()) return;
    status_ = Status::io(fmt::format("'{}' has an attribute '{}' that is not {}", path_, name, what));
  }

  const Status& status() const { return status_; }

 private:
  static constexpr float kLargest = 1 << 24;

  const std::string& path_;
  const ImageHeader& header_;
  Status status_;
};

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
    return Status::invalid(fmt::format(
        "--jitter '{}' is neither attribute, none, quincunx, quincunx-half, halton nor a file", path));
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

Result<FrameAttributes> frame_attributes(const std::string& path, const ImageHeader& header) {
  AttributeReader reader(path, header);
  FrameAttributes attributes;
  attributes.jitter = reader.pair("quincunx:jitter", "two numbers");
  if (!attributes.jitter) attributes.jitter = reader.pair("jitter", "two numbers");
  attributes.render = reader.size("quincunx:renderSize");
  attributes.output = reader.size("quincunx:outputSize");
  if (const auto index = reader.number("quincunx:frameIndex", "a number"))
    attributes.index = static_cast<std::int64_t>(*index);
  auto reset = reader.number("quincunx:reset", "0 or 1");
  if (!reset) reset = reader.number("reset", "0 or 1");
  attributes.reset = reset.value_or(0) != 0;
  if (const auto near_plane = reader.number("quincunx:near", "a positive number")) {
    attributes.near_plane = static_cast<float>(*near_plane);
    if (!(*attributes.near_plane > 0)) reader.complain("quincunx:near", "a positive number");
  }
  attributes.depth_kind = reader.depth_kind("quincunx:depthKind");
  const Attribute* matrix = header.attribute("worldToNDC");
  if (matrix != nullptr) {
    if (const auto* values = std::get_if<Matrix>(&matrix->value)) attributes.world_to_ndc = *values;
  }
  if (!reader.status().ok()) return reader.status();
  return attributes;
}

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
    return jitter_of(*pattern, std::max<std::int64_t>(attributes.index.value_or(number), 0), render, output);
  Vec2 jitter;
  if (const auto* table = std::get_if<std::shared_ptr<const Table>>(&source_)) {
    const auto found = (*table)->find(number);
    if (found == (*table)->end()) {
      return bad_file(text_, fmt::format("says nothing of frame {} ('{}')", number, path));
    }
    jitter = found->second;
  } else {
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
