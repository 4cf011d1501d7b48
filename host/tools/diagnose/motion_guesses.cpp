// SPDX-License-Identifier: MIT
// What the channels of motion may mean, and what jitter the frames may have been drawn with.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
  sizes = product(sizes, guess.length);
  return {std::copysign(sizes.x, stated.x) * (guess.flip_x ? -1.0f : 1.0f),
          std::copysign(sizes.y, stated.y) * (guess.flip_y ? -1.0f : 1.0f)};
}

Motion motion_of(const Pair& pair, const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  const Vec2 factors = factors_of(input, guess, extent), rest = guess.rest;
  Motion motion;
  motion.reserve(pair.places.size());
  for (const Place& place : pair.places) {
    const Vec2 own = difference(place.velocity[1], rest);
    Vec2 v = difference(place.velocity[static_cast<std::size_t>(1 + guess.later)], rest);
    // Another surface has come here, which says nothing of when motion was written.
    if (square(difference(v, own)) > .25f * square(own)) v = own;
    if (guess.swapped) std::swap(v.x, v.y);
    motion.push_back(product(v, factors));
  }
  return motion;
}

bool same(const DiagnosedInput& input, const MotionGuess& a, const MotionGuess& b, Extent extent,
          float part) {
  const Vec2 x = factors_of(input, a, extent), y = factors_of(input, b, extent);
  return a.swapped == b.swapped && a.later == b.later && a.rest == b.rest && near(x.x, y.x, part) &&
         near(x.y, y.y, part);
}

std::vector<MotionGuess> motion_guesses(const DiagnosedInput& input, Extent extent) {
  std::vector<MotionGuess> guesses;
  const auto add = [&](const MotionGuess& guess) {
    const bool known = std::any_of(guesses.begin(), guesses.end(), [&](const MotionGuess& other) {
      return same(input, guess, other, extent);
    });
    if (!known) guesses.push_back(guess);
  };
  for (const Unit unit : {Unit::kStated, Unit::kUv, Unit::kPixels, Unit::kNdc}) {
    each_turn([&](bool swapped, bool x, bool y) { add({unit, swapped, x, y}); });
  }
  for (const float length : {2.0f, .5f}) {
    each_turn([&](bool swapped, bool x, bool y) {
      if (!swapped) add({.flip_x = x, .flip_y = y, .length = {length, length}});
    });
  }
  each_turn([&](bool swapped, bool x, bool y) { add({Unit::kOutputPixels, swapped, x, y}); });
  add({.later = -1});
  add({.later = 1});
  return guesses;
}

bool keeps_unit(const MotionGuess& guess) {
  return guess.unit == Unit::kStated && guess.length == Vec2{1, 1} && guess.rest == Vec2{};
}

namespace {

// Values at rest that channels without any below 0 or above 1 may have: the middle, as a number or as 8 bits have it.
std::vector<Vec2> rests_of(Frames frames, const DiagnosedInput& input) {
  constexpr std::size_t kEvery = 37;
  double sum = 0, count = 0;
  bool from_0_to_1 = true;
  for (const DiagnosedFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.velocity.size(); i += kEvery) {
      const Vec2 v = frame.velocity[i];
      from_0_to_1 &= v.x >= 0 && v.y >= 0 && v.x <= 1 && v.y <= 1;
      sum += v.x + v.y, count += 2;
    }
  }
  if (input.velocity_offset != Vec2{}) return {{-input.velocity_offset.x, -input.velocity_offset.y}};
  if (!from_0_to_1 || !(sum > .2 * count && sum < .8 * count)) return {};
  return {{.5f, .5f}, {127 / 255.f, 127 / 255.f}, {128 / 255.f, 128 / 255.f}};
}

}  // namespace

Vec2 simple(Vec2 length, float room) {
  constexpr float kMost = 4;
  const auto whole = [room](float l) {
    const float larger = std::max(l, 1 / l), found = std::round(larger);
    return found <= kMost && near(found, larger, room) ? (l < 1 ? 1 / found : found) : l;
  };
  if (near(length.x, length.y, room)) length.x = length.y = std::sqrt(length.x * length.y);
  return {whole(length.x), whole(length.y)};
}

std::vector<MotionGuess> best_guesses(Frames frames, const DiagnosedInput& input,
                                      const std::vector<Plane>& planes, const std::vector<Pair>& pairs,
                                      bool explained) {
  constexpr std::size_t kKept = 6, kEnough = 5;  // guesses; pairs, spread over all
  constexpr double kAny = std::numeric_limits<double>::max(), kBetter = .6, kFarBetter = .05;
  const Extent extent = frames[0].render;
  // With the shift that fits each pair best, whatever the jitter; more than `most` is not looked at closely.
  const auto error_of = [&](const MotionGuess& guess, double most) {
    const std::size_t stride = std::max<std::size_t>(pairs.size() / kEnough, 1);
    double sum = 0;
    for (std::size_t p = 0; p < pairs.size() && sum <= most; p += stride) {
      const Motion motion = motion_of(pairs[p], input, guess, frames[pairs[p].now].render);
      sum += least_error(pairs[p], planes[pairs[p].before], motion);
    }
    return sum;
  };
  std::vector<MotionGuess> guesses = motion_guesses(input, extent);
  using Scored = std::pair<double, std::size_t>;
  std::vector<Scored> order;  // the best so far
  for (std::size_t g = 1; g < guesses.size(); ++g) {
    // Where guesses come to the same, the simpler goes first.
    const double handicap = 1 + .002 * static_cast<double>(faults_of(guesses[g]).size());
    order.emplace_back(error_of(guesses[g], order.size() < kKept ? kAny : order.back().first) * handicap, g);
    std::sort(order.begin(), order.end());
    if (order.size() > kKept) order.pop_back();
  }
  std::vector<MotionGuess> kept = {guesses[0]};
  for (const auto& [error, g] : order)
    kept.push_back(guesses[g]);

  // The length that fits, as far as so many octaves from a guess's; each axis by itself at last.
  const auto fit = [&](MotionGuess guess, double least, int octaves) {
    const auto scan = [&](Vec2 axes, float step, int reach) {
      const MotionGuess centre = guess;
      for (int i = -reach; i <= reach; ++i) {
        if (i == 0) continue;  // which is known
        MotionGuess tried = centre;
        const float by = step * static_cast<float>(i);
        tried.length = product(centre.length, {std::exp2(axes.x * by), std::exp2(axes.y * by)});
        if (const double error = error_of(tried, least); error < least) least = error, guess = tried;
      }
    };
    scan({1, 1}, .5f, 2 * octaves);
    for (const float step : {.25f, .12f, .06f, .03f}) {
      scan({1, 1}, step, 1);
      scan({1, 0}, step, 1);
      scan({0, 1}, step, 1);
    }
    guess.length = simple(guess.length, .03f);
    return std::pair(least, guess);
  };
  const auto add = [&](const MotionGuess& guess) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const MotionGuess& other) {
      return same(input, guess, other, extent, .1f);
    });
    if (!known) kept.push_back(guess);
  };
  const auto widest = [&](Vec2 rest) {
    std::pair<double, MotionGuess> best = {kAny, {}};
    each_turn([&](bool swapped, bool x, bool y) {
      if (swapped) return;  // with all else wrong: nobody's
      const MotionGuess guess = {.flip_x = x, .flip_y = y, .rest = rest};
      const auto found = fit(guess, std::min(best.first, error_of(guess, kAny)), 8);
      if (found.first < best.first) best = found;
    });
    return best;
  };
  const double stated = error_of(guesses[0], kAny), still = error_of({.unit = Unit::kNothing}, kAny);
  const bool usual = !order.empty() && order[0].first < stated;
  const double least = usual ? order[0].first : stated;
  // Any length at all only where none of the usual ones is far better than no motion.
  if (explained || least < kFarBetter * still || stated == still) return kept;
  if (least < kBetter * still)
    add(fit(usual ? guesses[order[0].second] : guesses[0], least, 2).second);
  else
    add(widest({}).second);
  const std::vector<Vec2> rests = rests_of(frames, input);
  for (std::size_t r = 0; r < rests.size(); ++r) {
    MotionGuess guess = r == 0 ? widest(rests[0]).second : kept.back();
    guess.rest = rests[r];
    kept.push_back(guess);
  }
  return kept;
}

std::vector<std::string> faults_of(const MotionGuess& guess) {
  std::vector<std::string> faults;
  if (guess.unit == Unit::kNothing) return {"unit"};  // of values that are too small
  if (guess.rest != Vec2{}) faults.push_back("offset");
  if (guess.unit != Unit::kStated || guess.length != Vec2{1, 1}) faults.push_back("unit");
  add_common_faults(faults, guess, quincunx::name_of(MotionVerdict::kDirection));
  return faults;
}

std::string text_of(const MotionGuess& guess) {
  std::vector<std::string> parts;
  if (guess.rest != Vec2{}) parts.emplace_back(guess.rest.x > 0 ? "about the middle of 0 to 1" : "about 0");
  if (guess.unit != Unit::kStated) parts.emplace_back(name_of(guess.unit));
  const Vec2 length = guess.length;
  if (length == Vec2{2, 2})
    parts.emplace_back("half as long as a frame's, as of a shutter that is open for half of it");
  else if (length == Vec2{.5f, .5f})
    parts.emplace_back("twice as long as a frame's, as of two, or in pixels of a picture of twice the size");
  else if (length.x == length.y && length.x != 1)
    parts.push_back(fmt::format("to be made {:.3g} times as long", length.x));
  else if (length.x != 1 || length.y != 1)
    parts.push_back(
        fmt::format("to be made {:.3g} times as long in x, {:.3g} times in y", length.x, length.y));
  add_common_parts(parts, guess, "the other direction", "");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string option_of(const DiagnosedInput& input, const MotionGuess& guess, Extent extent) {
  if (guess.unit == Unit::kNothing) return "--velocity none";
  if (guess.later != 0) return "write each frame's own motion";
  std::string text;
  if (guess.swapped) text = fmt::format("--velocity {},{} ", input.channels[1], input.channels[0]);
  if (guess.rest != Vec2{})
    text += fmt::format("--velocity-offset {:.6g} ", input.velocity_offset.x + guess.rest.x);
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
