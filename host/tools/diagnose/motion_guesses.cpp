// SPDX-License-Identifier: MIT
// What the channels of motion may mean, and what jitter the frames may have been drawn with.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "quincunx/advanced/motion_check.h"
#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

// Factors from channels to uv by the input's word.
Vec2 stated_factors(const VelocityUnits& units, Extent extent) {
  Vec2 one[] = {{1, 1}};
  to_velocity(units, extent, one);
  return one[0];
}

const char* name_of(Unit unit) {
  constexpr const char* kNames[] = {"",
                                    "parts of the picture",
                                    "pixels",
                                    "pixels of the output",
                                    "normalised device coordinates",
                                    "nothing that is known: none at all foretells better"};
  return kNames[static_cast<std::size_t>(unit)];
}

bool near(float a, float b, float part) {
  return std::abs(a - b) <= part * std::abs(a);
}

// Calls `add` with each way in which axes may be turned round.
template <typename Add>
void each_turn(const Add& add) {
  for (const bool swapped : {false, true}) {
    for (const auto& [x, y] : {std::pair(false, false), {true, false}, {false, true}, {true, true}})
      add(swapped, x, y);
  }
}

// Adds what motion and jitter can have in common; `both`: the name of both signs being wrong.
template <typename Guess>
void add_common_faults(std::vector<std::string>& faults, const Guess& guess, const char* both) {
  if (guess.swapped) faults.emplace_back("axes");
  if (guess.flip_x && guess.flip_y) faults.emplace_back(both);
  if (guess.flip_x && !guess.flip_y) faults.emplace_back(quincunx::name_of(MotionVerdict::kSignOfX));
  if (guess.flip_y && !guess.flip_x) faults.emplace_back(quincunx::name_of(MotionVerdict::kSignOfY));
  if (guess.later != 0) faults.emplace_back("frame");
}

// Says the same in words; `both`: of both signs, `whose`: before the frame.
template <typename Guess>
void add_common_parts(std::vector<std::string>& parts, const Guess& guess, const char* both,
                      const char* whose) {
  if (guess.swapped) parts.emplace_back("axes swapped");
  if (guess.flip_x && guess.flip_y) parts.emplace_back(both);
  if (guess.flip_x != guess.flip_y)
    parts.push_back(fmt::format("{} the other way", guess.flip_x ? "x" : "y"));
  if (guess.later != 0)
    parts.push_back(fmt::format("{}of the {} frame", whose, guess.later > 0 ? "next" : "last"));
}

}  // namespace

Vec2 factors_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  const Vec2 stated = stated_factors(input.units, extent);
  Vec2 sizes = {std::abs(stated.x) * width, std::abs(stated.y) * height};
  if (guess.unit == Unit::kUv) sizes = {width, height};
  if (guess.unit == Unit::kPixels) sizes = {1, 1};
  if (guess.unit == Unit::kOutputPixels) {
    sizes = {width / static_cast<float>(input.output.width),
             height / static_cast<float>(input.output.height)};
  }
  if (guess.unit == Unit::kNdc) sizes = {width / 2, height / 2};
  if (guess.unit == Unit::kNothing) sizes = {};
  return {std::copysign(sizes.x, stated.x) * (guess.flip_x ? -1.0f : 1.0f),
          std::copysign(sizes.y, stated.y) * (guess.flip_y ? -1.0f : 1.0f)};
}

Motion motion_of(const Pair& pair, const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  const Vec2 factors = factors_of(input, guess, extent);
  Motion motion;
  motion.reserve(pair.places.size());
  for (const Place& place : pair.places) {
    const Vec2 own = place.velocity[1];
    Vec2 v = place.velocity[static_cast<std::size_t>(1 + guess.later)];
    // Another surface has come here, which says nothing of when motion was written.
    if (square(difference(v, own)) > .25f * square(own)) v = own;
    if (guess.swapped) std::swap(v.x, v.y);
    motion.push_back(product(v, factors));
  }
  return motion;
}

bool same(const DiagnosedInput& input, const MotionGuess& a, const MotionGuess& b, Extent extent) {
  const Vec2 x = factors_of(input, a, extent), y = factors_of(input, b, extent);
  return a.swapped == b.swapped && a.later == b.later && near(x.x, y.x, .01f) && near(x.y, y.y, .01f);
}

std::vector<MotionGuess> motion_guesses(const DiagnosedInput& input, Extent extent) {
  std::vector<MotionGuess> guesses;
  const auto add = [&](const MotionGuess& guess) {
    const bool known = std::any_of(guesses.begin(), guesses.end(), [&](const MotionGuess& other) {
      return same(input, guess, other, extent);
    });
    if (!known) guesses.push_back(guess);
  };
  for (const Unit unit : {Unit::kStated, Unit::kUv, Unit::kPixels, Unit::kNdc, Unit::kOutputPixels}) {
    each_turn([&](bool swapped, bool x, bool y) { add({unit, swapped, x, y}); });
  }
  add({.later = -1});
  add({.later = 1});
  return guesses;
}

std::vector<std::string> faults_of(const MotionGuess& guess) {
  std::vector<std::string> faults;
  if (guess.unit == Unit::kNothing) return {"unit"};  // of values that are too small
  if (guess.unit != Unit::kStated) faults.push_back("unit");
  add_common_faults(faults, guess, quincunx::name_of(MotionVerdict::kDirection));
  return faults;
}

std::string text_of(const MotionGuess& guess) {
  std::vector<std::string> parts;
  if (guess.unit != Unit::kStated) parts.emplace_back(name_of(guess.unit));
  add_common_parts(parts, guess, "the other direction", "");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string option_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  if (guess.unit == Unit::kNothing) return "--velocity none";
  if (guess.later != 0) return "write each frame's own motion";
  std::string text;
  if (guess.swapped) text = fmt::format("--velocity {},{} ", input.channels[1], input.channels[0]);
  const Vec2 factors = factors_of(input, guess, extent);
  for (const auto convention :
       {VelocityConvention::kNuke, VelocityConvention::kFsr2, VelocityConvention::kNdc}) {
    const Vec2 known = stated_factors({convention}, extent);
    if (near(known.x * static_cast<float>(extent.width), factors.x, 1e-4f) &&
        near(known.y * static_cast<float>(extent.height), factors.y, 1e-4f))
      return text + fmt::format("--velocity-convention {}", tools::name_of(convention));
  }
  return text + fmt::format("--velocity-scale {:.6g},{:.6g}", factors.x / static_cast<float>(extent.width),
                            factors.y / static_cast<float>(extent.height));
}

// Jitter: guesses of what the frames were drawn with.

JitterMend mend_of(const JitterGuess& guess) {
  return {guess.swapped,
          {guess.factor * (guess.flip_x ? -1.0f : 1.0f), guess.factor * (guess.flip_y ? -1.0f : 1.0f)},
          guess.later};
}

std::optional<Vec2> jitter_at(Frames frames, const DiagnosedInput& input, const JitterGuess& guess,
                              std::size_t i) {
  const auto from = static_cast<std::ptrdiff_t>(i) + guess.later;
  if (from < 0 || from >= static_cast<std::ptrdiff_t>(frames.size())) return std::nullopt;
  const DiagnosedFrame& frame = frames[static_cast<std::size_t>(from)];
  if (frame.number != frames[i].number + guess.later) return std::nullopt;
  if (guess.pattern) return jitter_of(*guess.pattern, frame.index, frame.render, input.output);
  return mend_of(guess).of(frame.jitter);
}

std::vector<JitterGuess> jitter_guesses(Frames frames, const DiagnosedInput& input) {
  std::vector<JitterGuess> guesses = {{}};
  const bool told = std::any_of(frames.begin(), frames.end(), [&](const DiagnosedFrame& frame) {
    return frame.jitter != frames[0].jitter;
  });
  if (told) {
    each_turn([&](bool swapped, bool x, bool y) {
      if (swapped || x || y) guesses.push_back({swapped, x, y});
    });
    const float scale = static_cast<float>(frames[0].render.width) / static_cast<float>(input.output.width);
    for (const float factor : {0.0f, .5f, 2.0f})
      guesses.push_back({.factor = factor});
    if (std::abs(scale - 1) > .1f && scale != .5f) guesses.push_back({.factor = scale});
    guesses.push_back({.later = -1});
    guesses.push_back({.later = 1});
  }
  for (const Jitter pattern : {Jitter::kHalton, Jitter::kQuincunx, Jitter::kQuincunxHalf})
    guesses.push_back({.pattern = pattern});
  return guesses;
}

std::vector<std::string> faults_of(const JitterGuess& guess) {
  std::vector<std::string> faults;
  if (guess.pattern) return {"pattern"};
  if (guess.factor == 0) return {"none"};
  if (guess.factor != 1) faults.push_back("scale");
  add_common_faults(faults, guess, "sign");
  return faults;
}

std::string text_of(const JitterGuess& guess) {
  if (guess.pattern) return fmt::format("the pattern {}", tools::name_of(*guess.pattern));
  if (guess.factor == 0) return "none in the frames";
  std::vector<std::string> parts;
  if (guess.factor != 1) parts.push_back(fmt::format("{:.3g} times as far", guess.factor));
  add_common_parts(parts, guess, "the other sign", "that ");
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace quincunx::tools
