// SPDX-License-Identifier: MIT
// exposure: what a frame's light is multiplied by. Luma's mean is that over 32 x 16 blocks, each at most 256 times the
// geometric mean.
#include <algorithm>
#include <cmath>
#include <vector>

#include "temporal.h"

namespace quincunx::reference {
namespace {

constexpr int kColumns = 32, kRows = 16;
constexpr int kTexelsMax = 8;         // of a block on each axis; half of them after a frame with a factor
constexpr double kExposedMean = .16;  // found by search on the built-in scenes
constexpr double kBlockMeanMax = 256;
constexpr double kSteadyOctaves = .75;
constexpr double kBrightest = 65504 - 0x1p-8;  // the largest float below the largest half

struct Block {
  double sum = 0;
  int count = 0;
};

// Returns the mean of luma; 0 where there is no light.
double mean_light(const Frame& frame, int part) {
  const int across = std::max(std::clamp(frame.width / kColumns, 1, kTexelsMax) / part, 1);
  const int down = std::max(std::clamp(frame.height / kRows, 1, kTexelsMax) / part, 1);
  std::vector<Block> blocks(kColumns * kRows);
  double logs = 0;
  int count = 0;
  for (int j = 0; j < kRows * down; ++j) {
    for (int i = 0; i < kColumns * across; ++i) {
      const Pixel& c = texel_at(frame, (2 * i + 1) * frame.width / (2 * kColumns * across),
                                (2 * j + 1) * frame.height / (2 * kRows * down));
      const double luma = .25 * (c[0] + c[2]) + .5 * c[1];
      if (!(luma >= 0x1p-126 && luma < 0x1p127)) continue;
      Block& block = blocks[index_of(kColumns, i / across, j / down)];
      block.sum += std::min(luma, 0x1p110);
      ++block.count;
      logs += std::log2(luma);
      ++count;
    }
  }
  double sum = 0;
  for (const Block& block : blocks)
    sum += std::min(block.sum, kBlockMeanMax * std::exp2(logs / count) * block.count);
  return count > 0 ? sum / count : 0;
}

}  // namespace

double exposure_of(const Frame& frame, double given, double before, double wanted_before) {
  const double mean = given > 0 ? 0 : mean_light(frame, before > 0 ? 2 : 1);
  if (given <= 0 && mean == 0) return before > 0 ? before : 1;
  const double wanted = std::clamp(given > 0 ? given : kExposedMean / mean, 0x1p-60, 0x1p60);
  if (before <= 0) return wanted;
  const double octaves = std::log2(wanted / before), octaves_before = std::log2(wanted_before / before);
  const bool is_steady = std::min(std::abs(octaves), std::abs(octaves_before)) <= kSteadyOctaves;
  if (is_steady || octaves * octaves_before < 0) return before;
  return before * std::exp2(std::round(octaves));
}

Frame exposed(Frame frame, double factor) {
  for (Pixel& pixel : frame.colour) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double value = pixel[c] * (c < 3 ? factor : 1);
      pixel[c] = value > kBrightest ? kBrightest : value;
    }
  }
  return frame;
}

}  // namespace quincunx::reference
