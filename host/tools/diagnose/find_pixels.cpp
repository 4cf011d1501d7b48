// SPDX-License-Identifier: MIT
// What single pixels tell of motion: dilated, of half the size, at rest.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

// Votes of pixels: how many say yes, of those that say anything.
struct Votes {
  std::size_t yes = 0;
  std::size_t all = 0;

  double share() const { return all > 0 ? static_cast<double>(yes) / static_cast<double>(all) : 0; }
};

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

}  // namespace quincunx::tools
