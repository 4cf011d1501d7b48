// SPDX-License-Identifier: MIT
// ScalePath: the render scale wanted in each frame of a sequence. Pure: the same path, seed and frame give
// the same scale. A value; thread-safe.
#pragma once

#include <cstdint>
#include <string>

#include "quincunx/extent.h"
#include "quincunx/status.h"

namespace quincunx::scenes {

class ScalePath {
 public:
  // The same scale in every frame, per axis.
  static Result<ScalePath> fixed(Vec2 scale);

  // "sweep": 0.5 -> 1 over the first half, then -> 0.71; "sweep:A,B,C": the same with these scales.
  // "ramp": 0.5 -> 1; "ramp:A,B". "random": uniform in [0.5, 1] on each axis in every frame; "random:A,B".
  // Errors: kInvalidArgument for another name, a scale outside [0.01, 2], or a wrong number of them.
  static Result<ScalePath> parse(const std::string& text, std::uint64_t seed);

  // Scale of frame `index` of `count`, 0 <= index < count.
  Vec2 at(std::int64_t index, std::int64_t count) const;

  float largest() const;  // the largest scale on either axis

 private:
  enum class Kind : std::uint8_t { kFixed, kSweep, kRamp, kRandom };

  Kind kind_ = Kind::kFixed;
  float a_ = 1;
  float b_ = 1;
  float c_ = 1;
  std::uint64_t seed_ = 0;
};

}  // namespace quincunx::scenes
