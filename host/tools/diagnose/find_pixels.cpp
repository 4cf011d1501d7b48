// SPDX-License-Identifier: MIT
// What single pixels tell of motion: dilated, of half the size, at rest where something moves.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

// What `better` chooses of the 3x3 pixels about each that is not at the border.
template <typename Better>
std::vector<float> of_3x3(const std::vector<float>& values, std::size_t width, Better better) {
  std::vector<float> across = values;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    across[i] = better(better(values[i - 1], values[i]), values[i + 1]);
  std::vector<float> chosen = across;
  for (std::size_t i = width; i + width < values.size(); ++i)
    chosen[i] = better(better(across[i - width], across[i]), across[i + width]);
  return chosen;
}

constexpr auto nearer = [](float a, float b) { return b > a ? b : a; };
constexpr auto farther = [](float a, float b) { return b < a ? b : a; };

// Depths of a frame, reversed, and the nearest and farthest of the 3x3 about each.
struct Depths {
  std::vector<float> own = {};
  std::vector<float> nearest = {};
  std::vector<float> farthest = {};
};

Depths depths_of(const Scene& scene, const DiagnosedFrame& frame, DepthKind kind) {
  const auto width = static_cast<std::size_t>(frame.render.width);
  Depths depths = {.own = reversed_depth(frame, kind, scene.input.near_plane)};
  depths.nearest = of_3x3(depths.own, width, nearer);
  depths.farthest = of_3x3(depths.own, width, farther);
  return depths;
}

// Pixels of one pair's later frame.
struct Rest {
  std::size_t moving = 0;  // by themselves
  std::size_t sudden =
      0;  // at rest by their motion, yet not there before: all depths about that place were farther
  std::size_t thin = 0;  // the same of lines that a frame's samples may miss
  std::size_t lost = 0;  // at rest by their motion, yet in one other frame of all at most
};

// A point of a frame, and its depth, reversed.
struct Point {
  Vec2 at;
  float depth;
};

Point reprojected(const CameraMotion& camera, const Point& point, Extent extent) {
  const auto& m = camera.clip_to_previous_clip;
  const Vec2 moved = camera_moves(camera, point.at, point.depth, extent);
  const float x = 2 * point.at.x / static_cast<float>(extent.width) - 1;
  const float y = 1 - 2 * point.at.y / static_cast<float>(extent.height);
  const float w = m[3] * x + m[7] * y + m[11] * point.depth + m[15];
  return {{point.at.x - moved.x, point.at.y - moved.y},
          (m[2] * x + m[6] * y + m[10] * point.depth + m[14]) / w};
}

// A frame of the same shot as another.
struct Look {
  std::size_t frame;
  CameraMotion camera;  // from the other to it
};

// Whether that, or something before it, is about a point of a frame; nothing at the picture's border.
std::optional<bool> is_there(const Scene& scene, const std::vector<Depths>& depths, std::size_t frame,
                             const Point& point) {
  constexpr float kFarther = .85f;
  const Extent extent = scene.frames[frame].render;
  const Vec2 jitter = scene.motion.jitter[frame];
  const float x = std::floor(point.at.x - jitter.x), y = std::floor(point.at.y - jitter.y);
  if (!(x >= 1 && y >= 1 && x + 1 < static_cast<float>(extent.width) &&
        y + 1 < static_cast<float>(extent.height)))
    return std::nullopt;
  const std::size_t pixel = pixel_of(scene.frames[frame], static_cast<int>(x), static_cast<int>(y));
  return depths[frame].nearest[pixel] >= kFarther * point.depth;
}

// Whether a point is in one other frame at most, of enough.
bool is_lost(const Scene& scene, const std::vector<Depths>& depths, const std::vector<Look>& looks,
             const Point& point, bool zero, Extent extent) {
  constexpr int kEnough = 8;
  int seen = 0, looked = 0;
  for (const Look& look : looks) {
    const auto there =
        is_there(scene, depths, look.frame, zero ? point : reprojected(look.camera, point, extent));
    if (!there) continue;
    ++looked;
    seen += *there ? 1 : 0;
    if (seen > 1) return false;
  }
  return looked >= kEnough;
}

// The frames of a pair's shot, the one before first; none where that is not known.
std::vector<Look> looks_of(const Scene& scene, const Pair& pair, const DepthGuess& guess) {
  std::vector<Look> looks;
  const auto add = [&](std::size_t other, int back) {
    const DiagnosedFrame &frame = scene.frames[pair.now], &there = scene.frames[other];
    const auto camera = camera_of(scene, pair, guess, back);
    const bool known = camera && there.render == frame.render && !there.depth.empty() && !frame.depth.empty();
    if (known) looks.push_back({other, *camera});
    return known;
  };
  for (std::size_t f = pair.now; follows(scene.frames, f) && add(f - 1, static_cast<int>(pair.now - f) + 1);
       --f)
    continue;
  if (looks.empty()) return looks;
  for (std::size_t f = pair.now + 1; follows(scene.frames, f) && add(f, -static_cast<int>(f - pair.now)); ++f)
    continue;
  return looks;
}

// Looks at pixels whose motion is that of what is at rest: the camera's, or exactly 0. `looks`: frames of the same
// shot, the one before first. Surfaces of 3x3 pixels are in that one; lines may be missed there, yet hardly in all.
Rest rest_of(const Scene& scene, const Pair& pair, const std::vector<Look>& looks,
             const std::vector<Depths>& depths) {
  constexpr float kApart = .1f, kMoves = .5f;  // pixels
  constexpr float kAlike = 1.05f, kNearer = 1.3f;
  constexpr int kLine = 3;  // of 3x3 pixels
  const DiagnosedFrame& frame = scene.frames[pair.now];
  const std::vector<float>& now = depths[pair.now].own;
  const int width = frame.render.width, height = frame.render.height;
  const Vec2 jitter = scene.motion.jitter[pair.now];
  const auto alike_about = [&](int x, int y) {
    const float depth = now[pixel_of(frame, x, y)];
    int count = 0;
    for (int j = y - 1; j <= y + 1; ++j) {
      for (int i = x - 1; i <= x + 1; ++i) {
        const float other = now[pixel_of(frame, i, j)];
        count += other <= kAlike * depth && depth <= kAlike * other ? 1 : 0;
      }
    }
    return count;
  };
  Rest rest;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const std::size_t pixel = pixel_of(frame, x, y);
      const float depth = now[pixel], least = depths[pair.now].farthest[pixel];
      const float most = depths[pair.now].nearest[pixel];
      const bool surface = least > 0 && most <= kAlike * least;
      if (!surface && !(depth > kNearer * least)) continue;
      const Point point = {{static_cast<float>(x) + .5f + jitter.x, static_cast<float>(y) + .5f + jitter.y},
                           depth};
      const Vec2 moved = camera_moves(looks[0].camera, point.at, depth, frame.render);
      const Vec2 own = own_motion(scene, pair, x, y);
      const bool zero = frame.velocity[pixel] == Vec2{};
      const float apart = square(difference(own, moved));
      rest.moving += surface && apart > kMoves * kMoves && !zero ? 1 : 0;
      if (!zero && !(scene.motion.knows_motion && apart < kApart * kApart)) continue;
      if (surface) {
        const Point before = {{point.at.x - own.x, point.at.y - own.y},
                              zero ? depth : reprojected(looks[0].camera, point, frame.render).depth};
        rest.sudden += is_there(scene, depths, looks[0].frame, before).value_or(true) ? 0 : 1;
      } else if (alike_about(x, y) >= kLine) {
        ++rest.thin;
        rest.lost += is_lost(scene, depths, looks, point, zero, frame.render) ? 1 : 0;
      }
    }
  }
  return rest;
}

// Whether two pixels beside each other move otherwise, in whatever unit.
bool other_motion(Vec2 a, Vec2 b) {
  constexpr float kOther = .3f;  // of the faster
  return square(difference(a, b)) > kOther * kOther * std::max(square(a), square(b));
}

// Whether surfaces of two depths meet between each pixel and the one to its right, and the one below: as drawn, and
// where the nearest of 3x3 counts.
std::array<std::vector<char>, 2> rims_of(const DiagnosedFrame& frame, const DiagnosedInput& input) {
  constexpr float kOther = 1.1f;
  std::array<std::vector<char>, 2> rims;
  if (frame.depth.empty()) return rims;
  std::vector<float> depth = reversed_depth(frame, input.depth_kind, input.near_plane);
  const auto width = static_cast<std::size_t>(frame.render.width);
  for (std::vector<char>& rim : rims) {
    rim.resize(2 * (depth.size() - width));
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const float a = depth[i / 2], b = depth[i / 2 + (i % 2 == 0 ? 1 : width)];
      rim[i] = a > kOther * b || b > kOther * a ? 1 : 0;
    }
    depth = of_3x3(depth, width, nearer);
  }
  return rims;
}

}  // namespace

Lateness find_lateness(std::span<const DiagnosedFrame> frames, const DiagnosedInput& input) {
  constexpr std::size_t kLeast = 100;
  constexpr double kMost = .8, kMore = 1.3;  // of the votes; over the other frames' rims
  // Surfaces of the last frame, this and the next; each as drawn and dilated.
  std::array<std::array<std::size_t, 2>, 3> ends = {};
  std::array<std::array<Votes, 2>, 3> votes = {};  // where this frame's and that one's rims differ
  std::vector<std::array<std::vector<char>, 2>> rims;
  for (const DiagnosedFrame& frame : frames)
    rims.push_back(rims_of(frame, input));
  for (std::size_t f = 1; f + 1 < frames.size(); ++f) {
    const DiagnosedFrame& frame = frames[f];
    if (!follows(frames, f) || !follows(frames, f + 1) || frame.velocity.empty() ||
        rims[f - 1][0].size() != rims[f][0].size() || rims[f + 1][0].size() != rims[f][0].size())
      continue;
    const auto width = static_cast<std::size_t>(frame.render.width);
    for (std::size_t i = 0; i < rims[f][0].size(); ++i) {
      if (!other_motion(frame.velocity[i / 2], frame.velocity[i / 2 + (i % 2 == 0 ? 1 : width)])) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t d = 0; d < 2; ++d) {
          const bool here = rims[f + k - 1][d][i] != 0;
          ends[k][d] += here ? 1 : 0;
          if (here == (rims[f][d][i] != 0)) continue;
          votes[k][d].add(here);
        }
      }
    }
  }
  const auto most = [&](std::size_t k) { return static_cast<double>(std::max(ends[k][0], ends[k][1])); };
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
    const Votes& vote = votes[k][ends[k][1] > ends[k][0] ? 1 : 0];
    if (vote.all >= kLeast && vote.share() >= kMost && most(k) > kMore * most(1) &&
        most(k) > kMore * most(2 - k))
      return {.known = true, .later = k == 0 ? 1 : -1, .share = vote.share()};
  }
  const Votes& last = votes[0][ends[1][1] > ends[1][0] ? 1 : 0];
  return {.known = last.all >= kLeast && last.share() <= 1 - kMost && most(1) > kMore * most(0) &&
                   most(1) > kMore * most(2)};
}

Finding find_dilation(const Scene& scene, DepthKind kind) {
  Finding finding = {.subject = "dilation", .says = scene.input.dilated ? "dilated" : "own"};
  Votes votes;
  for (const DiagnosedFrame& frame : scene.frames) {
    if (frame.velocity.empty() || frame.depth.empty()) continue;
    const std::vector<float> depth = reversed_depth(frame, kind, scene.input.near_plane);
    const auto vote = [&](std::size_t near, std::size_t middle, std::size_t far) {
      if (!(depth[near] > 1.1f * depth[middle]) || depth[middle] > 1.05f * depth[far] ||
          depth[far] > 1.05f * depth[middle])
        return;
      const Vec2 n = frame.velocity[near], m = frame.velocity[middle], f = frame.velocity[far];
      if (!other_motion(n, f)) return;
      const float room = .01f * square(difference(n, f));
      const bool as_near = square(difference(m, n)) < room, as_far = square(difference(m, f)) < room;
      if (as_near == as_far) return;
      votes.add(as_near);
    };
    for (int y = 1; y + 1 < frame.render.height; ++y) {
      for (int x = 1; x + 1 < frame.render.width; ++x) {
        const std::size_t at = pixel_of(frame, x, y), row = static_cast<std::size_t>(frame.render.width);
        vote(at - 1, at, at + 1), vote(at + 1, at, at - 1), vote(at - row, at, at + row),
            vote(at + row, at, at - row);
      }
    }
  }
  if (!votes.agree(100, .2)) return finding;
  const bool dilated = votes.most();
  return judged(finding, dilated != scene.input.dilated, votes.agreed(), dilated ? "dilated" : "not dilated",
                dilated ? "that of the nearest of 3x3" : "each pixel's own",
                dilated ? "--drawn-velocity dilated" : "--drawn-velocity own");
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
  return judged(finding, least * 20 < most, 0, "half", "half of it, enlarged",
                "write motion of the frame's own size");
}

Finding find_sky(const Scene& scene, const DepthGuess& guess) {
  constexpr float kFarDepth = 1e-9f;  // as far_velocity.cl has it
  constexpr float kLeastMotion = .25f;
  Finding finding = {.subject = "sky", .says = scene.input.sky_moves ? "moved" : "as drawn"};
  if (!scene.form.transposed || scene.frames[0].depth.empty() || scene.frames[0].velocity.empty() ||
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
        votes.add(frame.velocity[pixel_of(frame, x, y)] == Vec2{});
      }
    }
  }
  if (!votes.agree(50, .2)) return finding;
  return judged(finding, votes.most(), votes.agreed(), "at rest", "0, although the camera turns",
                "--sky-motion camera");
}

Finding find_objects(const Scene& scene, const DepthGuess& guess, bool coarse) {
  constexpr double kLeastPart = 2e-4, kFew = 2e-5;  // of a picture's pixels
  constexpr double kLost = .04;                     // of thin ones: still wires thinner than a pixel lose .01
  Finding finding = {.subject = "objects", .says = "as drawn"};
  if (scene.motion.guess.later != 0) return finding;
  std::vector<Depths> depths;
  for (const DiagnosedFrame& frame : scene.frames)
    depths.push_back(depths_of(scene, frame, guess.kind));
  double moving = 0, sudden = 0, pixels = 0;
  Votes votes;
  for (const Pair& pair : scene.pairs) {
    const DiagnosedFrame& frame = scene.frames[pair.now];
    const std::vector<Look> looks = looks_of(scene, pair, guess);
    if (looks.empty() || frame.velocity.empty()) continue;
    const Rest rest = rest_of(scene, pair, looks, depths);
    const auto area = static_cast<double>(frame.render.area());
    moving += static_cast<double>(rest.moving);
    sudden += static_cast<double>(rest.sudden);
    pixels += area;
    const auto lost = static_cast<double>(rest.lost);
    const bool lines = !coarse && lost > kLeastPart * area && lost > kLost * static_cast<double>(rest.thin);
    votes.add(lines || static_cast<double>(rest.sudden) > kLeastPart * area);
  }
  if (votes.all < 2) return finding;
  const bool wrong = votes.share() > .6;
  if (!wrong && !(scene.motion.knows_motion && moving > .005 * pixels && sudden < kFew * pixels))
    return finding;
  return judged(finding, wrong, wrong ? votes.share() : 1 - votes.share(), "at rest",
                "some move by themselves, with the motion of what is at rest",
                "write the motion of everything that moves");
}

}  // namespace quincunx::tools
