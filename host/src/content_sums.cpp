// SPDX-License-Identifier: MIT
#include "content_sums.h"

namespace quincunx {
namespace {

constexpr double kSpeedUnits = 16;  // of ContentSums::speed, an output pixel

}  // namespace

Extent content_tiles(Extent output) {
  return {(output.width + kContentTile - 1) / kContentTile,
          (output.height + kContentTile - 1) / kContentTile};
}

ContentStatistics statistics_of(const ContentSums& sums, Extent output) {
  constexpr int kSamples = kContentSamples * kContentSamples;
  const auto all = static_cast<double>(content_tiles(output).area() * kSamples);
  ContentStatistics content;
  content.moving = sums.moving / all;
  if (sums.moving > 0) content.speed_px = sums.speed / kSpeedUnits / sums.moving;
  content.apart = sums.apart / all;
  content.thin = sums.thin / all;
  content.light = sums.light / all;
  content.zoom = sums.zoom / all;
  return content;
}

}  // namespace quincunx
