// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_attributes.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

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

}  // namespace quincunx::tools
