// SPDX-License-Identifier: MIT
// What single pixels tell of motion: dilated, of half the size, at rest where something moves.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

// Votes of pixels: how many say yes, of those that say anything.
struct Votes {
  std::size_t yes = 0;
  std::size_t all = 0;

  double share() const { return all > 0 ? static_cast<double>(yes) / static_cast<double>(all) : 0; }
};

// Depths of a frame, reversed.
std::vector<float> reversed(const Scene& scene, std::size_t frame, DepthKind kind) {
  std::vector<float> depth = scene.frames[frame].depth;
  to_reversed_depth(kind, scene.input.near_plane, depth);
  return depth;
}

// The least and the most of the 3x3 pixels about one that is not at the border.
std::pair<float, float> range_about(const std::vector<float>& values, int width, int x, int y) {
  float least = values[static_cast<std::size_t>(y * width + x)], most = least;
  for (int j = y - 1; j <= y + 1; ++j) {
    for (int i = x - 1; i <= x + 1; ++i) {
      const float value = values[static_cast<std::size_t>(j * width + i)];
      least = std::min(least, value), most = std::max(most, value);
    }
  }
  return {least, most};
}

// Pixels of one pair's later frame.
struct Rest {
  std::size_t moving = 0;  // by themselves
  std::size_t sudden =
      0;  // at rest by their motion, yet not there before: all depths about that place were farther
};

// Looks at pixels whose motion is that of what is at rest: the camera's, or exactly 0.
Rest rest_of(const Scene& scene, const Pair& pair, const CameraMotion& camera, DepthKind kind) {
  constexpr float kApart = .1f, kMoves = .5f;  // pixels
  constexpr float kAlike = 1.05f, kFarther = .85f;
  const DiagnosedFrame& frame = scene.frames[pair.now];
  const std::vector<float> now = reversed(scene, pair.now, kind);
  const std::vector<float> before = reversed(scene, pair.now - 1, kind);
  const int width = frame.render.width, height = frame.render.height;
  const Vec2 jitter = scene.motion.jitter[pair.now], last = scene.motion.jitter[pair.now - 1];
  const auto& m = camera.clip_to_previous_clip;
  Rest rest;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const auto [least, most] = range_about(now, width, x, y);
      if (!(least > 0 && most <= kAlike * least)) continue;
      const float depth = now[pixel_of(frame, x, y)];
      const Vec2 at = {static_cast<float>(x) + .5f + jitter.x, static_cast<float>(y) + .5f + jitter.y};
      const Vec2 moved = camera_moves(camera, at, depth, frame.render);
      const Vec2 own = own_motion(scene, pair, x, y);
      const bool zero = frame.velocity[pixel_of(frame, x, y)] == Vec2{};
      const float apart = std::hypot(own.x - moved.x, own.y - moved.y);
      rest.moving += apart > kMoves && !zero ? 1 : 0;
      if (!zero && !(scene.motion.knows_motion && apart < kApart)) continue;
      const int px = static_cast<int>(std::floor(at.x - own.x - last.x));
      const int py = static_cast<int>(std::floor(at.y - own.y - last.y));
      if (px < 1 || py < 1 || px + 1 >= width || py + 1 >= height) continue;
      const float cx = 2 * at.x / static_cast<float>(width) - 1,
                  cy = 1 - 2 * at.y / static_cast<float>(height);
      const float w = m[3] * cx + m[7] * cy + m[11] * depth + m[15];
      const float expected = zero ? depth : (m[2] * cx + m[6] * cy + m[10] * depth + m[14]) / w;
      rest.sudden += range_about(before, width, px, py).second < kFarther * expected ? 1 : 0;
    }
  }
  return rest;
}

}  // namespace

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

Finding find_sky(const Scene& scene, const DepthGuess& guess) {
  constexpr float kFarDepth = 1e-9f;  // as far_velocity.cl has it
  constexpr float kLeastMotion = .25f;
  Finding finding = {.subject = "sky", .says = scene.input.sky_moves ? "moved" : "as drawn"};
  if (!scene.frames[0].world_to_ndc || scene.frames[0].depth.empty() || scene.frames[0].velocity.empty() ||
      scene.input.sky_moves)
    return finding;
  Votes votes;
  for (const Pair& pair : scene.pairs) {
    const DiagnosedFrame& frame = scene.frames[pair.now];
    const auto camera = camera_of(scene, pair, guess);
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

Finding find_objects(const Scene& scene, const DepthGuess& guess) {
  constexpr double kLeastPart = 2e-4, kFew = 2e-5;  // of a picture's pixels
  Finding finding = {.subject = "objects", .says = "as drawn"};
  if (scene.motion.guess.later != 0) return finding;
  double moving = 0, sudden = 0, pixels = 0;
  Votes votes;
  for (const Pair& pair : scene.pairs) {
    const DiagnosedFrame& frame = scene.frames[pair.now];
    const auto camera = camera_of(scene, pair, guess);
    if (!camera || frame.depth.empty() || frame.velocity.empty() ||
        scene.frames[pair.now - 1].render != frame.render)
      continue;
    const Rest rest = rest_of(scene, pair, *camera, guess.kind);
    const auto area = static_cast<double>(frame.render.area());
    moving += static_cast<double>(rest.moving);
    sudden += static_cast<double>(rest.sudden);
    pixels += area;
    ++votes.all;
    votes.yes += static_cast<double>(rest.sudden) > kLeastPart * area ? 1 : 0;
  }
  if (votes.all < 2) return finding;
  if (votes.share() > .6) {
    finding.verdict = Verdict::kWrong;
    finding.share = votes.share();
    finding.faults = {"at rest"};
    finding.fits = "some move by themselves, with the motion of what is at rest";
    finding.option = "write the motion of everything that moves";
  } else if (moving > .005 * pixels && sudden < kFew * pixels) {
    finding.verdict = Verdict::kRight;
    finding.share = 1 - votes.share();
  }
  return finding;
}

}  // namespace quincunx::tools
