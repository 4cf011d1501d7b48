// SPDX-License-Identifier: MIT
#include "tools/diagnose/motion_guesses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "quincunx/advanced/motion_check.h"

namespace quincunx::tools {
namespace {

using Frames = std::span<const DiagnosedFrame>;

// Factors from channels to uv by the input's word.
Vec2 stated_factors(const VelocityUnits& units, Extent extent) {
  Vec2 one[] = {{1, 1}};
  to_velocity(units, extent, one);
  return one[0];
}

const char* name_of(Unit unit) {
  switch (unit) {
    case Unit::kStated:
      return "";
    case Unit::kUv:
      return "parts of the picture";
    case Unit::kPixels:
      return "pixels";
    case Unit::kOutputPixels:
      return "pixels of the output";
    case Unit::kNdc:
      return "normalised device coordinates";
    case Unit::kNothing:
      return "nothing that is known: none at all foretells better";
  }
  return "";
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

}  // namespace

Vec2 factors_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  const Vec2 stated = stated_factors(input.units, extent);
  Vec2 sizes = {std::abs(stated.x) * width, std::abs(stated.y) * height};
  switch (guess.unit) {
    case Unit::kStated:
      break;
    case Unit::kUv:
      sizes = {width, height};
      break;
    case Unit::kPixels:
      sizes = {1, 1};
      break;
    case Unit::kOutputPixels:
      sizes = {width / static_cast<float>(input.output.width),
               height / static_cast<float>(input.output.height)};
      break;
    case Unit::kNdc:
      sizes = {width / 2, height / 2};
      break;
    case Unit::kNothing:
      sizes = {};
      break;
  }
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
    const Vec2 off = {v.x - own.x, v.y - own.y};
    if (off.x * off.x + off.y * off.y > .25f * (own.x * own.x + own.y * own.y)) v = own;
    if (guess.swapped) std::swap(v.x, v.y);
    motion.push_back({v.x * factors.x, v.y * factors.y});
  }
  return motion;
}

bool same(const DiagnosedInput& input, const MotionGuess& a, const MotionGuess& b, Extent extent) {
  const Vec2 x = factors_of(input, a, extent), y = factors_of(input, b, extent);
  const auto near = [](float p, float q) { return std::abs(p - q) <= .01f * std::abs(p); };
  return a.swapped == b.swapped && a.later == b.later && near(x.x, y.x) && near(x.y, y.y);
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
    for (const bool swapped : {false, true}) {
      for (const auto& [x, y] : {std::pair(false, false), {true, false}, {false, true}, {true, true}})
        add({unit, swapped, x, y});
    }
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
  if (guess.swapped) parts.emplace_back("axes swapped");
  if (guess.flip_x && guess.flip_y) parts.emplace_back("the other direction");
  if (guess.flip_x != guess.flip_y)
    parts.push_back(fmt::format("{} the other way", guess.flip_x ? "x" : "y"));
  if (guess.later != 0) parts.push_back(fmt::format("of the {} frame", guess.later > 0 ? "next" : "last"));
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
    const auto near = [](float p, float q) { return std::abs(p - q) <= 1e-4f * std::abs(p); };
    if (near(known.x * static_cast<float>(extent.width), factors.x) &&
        near(known.y * static_cast<float>(extent.height), factors.y))
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
    for (const bool swapped : {false, true}) {
      for (const auto& [x, y] : {std::pair(false, false), {true, false}, {false, true}, {true, true}})
        if (swapped || x || y) guesses.push_back({swapped, x, y});
    }
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
  if (guess.swapped) parts.emplace_back("axes swapped");
  if (guess.flip_x && guess.flip_y) parts.emplace_back("the other sign");
  if (guess.flip_x != guess.flip_y)
    parts.push_back(fmt::format("{} the other way", guess.flip_x ? "x" : "y"));
  if (guess.later != 0)
    parts.push_back(fmt::format("that of the {} frame", guess.later > 0 ? "next" : "last"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace quincunx::tools
