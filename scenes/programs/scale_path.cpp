// SPDX-License-Identifier: MIT
#include "programs/scale_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "random.h"

namespace quincunx::scenes {
namespace {

constexpr float kSmallest = 0.01f;
constexpr float kLargest = 2.0f;

bool usable(float scale) {
  return scale >= kSmallest && scale <= kLargest;
}

float mix(float a, float b, double t) {
  return static_cast<float>(a + (b - a) * t);
}

// "A,B,C" as numbers; empty when any part is not one.
std::vector<float> numbers(std::string_view text) {
  std::vector<float> values;
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    float value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + comma, value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + comma) return {};
    values.push_back(value);
    if (comma == text.size()) return values;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

Result<ScalePath> ScalePath::fixed(Vec2 scale) {
  if (!usable(scale.x) || !usable(scale.y)) {
    return Status::invalid(
        fmt::format("scale is {} x {}; both must lie in [{}, {}]", scale.x, scale.y, kSmallest, kLargest));
  }
  ScalePath path;
  path.a_ = scale.x;
  path.b_ = scale.y;
  return path;
}

Result<ScalePath> ScalePath::parse(const std::string& text, std::uint64_t seed) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  ScalePath path;
  path.seed_ = seed;
  std::vector<float> scales;
  if (name == "sweep") {
    path.kind_ = Kind::kSweep;
    scales = {0.5f, 1.0f, 0.71f};
  } else if (name == "ramp") {
    path.kind_ = Kind::kRamp;
    scales = {0.5f, 1.0f};
  } else if (name == "random") {
    path.kind_ = Kind::kRandom;
    scales = {0.5f, 1.0f};
  } else {
    return Status::invalid(fmt::format(
        "scale path '{}' is not known; there are sweep[:A,B,C], ramp[:A,B] and random[:A,B]", text));
  }
  const std::size_t wanted = scales.size();
  if (colon != std::string::npos) scales = numbers(std::string_view(text).substr(colon + 1));
  if (scales.size() != wanted || !std::all_of(scales.begin(), scales.end(), usable)) {
    return Status::invalid(
        fmt::format("scale path '{}' must be {} followed by nothing or by ':' and {} scales in "
                    "[{}, {}] with commas between them",
                    text, name, wanted, kSmallest, kLargest));
  }
  path.a_ = scales[0];
  path.b_ = scales[1];
  path.c_ = scales.back();
  return path;
}

Vec2 ScalePath::at(std::int64_t index, std::int64_t count) const {
  const double t = count > 1 ? static_cast<double>(index) / static_cast<double>(count - 1) : 0.0;
  switch (kind_) {
    case Kind::kFixed:
      return {a_, b_};
    case Kind::kRamp:
      return {mix(a_, b_, t), mix(a_, b_, t)};
    case Kind::kSweep: {
      const float scale = t < 0.5 ? mix(a_, b_, 2 * t) : mix(b_, c_, 2 * t - 1);
      return {scale, scale};
    }
    case Kind::kRandom: {
      Random random(seed_, static_cast<std::uint64_t>(index));
      const float x = random.range(a_, b_);
      return {x, random.range(a_, b_)};
    }
  }
  return {1, 1};
}

float ScalePath::largest() const {
  return kind_ == Kind::kSweep ? std::max({a_, b_, c_}) : std::max(a_, b_);
}

}  // namespace quincunx::scenes
