// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "tools/sequence/sequence_reader.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx::tools {
namespace {

constexpr int kFramesRead = 33;  // at half size the jitter of a still picture comes again after 32
constexpr std::int64_t kFramePixels = 700'000;  // in memory, from the middle of each frame
constexpr std::int64_t kAskedPixels = 65'536;   // of a frame, which are looked for in those before
constexpr int kTile = 16;                       // of such pixels
constexpr float kNearPlace = 1 / 16.f;          // pixels
constexpr float kNearDepth = 1 / 32.f;          // in parts
constexpr double kFewestPairs = 16;             // of a tile that counts
constexpr double kDark = .01;                   // of the mean light: such a tile does not count
constexpr double kFewestTiles = .7;             // of all: what moves before a still camera tells too little
// The noise of the tenth of the tiles that have least: clean scenes have up to .0014, Cycles at 16 samples .0049.
constexpr double kClean = .0025;

// A frame, or a part of it.
struct LitFrame {
  MotionSamples seen;        // depth may be empty
  std::vector<float> light;  // linear
  bool reset = false;        // motion leads to no frame before
};

struct Tile {
  double pairs = 0, squares = 0, light = 0;
};

// Where a pixel's sample lies in the frames before.
struct Walk {
  int x, y;    // pixel of the frame that was reached
  float u, v;  // the sample's place there, in pixels without jitter
  float depth;
};

std::size_t index_of(const MotionSamples& seen, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.render.width) +
         static_cast<std::size_t>(x);
}

float depth_at(const MotionSamples& seen, std::size_t index) {
  return seen.depth.empty() ? 1 : seen.depth[index];
}

// Goes one frame back, from a pixel of `from` to the one of `to` whose sample is next. False where there is none.
bool step_back(const LitFrame& from, const LitFrame& to, Walk& walk) {
  const MotionSamples &now = from.seen, &before = to.seen;
  const Vec2 velocity = now.velocity[index_of(now, walk.x, walk.y)];
  walk.u -= velocity.x * static_cast<float>(now.render.width);
  walk.v -= velocity.y * static_cast<float>(now.render.height);
  const float x = std::round(walk.u - before.jitter.x), y = std::round(walk.v - before.jitter.y);
  if (!(x >= 0 && y >= 0 && x < static_cast<float>(before.render.width) &&
        y < static_cast<float>(before.render.height)))
    return false;
  walk.x = static_cast<int>(x), walk.y = static_cast<int>(y);
  const float there = depth_at(before, index_of(before, walk.x, walk.y));
  return std::abs(there - walk.depth) <= kNearDepth * std::max(there, walk.depth);
}

// Calls visit(before, light there, light here) for each frame before that shows the place of a pixel's sample, too.
template <typename Visit>
void visit_pairs(std::span<const LitFrame> frames, std::size_t last, int x, int y, const Visit& visit) {
  const MotionSamples& seen = frames[last].seen;
  const std::size_t index = index_of(seen, x, y);
  const float here = frames[last].light[index];
  Walk walk = {x, y, static_cast<float>(x) + seen.jitter.x, static_cast<float>(y) + seen.jitter.y,
               depth_at(seen, index)};
  if (!(here >= 0 && walk.depth > 0)) return;  // no surface has no place
  for (std::size_t i = last; i > 0 && !frames[i].reset && step_back(frames[i], frames[i - 1], walk); --i) {
    const LitFrame& before = frames[i - 1];
    const float light = before.light[index_of(before.seen, walk.x, walk.y)];
    const float apart = std::hypot(walk.u - before.seen.jitter.x - static_cast<float>(walk.x),
                                   walk.v - before.seen.jitter.y - static_cast<float>(walk.y));
    if (apart <= kNearPlace && light >= 0) visit(i - 1, double{light}, double{here});
  }
}

// The light of one frame, and of an earlier one at the same places.
struct PairLight {
  double before = 0, here = 0;
};

// Compares all pairs of frames. The light of the whole picture may change, as it does in a fade.
std::vector<Tile> tiles_of(std::span<const LitFrame> frames) {
  const Extent render = frames.front().seen.render;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(render.area()) /
                                                                    static_cast<double>(kAskedPixels)))));
  const int columns = render.width / (kTile * step), rows = render.height / (kTile * step);
  std::vector<Tile> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    std::vector<PairLight> whole(i);
    const auto visit_all = [&](const auto& visit) {
      for (int y = 0; y < rows * kTile; ++y) {
        for (int x = 0; x < columns * kTile; ++x)
          visit(x * step, y * step, tiles[static_cast<std::size_t>(y / kTile * columns + x / kTile)]);
      }
    };
    visit_all([&](int x, int y, Tile&) {
      visit_pairs(frames, i, x, y, [&](std::size_t j, double before, double here) {
        whole[j].before += before;
        whole[j].here += here;
      });
    });
    visit_all([&](int x, int y, Tile& tile) {
      visit_pairs(frames, i, x, y, [&](std::size_t j, double before, double here) {
        if (!(whole[j].before > 0)) return;
        const double expected = before * whole[j].here / whole[j].before, difference = expected - here;
        ++tile.pairs;
        tile.squares += difference * difference / 2;
        tile.light += (expected + here) / 2;
      });
    });
  }
  return tiles;
}

// The middle of a frame, of at most kFramePixels.
LitFrame middle_of(const SequenceFrame& frame, const ScannedFrame& scanned) {
  const double part =
      std::min(1.0, std::sqrt(static_cast<double>(kFramePixels) / static_cast<double>(frame.render.area())));
  const Extent kept = {static_cast<int>(frame.render.width * part),
                       static_cast<int>(frame.render.height * part)};
  const int left = (frame.render.width - kept.width) / 2, top = (frame.render.height - kept.height) / 2;
  const Vec2 scale = {static_cast<float>(frame.render.width) / static_cast<float>(kept.width),
                      static_cast<float>(frame.render.height) / static_cast<float>(kept.height)};
  LitFrame lit = {.seen = {kept, scanned.jitter, {}, {}}, .light = {}, .reset = scanned.reset};
  for (int y = 0; y < kept.height; ++y) {
    for (int x = 0; x < kept.width; ++x) {
      const std::size_t index =
          static_cast<std::size_t>(top + y) * static_cast<std::size_t>(frame.render.width) +
          static_cast<std::size_t>(left + x);
      float rgb[3];
      std::memcpy(rgb, frame.texels[InputPlane::kColour].data() + index * 4 * sizeof(float), sizeof rgb);
      lit.light.push_back((rgb[0] + 2 * rgb[1] + rgb[2]) / 4);
      const Vec2 velocity = frame.velocity()[index];  // without jitter, as read_frame() gives it
      lit.seen.velocity.push_back({velocity.x * scale.x, velocity.y * scale.y});
      if (!frame.depth().empty()) lit.seen.depth.push_back(frame.depth()[index]);
    }
  }
  return lit;
}

// Returns what noise_of() does, of frames that follow one another. What counts is how far samples of different frames
// are apart that show, by motion, the same place of a surface to within a sixteenth of a pixel: texture and aliasing
// are the same in both. Changes of the whole picture's light are taken off. Frames are noisy where nine tenths of the
// picture are; then it is the noise that a fifth of it exceeds.
float noise_between(std::span<const LitFrame> frames) {
  if (frames.empty()) return 0;
  const std::vector<Tile> tiles = tiles_of(frames);
  double light = 0, pairs = 0;
  for (const Tile& tile : tiles)
    light += tile.light, pairs += tile.pairs;
  std::vector<double> parts;
  for (const Tile& tile : tiles) {
    const double mean = tile.light / std::max(tile.pairs, 1.0);
    if (tile.pairs >= kFewestPairs && mean > kDark * light / pairs)
      parts.push_back(tile.squares / tile.pairs / (mean * mean));
  }
  if (parts.empty() || static_cast<double>(parts.size()) < kFewestTiles * static_cast<double>(tiles.size()))
    return 0;
  std::sort(parts.begin(), parts.end());
  if (parts[parts.size() / 10] <= kClean) return 0;
  return static_cast<float>(std::min(parts[parts.size() * 4 / 5], 1.0));
}

}  // namespace

std::optional<float> noise_of(const FramePattern& pattern, const SequenceFormat& format) {
  if (format.motion != MotionSource::kChannels) return 0;
  auto numbers = pattern.frames_on_disk();
  if (!numbers.ok() || numbers->size() < kFramesRead) return std::nullopt;
  numbers->resize(kFramesRead);
  if (numbers->back() - numbers->front() >= kFramesRead) return std::nullopt;
  const SequenceScan scan = scan_sequence(pattern, format, numbers.value(), numbers.value(), 1);
  std::vector<LitFrame> frames;
  SequenceFrame read;
  for (const ScannedFrame& scanned : scan.frames) {
    if (!scanned.problem.empty() || scanned.render != scan.frames.front().render) return std::nullopt;
    if (!read_frame(pattern.expand(scanned.number), format, scanned, PixelFormat::kRGBA32F, read).ok())
      return std::nullopt;
    frames.push_back(middle_of(read, scanned));
  }
  return noise_between(frames);
}

}  // namespace quincunx::tools
