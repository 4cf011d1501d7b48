// SPDX-License-Identifier: MIT
#include "programs/output_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr double kLeastScale = 0.1;
constexpr double kLeastRandomScale = 0.5;

Extent scaled(Extent display, double scale) {
  const auto side = [scale](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * scale)));
  };
  return {side(display.width), side(display.height)};
}

}  // namespace

Result<OutputPath> OutputPath::parse(const std::string& text, Extent display, std::uint64_t seed) {
  OutputPath path(display, seed);
  if (text == "random") return path;
  if (text == "auto") {
    auto follower = OutputFollower::create({.display = display});
    if (!follower.ok()) return follower.status();
    path.follower_ = follower.value();
    return path;
  }
  double scale = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, scale);
  if (read.ec != std::errc() || read.ptr != end || !(scale >= kLeastScale && scale <= 1)) {
    return Status::invalid(
        fmt::format("--dual '{}' is no resolution of the output; write auto, random, or a scale from {} to 1",
                    text, kLeastScale));
  }
  path.fixed_ = scaled(display, scale);
  return path;
}

Extent OutputPath::next(Extent render) {
  if (fixed_) return *fixed_;
  if (follower_) return follower_->observe(render);
  const auto side = [this](int least, int most) {
    return least + static_cast<int>(random_() % static_cast<std::uint64_t>(most - least + 1));
  };
  const int width = side(least().width, display_.width);
  return {width, side(least().height, display_.height)};
}

Extent OutputPath::least() const {
  if (fixed_) return *fixed_;
  return follower_ ? follower_->least() : scaled(display_, kLeastRandomScale);
}

}  // namespace quincunx::scenes
