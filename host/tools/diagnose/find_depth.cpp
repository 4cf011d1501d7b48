// SPDX-License-Identifier: MIT
// Depth and camera: guesses of both, against motion where that is known, else against colour.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

CameraSense sense_in(const Scene& scene, const DepthGuess& guess) {
  const CameraSense stated = scene.input.camera;
  return {stated.unit != guess.other_unit, stated.flipped != guess.flipped,
          scene.form.transposed.value_or(stated.transposed)};
}

std::optional<Matrix> matrix_at(const Scene& scene, std::size_t i, const DepthGuess& guess) {
  const int later = guess.camera == Camera::kLast ? -1 : guess.camera == Camera::kNext ? 1 : 0;
  const auto from =
      static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + later);  // huge before the first
  if (from >= scene.frames.size()) return std::nullopt;
  const DiagnosedFrame& frame = scene.frames[from];
  if (frame.number != scene.frames[i].number + later || !frame.world_to_ndc) return std::nullopt;
  return to_screen(*frame.world_to_ndc, sense_in(scene, guess));
}

// Whether matrices are those of cameras only if they are transposed, or only if not; nothing where either may be.
std::optional<bool> find_transposed(Frames frames) {
  std::size_t plain = 0, turned = 0;
  for (const DiagnosedFrame& frame : frames) {
    if (!frame.world_to_ndc) continue;
    const CameraForm as_is = camera_form(*frame.world_to_ndc, frame.render);
    const CameraForm other = camera_form(transposed(*frame.world_to_ndc), frame.render);
    plain += as_is.is && !other.may_be ? 1 : 0;
    turned += other.is && !as_is.may_be ? 1 : 0;
  }
  constexpr double kMost = .9;
  if (static_cast<double>(plain) >= kMost * static_cast<double>(frames.size())) return false;
  if (static_cast<double>(turned) >= kMost * static_cast<double>(frames.size())) return true;
  return std::nullopt;
}

// What three neighbours in a row of a flat surface say, of those that say anything.
struct Flatness {
  std::size_t affine = 0;
  std::size_t inverse = 0;  // 1 / value is affine

  void add(double a, double b, double c) {
    constexpr double kNear = .2, kLeastBend = 1e-5;  // parts of the value: floats have it to 1e-7
    constexpr double kStraight = .25;                // of the bend
    if (!(a > 0 && b > 0 && c > 0) || std::abs(c - a) > 2 * kNear * b) return;
    const double as_is = a - 2 * b + c, inverted = -b * b * (1 / a - 2 / b + 1 / c);
    const double bend = std::abs(as_is - inverted);
    if (!(bend > kLeastBend * b)) return;
    affine += std::abs(as_is) < kStraight * bend ? 1 : 0;
    inverse += std::abs(inverted) < kStraight * bend ? 1 : 0;
  }
};

// Returns what makes distances of depth that is negative, or goes evenly from one distance at 0 to another at 1: on a
// flat surface 1 / (value - `there`) is affine, where `there` is the value at the camera.
Vec2 find_range(Frames frames) {
  constexpr double kNear = .2, kLeastBend = 1e-6, kSame = .02,
                   kMost = .6;  // parts of the value; of the votes
  constexpr std::size_t kLeast = 200;
  std::size_t below = 0, above = 0, beyond = 0;
  std::vector<std::pair<double, double>> votes;  // for `there`, and the value
  for (const DiagnosedFrame& frame : frames) {
    const auto width = static_cast<std::size_t>(frame.render.width);
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      below += frame.depth[i] < 0 ? 1 : 0;
      above += frame.depth[i] > 0 && frame.depth[i] < 1e9f ? 1 : 0;
      beyond += frame.depth[i] > 1 ? 1 : 0;
      for (const std::size_t step : {std::size_t{1}, width}) {
        if (step == 1 ? i % width + 2 >= width : i + 2 * width >= frame.depth.size()) continue;
        const double a = frame.depth[i], b = frame.depth[i + step], c = frame.depth[i + 2 * step];
        const double bend = a - 2 * b + c;
        // Where the bend is most of the difference a surface ends.
        if (a > 0 && c > 0 && std::abs(c - a) < kNear * b && std::abs(bend) > kLeastBend * b &&
            std::abs(bend) < kNear * std::abs(c - a))
          votes.emplace_back((2 * a * c - b * (a + c)) / bend, b);
      }
    }
  }
  if (below > above) return {0, -1};
  if (votes.size() < kLeast || below + beyond > 0) return kWholeRange;
  std::sort(votes.begin(), votes.end());
  const double there = votes[votes.size() / 2].first;
  double same = 0, sum = 0;
  for (const auto& [vote, value] : votes)
    same += std::abs(vote - there) < kSame * value ? 1 : 0, sum += value;
  const double value = sum / static_cast<double>(votes.size());
  // Distances have 0; of device depth, which is affine itself, `there` is anywhere.
  if (!(std::abs(there) > 2 * kSame * value && same > kMost * static_cast<double>(votes.size())))
    return kWholeRange;
  const auto zero = static_cast<float>(there);
  return zero > value ? Vec2{zero, zero - 1} : Vec2{-zero, 1 - zero};
}

// Device depth lies between 0 and 1, and most of a picture is more than two near planes away.
std::optional<DepthKind> find_kind(Frames frames) {
  constexpr std::size_t kLeast = 50;
  constexpr double kMost = .85, kSide = .9;
  std::size_t beyond = 0, low = 0, high = 0;
  Flatness reversed, device;
  for (const DiagnosedFrame& frame : frames) {
    const auto width = static_cast<std::size_t>(frame.render.width);
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const float value = frame.depth[i];
      if (!std::isfinite(value)) continue;
      beyond += value > 1 ? 1 : 0;
      low += value > 0 && value < .5f ? 1 : 0;
      high += value >= .5f && value < 1 ? 1 : 0;
      for (const std::size_t step : {std::size_t{1}, width}) {
        if (step == 1 ? i % width + 2 >= width : i + 2 * width >= frame.depth.size()) continue;
        const double a = frame.depth[i], b = frame.depth[i + step], c = frame.depth[i + 2 * step];
        if (!(a < 1 && b < 1 && c < 1)) continue;
        reversed.add(a, b, c);
        device.add(1 - a, 1 - b, 1 - c);
      }
    }
  }
  const auto most = [](std::size_t part, std::size_t other, double share) {
    return static_cast<double>(part) >= share * static_cast<double>(part + other);
  };
  if (beyond + low + high == 0) return std::nullopt;
  if (most(beyond, low + high, kMost)) return DepthKind::kLinear;
  if (beyond * 1000 > low + high) return std::nullopt;
  const std::size_t affine = std::max(reversed.affine, device.affine);
  if (affine + reversed.inverse < kLeast) return std::nullopt;
  if (most(reversed.inverse, affine, kMost)) return DepthKind::kLinear;
  if (!most(affine, reversed.inverse, kMost)) return std::nullopt;
  if (most(low, high, kSide)) return DepthKind::kDeviceReversed;
  if (most(high, low, kSide)) return DepthKind::kDevice;
  return std::nullopt;
}

// Returns the motion of a guess at each pair's places, or every `stride`-th; none for a pair that it says nothing of.
Motion camera_motion_of(const Scene& scene, const Pair& pair, const DepthGuess& guess,
                        std::size_t stride = 1) {
  const DiagnosedFrame& frame = scene.frames[pair.now];
  const auto camera = camera_of(scene, pair, guess);
  if (!camera || frame.depth.empty()) return {};
  Motion motion;
  const Vec2 jitter = scene.motion.jitter[pair.now];
  for (std::size_t i = 0; i < pair.places.size(); i += stride) {
    const Place& place = pair.places[i];
    float depth[] = {frame.depth[pixel_of(frame, place.x, place.y)]};
    to_reversed_depth(guess.kind, scene.input.near_plane, depth);
    const Vec2 at = {static_cast<float>(place.x) + .5f + jitter.x,
                     static_cast<float>(place.y) + .5f + jitter.y};
    const Vec2 moved = camera_moves(*camera, at, depth[0], frame.render);
    motion.push_back(std::isfinite(moved.x) && std::isfinite(moved.y) ? moved : Vec2{1e6f, 1e6f});
  }
  return motion;
}

std::vector<Motion> camera_motion_of(const Scene& scene, const DepthGuess& guess) {
  std::vector<Motion> motion;
  for (const Pair& pair : scene.pairs)
    motion.push_back(camera_motion_of(scene, pair, guess));
  return motion;
}

// Returns the pixels between neighbouring values of motion, where that is stored in steps, as with 8 bits; else 0.
float step_of(const Scene& scene) {
  constexpr float kRoom = .02f;
  float least = 0;
  std::vector<float> values;
  for (const Pair& pair : scene.pairs) {
    for (std::size_t i = 0; i < pair.places.size(); i += 7) {
      for (const float v : {std::abs(pair.places[i].velocity[1].x), std::abs(pair.places[i].velocity[1].y)}) {
        if (v == 0) continue;
        values.push_back(v);
        least = least > 0 ? std::min(least, v) : v;
      }
    }
  }
  for (const float part : {1.0f, 2.0f, 3.0f}) {
    const float step = least / part;
    const auto off = std::count_if(values.begin(), values.end(), [&](float v) {
      return std::abs(v / step - std::round(v / step)) > kRoom;
    });
    const Vec2 factors = factors_of(scene.input, scene.motion.guess, scene.frames[0].render);
    if (!values.empty() && static_cast<double>(off) < .01 * static_cast<double>(values.size()))
      return step * std::max(std::abs(factors.x), std::abs(factors.y));
  }
  return 0;
}

// `step`: as of step_of().
Foretold foretold_of(const Scene& scene, const std::vector<Motion>& motion, float step) {
  Foretold result = {.motion = &motion,
                     .shift = scene.motion.shift,
                     .errors = std::vector<std::vector<float>>(motion.size())};
  if (scene.motion.knows_motion) result.apart = std::max(.02f, step);
  for (std::size_t p = 0; p < motion.size(); ++p) {
    if (motion[p].empty()) continue;
    const Pair& pair = scene.pairs[p];
    if (!scene.motion.knows_motion) {
      result.errors[p] = foretell(pair, scene.planes[pair.now - 1], motion[p], result.shift[p]);
      continue;
    }
    for (std::size_t i = 0; i < motion[p].size(); ++i) {
      const float off = square(difference(motion[p][i], scene.motion.motion[p][i]));
      const float apart = std::min(std::sqrt(off), 1.0f);
      // A motion of exactly 0 was not drawn, as that of many a sky: it tells nothing of the camera.
      const bool drawn = pair.places[i].velocity[1] != Vec2{};
      result.errors[p].push_back(drawn ? apart * apart + step * step : 0);
    }
  }
  return result;
}

std::size_t faults_of(const DiagnosedInput& input, const DepthGuess& guess) {
  return (guess.near_factor != 1 ? 1u : 0u) + (guess.kind != input.depth_kind ? 1u : 0u) +
         (guess.camera != Camera::kStated ? 1u : 0u) + (guess.other_unit || guess.flipped ? 1u : 0u);
}

// Returns the factor of the near plane, or of linear depth, with which the motion is told best under a camera.
float fitting_near(const Scene& scene, DepthKind kind, Camera which) {
  constexpr std::size_t kEnough = 300;  // places of a pair
  const auto error = [&](float factor) {
    double sum = 0;
    for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
      const std::size_t stride = std::max<std::size_t>(scene.pairs[p].places.size() / kEnough, 1);
      const Motion moved = camera_motion_of(scene, scene.pairs[p], {kind, which, factor}, stride);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        const Vec2 off = difference(moved[i], scene.motion.motion[p][i * stride]);
        sum += std::min(std::hypot(off.x, off.y), 1.0f);
      }
    }
    return sum;
  };
  float best = 1;
  double least = error(best);
  const auto search = [&](float centre, float step, int reach) {
    for (int i = -reach; i <= reach; ++i) {
      const float factor = centre * std::exp2(step * static_cast<float>(i));
      if (const double here = error(factor); here < least) least = here, best = factor;
    }
  };
  search(1, .5f, 28);
  for (const float step : {.125f, .03f, .008f})
    search(best, step, 4);
  const float ten = std::pow(10.0f, std::round(std::log10(best)));  // of metres and millimetres
  return std::abs(best / ten - 1) < .015f ? ten : best;
}

// The input's word first; other kinds only where depth's form does not say which it is.
std::vector<DepthGuess> depth_guesses(const Scene& scene) {
  const DepthKind stated = scene.input.depth_kind;
  std::vector<DepthGuess> guesses = {{stated}};
  const bool told = scene.motion.knows_motion && agrees(scene.pairs, scene.motion.motion,
                                                        camera_motion_of(scene, guesses[0]), step_of(scene));
  for (const Camera camera : {Camera::kStated, Camera::kLast, Camera::kNext}) {
    for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed}) {
      if (kind == stated ? camera != Camera::kStated : !scene.form.kind) guesses.push_back({kind, camera});
    }
    constexpr float kLeast = 1.1f;
    // Linear depth is seldom in another unit than the camera.
    if (!scene.motion.knows_motion || (stated == DepthKind::kLinear && (camera != Camera::kStated || told)))
      continue;
    const float factor = fitting_near(scene, stated, camera);
    if (factor > kLeast || factor * kLeast < 1) guesses.push_back({stated, camera, factor});
  }
  for (const auto& [unit, flipped] : {std::pair(true, false), {false, true}, {true, true}})
    guesses.push_back({.kind = stated, .other_unit = unit, .flipped = flipped});
  return guesses;
}

// Whether depth grows with distance, by rims: what comes out from behind another surface was hidden, and that one was
// not, whatever the values mean.
Votes grows_with_distance(const Scene& scene) {
  constexpr float kOther = .1f;  // of the value
  const auto alike = [](float a, float b) {
    return std::abs(a - b) < kOther * std::max(std::abs(a), std::abs(b));
  };
  Votes votes;
  for (const Pair& pair : scene.pairs) {
    const DiagnosedFrame &now = scene.frames[pair.now], &before = scene.frames[pair.now - 1];
    if (now.depth.empty() || now.velocity.empty() || before.depth.empty() || now.render != before.render)
      continue;
    const Vec2 step = difference(scene.motion.jitter[pair.now], scene.motion.jitter[pair.now - 1]);
    const auto was_seen = [&](int x, int y) {  // or nobody knows
      const Vec2 moved = own_motion(scene, pair, x, y);
      const float at_x = static_cast<float>(x) - moved.x + step.x,
                  at_y = static_cast<float>(y) - moved.y + step.y;
      if (!(at_x >= 0 && at_y >= 0 && at_x < static_cast<float>(now.render.width - 1) &&
            at_y < static_cast<float>(now.render.height - 1)))
        return true;
      for (int i = 0; i < 4; ++i) {
        const std::size_t at =
            pixel_of(before, static_cast<int>(at_x) + i % 2, static_cast<int>(at_y) + i / 2);
        if (alike(now.depth[pixel_of(now, x, y)], before.depth[at])) return true;
      }
      return false;
    };
    for (int i = 0; i < 2 * (now.render.width - 1) * (now.render.height - 1); ++i) {
      const int x = i / 2 % (now.render.width - 1), y = i / 2 / (now.render.width - 1);
      const int next_x = x + i % 2, next_y = y + 1 - i % 2;
      const float depth = now.depth[pixel_of(now, x, y)], beside = now.depth[pixel_of(now, next_x, next_y)];
      if (alike(depth, beside) || !std::isfinite(depth + beside)) continue;
      const bool seen = was_seen(x, y);
      if (seen != was_seen(next_x, next_y)) votes.add(seen == (depth < beside));
    }
  }
  return votes;
}

// Whether colours are foretold better than by no motion.
bool betters_rest(const Scene& scene, const Foretold& foretold) {
  return clear(compare(scene.pairs, scene.frames, foretold, foretold_of(scene, at_rest(scene.pairs), 0)));
}

void find_wrong(Finding& finding, const std::string& fault, const std::string& fits,
                const std::string& option, const Comparison& against) {
  if (finding.verdict != Verdict::kWrong) finding.fits = finding.option = {};
  const char* comma = finding.fits.empty() ? "" : ", ";
  finding.verdict = Verdict::kWrong;
  finding.faults.push_back(fault);
  finding.fits += comma + fits;
  finding.option += (option.starts_with("--") && *comma != 0 ? " " : comma) + option;
  weigh(finding, against);
}

}  // namespace

bool agrees(const std::vector<Pair>& pairs, const std::vector<Motion>& motion,
            const std::vector<Motion>& camera, float step) {
  constexpr float kMoves = .1f, kRoom = .02f, kRoomPart = .06f;  // pixels; more, of the motion
  constexpr double kMost = .6, kLeast = 100;
  double moving = 0, agree = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (std::size_t i = 0; i < camera[p].size(); ++i) {
      const float length = std::sqrt(square(camera[p][i]));
      if (!(length > std::max(kMoves, 2 * step)) || pairs[p].places[i].velocity[1] == Vec2{}) continue;
      moving += 1;
      const float off = std::sqrt(square(difference(motion[p][i], camera[p][i])));
      agree += off < kRoom + kRoomPart * length + step / 2 ? 1 : 0;
    }
  }
  return moving >= kLeast && agree >= kMost * moving;
}

Form form_of(Frames frames, const DiagnosedInput& input) {
  Form form = {input.depth_kind, find_kind(frames), find_transposed(frames), kWholeRange};
  if (!form.kind || form.kind == DepthKind::kLinear) form.range = find_range(frames);
  return form;
}

std::vector<Motion> stated_camera_motion(Frames frames, const DiagnosedInput& input, const Form& form,
                                         const std::vector<Plane>& planes, const std::vector<Pair>& pairs) {
  MotionAnswer told;
  for (const DiagnosedFrame& frame : frames)
    told.jitter.push_back(frame.jitter);
  return camera_motion_of({frames, input, form, planes, pairs, told}, {input.depth_kind});
}

std::optional<CameraMotion> camera_of(const Scene& scene, const Pair& pair, const DepthGuess& guess,
                                      int back) {
  const auto now = matrix_at(scene, pair.now, guess);
  const auto other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(pair.now) - back);
  const auto before = matrix_at(scene, other, guess);
  if (!now || !before) return std::nullopt;
  return camera_motion(*now, *before, scene.input.near_plane * guess.near_factor);
}

Vec2 camera_moves(const CameraMotion& camera, Vec2 at, float depth, Extent extent) {
  const auto& m = camera.clip_to_previous_clip;
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  const float x = 2 * at.x / width - 1, y = 1 - 2 * at.y / height;
  const auto row = [&](std::size_t r) { return m[r] * x + m[4 + r] * y + m[8 + r] * depth + m[12 + r]; };
  const float w = row(3);
  return {(x - row(0) / w) * width / 2, (row(1) / w - y) * height / 2};
}

std::string range_option(const DiagnosedInput& input, Vec2 range) {
  const auto at = [&](float value) { return range.x + (range.y - range.x) * value; };
  return fmt::format("--depth-range {:.5g},{:.5g}", at(input.depth_range.x), at(input.depth_range.y));
}

DepthGuess find_depth(const Scene& scene, std::vector<Finding>& findings) {
  const DiagnosedInput& input = scene.input;
  const Form& form = scene.form;
  Finding depth = {.subject = "depth", .says = scene.frames[0].depth.empty() ? "none" : name_of(form.stated)};
  Finding camera = {.subject = "camera",
                    .says = !scene.frames[0].world_to_ndc   ? "none"
                            : input.camera == CameraSense{} ? "worldToNDC"
                                                            : text_of(input.camera)};
  const std::vector<DepthGuess> guesses = depth_guesses(scene);
  std::vector<std::vector<Motion>> motions;
  for (const DepthGuess& guess : guesses)
    motions.push_back(camera_motion_of(scene, guess));
  const float step = step_of(scene);
  std::vector<Candidate> candidates;
  for (std::size_t g = 0; g < guesses.size(); ++g)
    candidates.push_back({faults_of(input, guesses[g]), g, foretold_of(scene, motions[g], step)});
  std::size_t chosen = choose(scene.pairs, scene.frames, candidates);
  const auto explains = [&](std::size_t g) {  // any may be nearer the motion by chance
    return scene.motion.knows_motion ? agrees(scene.pairs, scene.motion.motion, motions[g], step)
                                     : g == 0 || betters_rest(scene, candidates[g].foretold);
  };
  const bool explained = explains(chosen);
  if (!explained) chosen = 0;
  DepthGuess best = guesses[chosen];
  Rivals kinds, cameras;
  for (std::size_t g = 0; g < guesses.size(); ++g) {
    const Comparison compared =
        compare(scene.pairs, scene.frames, candidates[chosen].foretold, candidates[g].foretold);
    const DepthGuess& guess = guesses[g];
    const bool same_sense = guess.other_unit == best.other_unit && guess.flipped == best.flipped;
    if (guess.camera == best.camera && guess.kind != best.kind) kinds.add(compared, {"kind"});
    if (guess.kind == best.kind && guess.camera != best.camera && guess.near_factor == 1)
      cameras.add(compared, {"frame"});
    if (guess.kind == best.kind && guess.camera == best.camera && !same_sense)
      cameras.add(compared, {"sense"});
  }
  const char* scale = best.kind == DepthKind::kLinear ? "unit" : "near plane";
  for (const float factor : {.5f, 2.0f}) {
    if (best.kind == DepthKind::kLinear && !scene.frames[0].world_to_ndc) break;
    DepthGuess other = best;
    other.near_factor *= factor;
    const auto motion = camera_motion_of(scene, other);
    kinds.add(
        compare(scene.pairs, scene.frames, candidates[chosen].foretold, foretold_of(scene, motion, step)),
        {scale});
  }
  kinds.judge(depth);
  cameras.judge(camera);
  if (!explained) depth.verdict = camera.verdict = Verdict::kUnknown;
  if (!form.transposed) camera.open.emplace_back("transposed");
  if (form.kind) {
    depth.verdict = Verdict::kRight;
    if (!explained && best.kind != DepthKind::kLinear) depth.open = {scale};
  }
  if (form.transposed && explained && scene.motion.knows_motion) camera.verdict = Verdict::kRight;
  const Comparison against =
      compare(scene.pairs, scene.frames, candidates[chosen].foretold, candidates[0].foretold);
  Comparison of_kind = form.kind ? Comparison{} : against;
  if (!form.kind && !explained && scene.motion.knows_motion) {
    const Votes grows = grows_with_distance(scene);
    const bool as_said = grows.most() == (best.kind != DepthKind::kDeviceReversed);
    if (grows.agree(50, .2) && !as_said) {
      best.kind = grows.most() ? DepthKind::kLinear : DepthKind::kDeviceReversed;
      of_kind = {.share = grows.agreed()};
      depth.open.clear();
    }
  }
  const bool linear = best.kind == DepthKind::kLinear;
  const float unit = linear ? best.near_factor : 1;
  if (form.range != kWholeRange || unit != 1) {
    const Vec2 range = product(form.range, {unit, unit});
    const bool negative = form.range == Vec2{0, -1};
    find_wrong(depth,
               negative                    ? "sign"
               : form.range != kWholeRange ? "range"
                                           : "unit",
               negative ? "negative" : fmt::format("from {:.4g} at 0 to {:.4g} at 1", range.x, range.y),
               range_option(input, range), form.range != kWholeRange ? Comparison{} : against);
  }
  if (best.kind != form.stated) {
    const char* kind = name_of(best.kind);
    find_wrong(depth, "kind", kind, fmt::format("--depth-kind {}", kind), of_kind);
  }
  if (best.near_factor != 1 && !linear) {
    const std::string near_plane = fmt::format("{:.4g}", input.near_plane * best.near_factor);
    find_wrong(depth, "near plane", "a near plane at " + near_plane, "--near " + near_plane, against);
  }
  const CameraSense fits = sense_in(scene, best);
  if (fits.transposed != input.camera.transposed)
    find_wrong(camera, "transposed", "its transpose", "--world-to-ndc " + text_of(fits), {});
  else if (fits != input.camera)
    find_wrong(camera, "sense", text_of(fits), "--world-to-ndc " + text_of(fits), against);
  if (best.camera != Camera::kStated) {
    find_wrong(camera, "frame", best.camera == Camera::kLast ? "the last frame's" : "the next frame's",
               "write the camera and the motion of one frame", against);
  }
  findings.push_back(depth);
  findings.push_back(camera);
  return best;
}

}  // namespace quincunx::tools
