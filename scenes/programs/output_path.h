// SPDX-License-Identifier: MIT
// OutputPath: the output's resolution in each frame of a sequence, where it is dynamic, too ("dual"). Pure but for what
// it remembers of earlier frames; one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "quincunx/output_follower.h"

namespace quincunx::scenes {

class OutputPath {
 public:
  // "auto": as OutputFollower has it; "random": each axis at random from half of the display's on, another one in every
  // frame; a number in [0.1, 1]: that scale of the display in every frame. Errors: kInvalidArgument, naming --dual.
  static Result<OutputPath> parse(const std::string& text, Extent display, std::uint64_t seed);

  // Of the next frame, which is drawn at `render`.
  Extent next(Extent render);

  Extent least() const;  // the smallest there may be

 private:
  OutputPath(Extent display, std::uint64_t seed) : display_(display), random_(seed) {}

  Extent display_;
  std::optional<Extent> fixed_;
  std::optional<OutputFollower> follower_;
  std::mt19937_64 random_;
};

}  // namespace quincunx::scenes
