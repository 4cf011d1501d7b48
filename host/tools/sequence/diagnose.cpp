// SPDX-License-Identifier: MIT
#include "tools/sequence/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/sequence/diagnose_motion.h"

namespace quincunx::tools {
namespace {

using Frames = std::span<const DiagnosedFrame>;

std::size_t pixel_of(const DiagnosedFrame& frame, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.render.width) +
         static_cast<std::size_t>(x);
}

// Depth and camera: guesses of both, against motion where that is known, else against colour.

enum class Camera : std::uint8_t { kStated, kTransposed, kLast, kNext };

struct DepthGuess {
  DepthKind kind;
  Camera camera = Camera::kStated;
};

const DiagnosedFrame* beside(Frames frames, std::size_t i, int later) {
  const auto from = static_cast<std::ptrdiff_t>(i) + later;
  if (from < 0 || from >= static_cast<std::ptrdiff_t>(frames.size())) return nullptr;
  const DiagnosedFrame& frame = frames[static_cast<std::size_t>(from)];
  return frame.number == frames[i].number + later && frame.world_to_ndc ? &frame : nullptr;
}

std::optional<Matrix> matrix_at(Frames frames, std::size_t i, Camera camera) {
  const int later = camera == Camera::kLast ? -1 : camera == Camera::kNext ? 1 : 0;
  const DiagnosedFrame* frame = beside(frames, i, later);
  if (frame == nullptr) return std::nullopt;
  Matrix matrix = *frame->world_to_ndc;
  if (camera == Camera::kTransposed) {
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < row; ++column)
        std::swap(matrix[4 * row + column], matrix[4 * column + row]);
  }
  return matrix;
}

// Pixels by which a static point moves.
Vec2 camera_moves(const CameraMotion& camera, Vec2 at, float depth, Extent extent) {
  const auto& m = camera.clip_to_previous_clip;
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  const float x = 2 * at.x / width - 1, y = 1 - 2 * at.y / height;
  const auto row = [&](std::size_t r) { return m[r] * x + m[4 + r] * y + m[8 + r] * depth + m[12 + r]; };
  const float w = row(3);
  return {(x - row(0) / w) * width / 2, (row(1) / w - y) * height / 2};
}

struct Scene {
  Frames frames;
  const DiagnosedInput& input;
  const std::vector<Plane>& planes;
  const std::vector<Pair>& pairs;
  const MotionAnswer& motion;
};

// Motion of a guess at all pairs; empty for a pair that it says nothing of.
std::vector<Motion> camera_motion_of(const Scene& scene, const DepthGuess& guess) {
  std::vector<Motion> motion(scene.pairs.size());
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    const Pair& pair = scene.pairs[p];
    const DiagnosedFrame& frame = scene.frames[pair.now];
    const auto now = matrix_at(scene.frames, pair.now, guess.camera);
    const auto before = matrix_at(scene.frames, pair.now - 1, guess.camera);
    if (!now || !before || frame.depth.empty()) continue;
    const auto camera = camera_motion(*now, *before, scene.input.near_plane);
    if (!camera) continue;
    const Vec2 jitter = scene.motion.jitter[pair.now];
    for (const Place& place : pair.places) {
      float depth[] = {frame.depth[pixel_of(frame, place.x, place.y)]};
      to_reversed_depth(guess.kind, scene.input.near_plane, depth);
      const Vec2 at = {static_cast<float>(place.x) + .5f + jitter.x,
                       static_cast<float>(place.y) + .5f + jitter.y};
      const Vec2 moved = camera_moves(*camera, at, depth[0], frame.render);
      motion[p].push_back(std::isfinite(moved.x) && std::isfinite(moved.y) ? moved : Vec2{1e6f, 1e6f});
    }
  }
  return motion;
}

Foretold foretold(const Scene& scene, const std::vector<Motion>& motion) {
  Foretold result = {.motion = &motion,
                     .shift = scene.motion.shift,
                     .errors = std::vector<std::vector<float>>(motion.size())};
  if (scene.motion.knows_motion) result.apart = .02f;
  for (std::size_t p = 0; p < motion.size(); ++p) {
    if (motion[p].empty()) continue;
    const Pair& pair = scene.pairs[p];
    if (!scene.motion.knows_motion) {
      result.errors[p] = foretell(pair, scene.planes[pair.now - 1], motion[p], result.shift[p]);
      continue;
    }
    for (std::size_t i = 0; i < motion[p].size(); ++i) {
      const Vec2 a = motion[p][i], b = scene.motion.motion[p][i];
      const float apart = std::min(std::hypot(a.x - b.x, a.y - b.y), 1.0f);
      result.errors[p].push_back(apart * apart);
    }
  }
  return result;
}

std::vector<std::string> faults_of(const DiagnosedInput& input, const DepthGuess& guess) {
  std::vector<std::string> faults;
  if (guess.kind != input.depth_kind) faults.emplace_back("depth kind");
  if (guess.camera == Camera::kTransposed) faults.emplace_back("transposed");
  if (guess.camera == Camera::kLast || guess.camera == Camera::kNext) faults.emplace_back("frame");
  return faults;
}

// The input's word first.
std::vector<DepthGuess> depth_guesses(DepthKind stated) {
  std::vector<DepthGuess> guesses = {{stated}};
  for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed}) {
    for (const Camera camera : {Camera::kStated, Camera::kTransposed, Camera::kLast, Camera::kNext}) {
      if (kind != stated || camera != Camera::kStated) guesses.push_back({kind, camera});
    }
  }
  return guesses;
}

void find_wrong(Finding& finding, const std::string& fault, const std::string& fits,
                const std::string& option, const Comparison& against) {
  finding.verdict = Verdict::kWrong;
  finding.faults = {fault};
  finding.fits = fits;
  finding.option = option;
  finding.margin_db = against.margin_db;
  finding.share = against.share;
}

// Returns the guess to believe.
DepthGuess find_depth(const Scene& scene, std::vector<Finding>& findings) {
  const DiagnosedInput& input = scene.input;
  Finding depth = {.subject = "depth",
                   .says = scene.frames[0].depth.empty() ? "none" : name_of(input.depth_kind)};
  Finding camera = {.subject = "camera", .says = scene.frames[0].world_to_ndc ? "worldToNDC" : "none"};
  const std::vector<DepthGuess> guesses = depth_guesses(input.depth_kind);
  std::vector<std::vector<Motion>> motions;
  for (const DepthGuess& guess : guesses)
    motions.push_back(camera_motion_of(scene, guess));
  std::vector<Candidate> candidates;
  for (std::size_t g = 0; g < guesses.size(); ++g)
    candidates.push_back({faults_of(input, guesses[g]).size(), g, foretold(scene, motions[g])});
  const std::size_t chosen = choose(scene.pairs, scene.frames, candidates);
  const DepthGuess best = guesses[chosen];
  Rivals kinds, cameras;
  for (std::size_t g = 0; g < guesses.size(); ++g) {
    const Comparison compared =
        compare(scene.pairs, scene.frames, candidates[chosen].foretold, candidates[g].foretold);
    if (guesses[g].camera == best.camera && guesses[g].kind != best.kind)
      kinds.add(compared, {name_of(guesses[g].kind)});
    if (guesses[g].kind == best.kind && guesses[g].camera != best.camera)
      cameras.add(compared, {guesses[g].camera == Camera::kTransposed ? "transposed" : "frame"});
  }
  kinds.judge(depth);
  cameras.judge(camera);
  const Comparison against =
      compare(scene.pairs, scene.frames, candidates[chosen].foretold, candidates[0].foretold);
  if (best.kind != input.depth_kind) {
    const char* kind = name_of(best.kind);
    find_wrong(depth, "kind", kind, fmt::format("--depth-kind {}", kind), against);
  }
  if (best.camera == Camera::kTransposed)
    find_wrong(camera, "transposed", "its transpose", "write it for row vectors", against);
  if (best.camera == Camera::kLast || best.camera == Camera::kNext) {
    find_wrong(camera, "frame", best.camera == Camera::kLast ? "the last frame's" : "the next frame's",
               "write the camera and the motion of one frame", against);
  }
  findings.push_back(depth);
  findings.push_back(camera);
  return best;
}

bool has_fault(const Finding& finding, const std::string& fault) {
  return std::find(finding.faults.begin(), finding.faults.end(), fault) != finding.faults.end();
}

// Votes of pixels: how many say yes, of those that say anything.
struct Votes {
  std::size_t yes = 0;
  std::size_t all = 0;

  double share() const { return all > 0 ? static_cast<double>(yes) / static_cast<double>(all) : 0; }
};

// Where a nearer surface ends, does the pixel beyond it move as that does, or as its own surface?
Finding find_dilation(const Scene& scene, DepthKind kind) {
  Finding finding = {.subject = "dilation", .says = scene.input.dilated ? "dilated" : "own"};
  Votes votes;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.velocity.empty() || frame.depth.empty()) continue;
    std::vector<float> depth = frame.depth;
    to_reversed_depth(kind, scene.input.near_plane, depth);
    const auto vote = [&](std::size_t near, std::size_t middle, std::size_t far) {
      if (!(depth[near] > 1.1f * depth[middle]) || depth[middle] > 1.05f * depth[far] ||
          depth[far] > 1.05f * depth[middle])
        return;
      const Vec2 n = frame.velocity[near], m = frame.velocity[middle], f = frame.velocity[far];
      const float apart = std::hypot(n.x - f.x, n.y - f.y);
      if (!(apart > .3f * std::max(std::hypot(n.x, n.y), std::hypot(f.x, f.y)))) return;
      const bool as_near = std::hypot(m.x - n.x, m.y - n.y) < .1f * apart;
      const bool as_far = std::hypot(m.x - f.x, m.y - f.y) < .1f * apart;
      if (as_near == as_far) return;
      ++votes.all;
      votes.yes += as_near ? 1 : 0;
    };
    for (int y = 1; y + 1 < frame.render.height; ++y) {
      for (int x = 1; x + 1 < frame.render.width; ++x) {
        const std::size_t at = pixel_of(frame, x, y), row = static_cast<std::size_t>(frame.render.width);
        vote(at - 1, at, at + 1), vote(at + 1, at, at - 1), vote(at - row, at, at + row),
            vote(at + row, at, at - row);
      }
    }
  }
  if (votes.all < 100) return finding;
  if (votes.share() > .2 && votes.share() < .8) return finding;
  const bool dilated = votes.share() >= .8;
  finding.verdict = dilated == scene.input.dilated ? Verdict::kRight : Verdict::kWrong;
  finding.share = dilated ? votes.share() : 1 - votes.share();
  if (finding.verdict == Verdict::kRight) return finding;
  finding.faults = {dilated ? "dilated" : "not dilated"};
  finding.fits = dilated ? "that of the nearest of 3x3" : "each pixel's own";
  finding.option = dilated ? "--drawn-velocity dilated" : "--drawn-velocity own";
  return finding;
}

// Motion of half the size, enlarged: neighbours differ only from every other column on. Columns are counted, not
// pixels, since one straight rim tells no more than one pixel of it.
Finding find_resolution(const Scene& scene) {
  Finding finding = {.subject = "velocity's size", .says = "the frame's"};
  std::size_t differ[2] = {};
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.velocity.empty()) continue;
    for (int x = 0; x + 1 < frame.render.width; ++x) {
      bool differs = false;
      for (int y = 0; y < frame.render.height && !differs; ++y)
        differs = frame.velocity[pixel_of(frame, x, y)] != frame.velocity[pixel_of(frame, x + 1, y)];
      differ[x % 2] += differs ? 1 : 0;
    }
  }
  const std::size_t least = std::min(differ[0], differ[1]), most = std::max(differ[0], differ[1]);
  if (most < 40) return finding;
  finding.verdict = least * 20 < most ? Verdict::kWrong : Verdict::kRight;
  if (finding.verdict == Verdict::kRight) return finding;
  finding.faults = {"half"};
  finding.fits = "half of it, enlarged";
  finding.option = "write motion of the frame's own size";
  return finding;
}

// What stands still in the picture although the camera moves it.
Finding find_rest(const Scene& scene, const DepthGuess& guess) {
  constexpr float kFarDepth = 1e-9f;  // as far_velocity.cl has it
  constexpr float kLeastMotion = .25f;
  Finding finding = {.subject = "sky", .says = scene.input.sky_moves ? "moved" : "as drawn"};
  if (!scene.frames[0].world_to_ndc || scene.frames[0].depth.empty() || scene.frames[0].velocity.empty() ||
      scene.input.sky_moves)
    return finding;
  Votes votes;
  for (const Pair& pair : scene.pairs) {
    const DiagnosedFrame& frame = scene.frames[pair.now];
    const auto now = matrix_at(scene.frames, pair.now, guess.camera);
    const auto before = matrix_at(scene.frames, pair.now - 1, guess.camera);
    if (!now || !before) continue;
    const auto camera = camera_motion(*now, *before, scene.input.near_plane);
    if (!camera) continue;
    for (int y = 0; y < frame.render.height; y += 4) {
      for (int x = 0; x < frame.render.width; x += 4) {
        float depth[] = {frame.depth[pixel_of(frame, x, y)]};
        to_reversed_depth(guess.kind, scene.input.near_plane, depth);
        if (!(depth[0] <= kFarDepth)) continue;
        const Vec2 moved = camera_moves(*camera, {static_cast<float>(x) + .5f, static_cast<float>(y) + .5f},
                                        0, frame.render);
        if (!(std::hypot(moved.x, moved.y) > kLeastMotion)) continue;
        ++votes.all;
        votes.yes += frame.velocity[pixel_of(frame, x, y)] == Vec2{} ? 1 : 0;
      }
    }
  }
  if (votes.all < 50 || (votes.share() > .2 && votes.share() < .8)) return finding;
  finding.verdict = votes.share() >= .8 ? Verdict::kWrong : Verdict::kRight;
  finding.share = finding.verdict == Verdict::kWrong ? votes.share() : 1 - votes.share();
  if (finding.verdict == Verdict::kRight) return finding;
  finding.faults = {"at rest"};
  finding.fits = "0, although the camera turns";
  finding.option = "--sky-motion camera";
  return finding;
}

double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// The mean of a frame's light where there is any, in stops.
double brightness(const DiagnosedFrame& frame) {
  double sum = 0, count = 0;
  for (const float value : frame.luminance) {
    if (value > 1e-3f && value < 1e6f) sum += std::log2(value), count += 1;
  }
  return count > 0 ? sum / count : 0;
}

// How a frame follows from the last.
struct Step {
  std::int64_t number = 0;
  double stops = 0;        // by which the places are brighter
  double overall = 0;      // by which the picture is
  double agree = 0;        // part of the places that changed the same way
  double correlation = 0;  // between the light that was foretold and that which is seen
};

std::vector<Step> steps_of(const Scene& scene) {
  constexpr std::size_t kLeastPlaces = 200;
  constexpr double kDark = .02, kBright = .98;
  std::vector<Step> steps;
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    const Pair& pair = scene.pairs[p];
    const auto light =
        foretold_light(pair, scene.planes[pair.now - 1], scene.motion.motion[p], scene.motion.shift[p]);
    std::vector<double> stops;
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double x = light[i], y = pair.places[i].light;
      if (!(x > kDark && x < kBright && y > kDark && y < kBright)) continue;
      stops.push_back(std::log2(y * y / (1 - y * y) * (1 - x * x) / (x * x)));
      n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    if (stops.size() < kLeastPlaces) continue;
    const double change = middle(stops);
    const auto same = std::count_if(stops.begin(), stops.end(), [&](double s) { return s * change > 0; });
    const double spread = std::sqrt(std::max((aa - a * a / n) * (bb - b * b / n), 1e-12));
    steps.push_back({.number = scene.frames[pair.now].number,
                     .stops = change,
                     .overall = brightness(scene.frames[pair.now]) - brightness(scene.frames[pair.now - 1]),
                     .agree = static_cast<double>(same) / n,
                     .correlation = (ab - a * b / n) / spread});
  }
  return steps;
}

// Looks whether a frame follows from the last in brightness, and whether it does at all.
void find_light(const Scene& scene, std::vector<Finding>& findings, std::vector<std::int64_t>& cuts_before) {
  constexpr double kJump = .1;                       // stops
  constexpr double kFollows = .7, kIsAnother = .35;  // correlations
  const std::vector<Step> steps = steps_of(scene);
  Finding exposure = {.subject = "exposure", .says = "steady"}, cuts = {.subject = "cuts", .says = "marked"};
  std::vector<double> all, correlations;
  for (const Step& step : steps)
    all.push_back(step.stops), correlations.push_back(step.correlation);
  if (steps.size() >= 3 && middle(correlations) > kFollows) {
    exposure.verdict = cuts.verdict = Verdict::kRight;
    std::vector<std::string> jumps;
    std::vector<std::int64_t> unmarked;
    for (const Step& step : steps) {
      const double both = step.overall / step.stops;
      if (step.correlation < kIsAnother) {
        unmarked.push_back(step.number);
      } else if (std::abs(step.stops - middle(all)) > kJump && both > .5 && both < 2 && step.agree > .65) {
        jumps.push_back(fmt::format("{:+.2f} stops in frame {}", step.stops, step.number));
      }
    }
    if (!jumps.empty()) {
      exposure.verdict = Verdict::kWrong;
      exposure.faults = {"jump"};
      exposure.fits = fmt::format("{}", fmt::join(jumps, ", "));
      exposure.option = "write light before exposure";
    }
    if (!unmarked.empty()) {
      cuts.verdict = Verdict::kWrong;
      cuts.faults = {"unmarked"};
      cuts.fits = fmt::format("a cut before frame {}", fmt::join(unmarked, ", "));
      cuts.option = "attribute quincunx:reset = 1 there";
      cuts_before = unmarked;
    }
  }
  findings.push_back(exposure);
  findings.push_back(cuts);
}

// `cuts`: frames before which cuts are missing; that finding is the last.
Diagnosis examine(Frames frames, const DiagnosedInput& input, const std::vector<Plane>& planes,
                  const std::vector<Pair>& pairs, std::vector<std::int64_t>& cuts) {
  const MotionAnswer motion = find_motion(frames, input, planes, pairs);
  const Scene scene = {frames, input, planes, pairs, motion};
  Diagnosis diagnosis = {motion.findings, motion.mend};
  const DepthGuess depth = find_depth(scene, diagnosis.findings);
  if (!has_fault(motion.findings.front(), "frame"))  // which lies beside its surfaces
    diagnosis.findings.push_back(find_dilation(scene, depth.kind));
  diagnosis.findings.push_back(find_resolution(scene));
  diagnosis.findings.push_back(find_rest(scene, depth));
  find_light(scene, diagnosis.findings, cuts);
  return diagnosis;
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "right";
    case Verdict::kWrong:
      return "wrong";
    case Verdict::kUnknown:
      return "cannot tell";
  }
  return "";
}

Vec2 JitterMend::of(Vec2 told) const {
  return swapped ? Vec2{told.y * factors.x, told.x * factors.y}
                 : Vec2{told.x * factors.x, told.y * factors.y};
}

bool Diagnosis::wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.verdict == Verdict::kWrong; });
}

Diagnosis diagnose(Frames frames, const DiagnosedInput& input) {
  if (frames.empty()) return {};
  const std::vector<Plane> planes = planes_of(frames);
  std::vector<Pair> pairs = pairs_of(frames, planes);
  std::vector<std::int64_t> cuts;
  Diagnosis diagnosis = examine(frames, input, planes, pairs, cuts);
  if (cuts.empty()) return diagnosis;
  // Once more without what is no pair; that there are cuts remains.
  const Finding found = diagnosis.findings.back();
  std::erase_if(pairs, [&](const Pair& pair) {
    return std::find(cuts.begin(), cuts.end(), frames[pair.now].number) != cuts.end();
  });
  diagnosis = examine(frames, input, planes, pairs, cuts);
  diagnosis.findings.back() = found;
  return diagnosis;
}

}  // namespace quincunx::tools
