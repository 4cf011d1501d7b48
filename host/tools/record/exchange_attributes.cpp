// SPDX-License-Identifier: MIT
#include "tools/record/exchange_attributes.h"

#include <fmt/format.h>
#include <strings.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace quincunx::tools {
namespace {

// The table: every attribute's name, where it is kept, and what it must be. `visit` takes these three.
template <typename Attributes, typename Visit>
void each(Attributes& a, Visit&& visit) {
  constexpr const char* kPair = "two numbers";
  constexpr const char* kNumber = "a number";
  constexpr const char* kSize = "a width and a height from 1 to 32768";
  constexpr const char* kMatrix = "a matrix";
  visit("quincunx:jitter", a.jitter, kPair);
  visit("quincunx:renderSize", a.render, kSize);
  visit("quincunx:outputSize", a.output, kSize);
  visit("quincunx:frameIndex", a.index, kNumber);
  visit("quincunx:reset", a.reset, "0 or 1");
  visit("quincunx:near", a.near_plane, "a positive number");
  visit("quincunx:depthKind", a.depth_kind, "linear, device or device-reversed");
  visit("worldToNDC", a.world_to_ndc, kMatrix);
  visit("quincunx:far", a.far_plane, kNumber);
  visit("quincunx:velocityScale", a.velocity_scale, kPair);
  visit("quincunx:pictureSize", a.picture, kSize);
  visit("quincunx:clipToPreviousClip", a.camera, kMatrix);
  visit("quincunx:exposure", a.exposure, kNumber);
  visit("quincunx:exposureImage", a.exposure_image, kNumber);
  visit("quincunx:parity", a.parity, kNumber);
  visit("quincunx:fadeWeight", a.fade_weight, kNumber);
  visit("quincunx:place", a.place, kPair);
  visit("quincunx:rectangles", a.rectangles, "text");
  visit("quincunx:feather", a.feather, kNumber);
}

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

// Each returns whether the value can be meant.
bool read(const AttributeValue& value, Vec2& pair) {
  const auto found = as_pair(value);
  pair = found.value_or(Vec2{});
  return found && std::isfinite(pair.x) && std::isfinite(pair.y);
}

bool read(const AttributeValue& value, Extent& size) {
  constexpr auto kLargest = static_cast<float>(kLargestSide);
  Vec2 pair;
  if (!read(value, pair) || !(pair.x >= 1 && pair.y >= 1 && pair.x <= kLargest && pair.y <= kLargest))
    return false;
  size = {static_cast<int>(pair.x), static_cast<int>(pair.y)};
  return true;
}

template <typename Number>
bool read(const AttributeValue& value, Number& number) {
  const auto found = as_number(value);
  if (!found || !std::isfinite(*found)) return false;
  number = static_cast<Number>(*found);
  return true;
}

// As text, because whole numbers may be too long for a file's own.
bool read(const AttributeValue& value, std::int64_t& number) {
  const auto* text = std::get_if<std::string>(&value);
  long long exact = 0;
  char rest = 0;
  if (text != nullptr && std::sscanf(text->c_str(), "%lld %c", &exact, &rest) == 1) {
    number = exact;
    return true;
  }
  const auto found = as_number(value);
  if (!found || !(std::abs(*found) < 0x1p62)) return false;
  number = static_cast<std::int64_t>(*found);
  return true;
}

bool read(const AttributeValue& value, bool& flag) {
  const auto* text = std::get_if<std::string>(&value);
  const auto is = [&](const char* word) { return text != nullptr && ::strcasecmp(text->c_str(), word) == 0; };
  const auto found = is("true") ? 1.0 : is("false") ? 0.0 : as_number(value);
  flag = found.value_or(0) != 0;
  return found && std::isfinite(*found);
}

bool read(const AttributeValue& value, DepthKind& kind) {
  const auto* text = std::get_if<std::string>(&value);
  const auto found = text != nullptr ? depth_kind_named(*text) : std::nullopt;
  if (found) kind = *found;
  return found.has_value();
}

bool read(const AttributeValue& value, std::string& text) {
  const auto* found = std::get_if<std::string>(&value);
  if (found != nullptr) text = *found;
  return found != nullptr;
}

// One of another type is not there: other programs have their own.
bool read(const AttributeValue& value, Matrix& matrix) {
  const auto* found = std::get_if<Matrix>(&value);
  if (found != nullptr) matrix = *found;
  return found != nullptr;
}

AttributeValue attribute_of(const Vec2& pair) {
  return pair;
}
AttributeValue attribute_of(const Extent& size) {
  return Vec2{static_cast<float>(size.width), static_cast<float>(size.height)};
}
AttributeValue attribute_of(float number) {
  return number;
}
AttributeValue attribute_of(int number) {
  return number;
}
AttributeValue attribute_of(bool flag) {
  return flag ? 1 : 0;
}
AttributeValue attribute_of(DepthKind kind) {
  return std::string(name_of(kind));
}
AttributeValue attribute_of(const std::string& text) {
  return text;
}
AttributeValue attribute_of(const Matrix& matrix) {
  return matrix;
}
AttributeValue attribute_of(std::int64_t number) {
  const bool fits = number >= std::numeric_limits<int>::min() && number <= std::numeric_limits<int>::max();
  if (fits) return static_cast<int>(number);
  return fmt::format("{}", number);
}

}  // namespace

Result<FrameAttributes> frame_attributes(const std::string& path, const ImageHeader& header, int part) {
  FrameAttributes attributes;
  Status first;
  const auto take = [&]<typename Value>(const char* name, std::optional<Value>& target, const char* what) {
    const Attribute* attribute = header.attribute(name, part);
    if (attribute == nullptr) return;
    Value value = {};
    if (read(attribute->value, value)) {
      target = value;
    } else if (first.ok() && !std::is_same_v<Value, Matrix>) {
      first = Status::io(fmt::format("'{}' has an attribute '{}' that is not {}", path, name, what));
    }
  };
  each(attributes, take);
  const auto take_short = [&]<typename Value>(const char* name, std::optional<Value>& target, auto may_be) {
    const Attribute* attribute = header.attribute(name, part);
    Value value = {};
    if (target || attribute == nullptr) return;
    if (read(attribute->value, value) && may_be(value)) {
      target = value;
    } else {
      attributes.foreign.emplace_back(name);
    }
  };
  take_short("jitter", attributes.jitter, [](Vec2 j) { return std::abs(j.x) <= 1 && std::abs(j.y) <= 1; });
  take_short("reset", attributes.reset, [&](bool flag) {
    return as_number(header.attribute("reset", part)->value).value_or(flag) == flag;
  });
  if (attributes.near_plane && !(*attributes.near_plane > 0) && first.ok())
    first =
        Status::io(fmt::format("'{}' has an attribute 'quincunx:near' that is not a positive number", path));
  constexpr float kMostExposure = FrameInputs::kLargestExposure;
  if (attributes.exposure && !(*attributes.exposure >= 0 && *attributes.exposure <= kMostExposure) &&
      first.ok())
    first = Status::io(
        fmt::format("'{}' has an attribute 'quincunx:exposure' that is not a number from 0 to {:.0f}", path,
                    kMostExposure));
  if (!first.ok()) return first;
  return attributes;
}

std::vector<Attribute> to_attributes(const FrameAttributes& attributes) {
  std::vector<Attribute> all = {{"quincunx:version", 1}};
  each(attributes, [&]<typename Value>(const char* name, const std::optional<Value>& value, const char*) {
    if (value) all.push_back({name, attribute_of(*value)});
  });
  return all;
}

}  // namespace quincunx::tools
