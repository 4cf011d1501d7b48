// SPDX-License-Identifier: MIT
#include "tools/page/report_pictures.h"

#include <algorithm>
#include <cmath>

#include "tools/image/flip.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {
namespace {

constexpr Extent kLargestCrop{640, 360};
constexpr const char* kGhosts = "ghosts";
constexpr float kChangeGain = 4;  // of maps of change, whose values are small

void begin(ReportPictures& pictures, const JudgedFrame& frame) {
  const Extent extent = frame.picture.extent();
  pictures.crop = {std::min(extent.width, kLargestCrop.width), std::min(extent.height, kLargestCrop.height)};
  const WorstWindow worst = worst_window(frame.picture, frame.truth);
  const int half = kWindowSide / 2;
  pictures.x = std::clamp(worst.x + half - pictures.crop.width / 2, 0, extent.width - pictures.crop.width);
  pictures.y = std::clamp(worst.y + half - pictures.crop.height / 2, 0, extent.height - pictures.crop.height);
  pictures.kinds = {{"truth"}, {"picture"}, {"error", true}, {"flicker", true}};
  if (!frame.motion.velocity.empty()) pictures.kinds.push_back({kGhosts, true});
}

Result<std::vector<std::uint8_t>> cropped(const ReportPictures& pictures, Extent extent, int channels,
                                          std::span<const float> values, float gain) {
  std::vector<std::uint8_t> texels;
  for (int y = pictures.y; y < pictures.y + pictures.crop.height; ++y) {
    const std::size_t first = (static_cast<std::size_t>(y) * extent.width + pictures.x) * channels;
    for (const float value : values.subspan(first, static_cast<std::size_t>(pictures.crop.width) * channels))
      texels.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(value * gain, 0.f, 1.f) * 255)));
  }
  return encode_png(pictures.crop, channels, texels);
}

}  // namespace

Status add_frame(ReportPictures& pictures, std::int64_t index, const JudgedFrame& frame) {
  if (pictures.frames.empty()) begin(pictures, frame);
  const Extent extent = frame.picture.extent();
  ReportPictures::Frame made = {index, {}};
  Status status;
  const auto add = [&](int channels, std::span<const float> values, float gain) {
    auto png = cropped(pictures, extent, channels, values, gain);
    if (!png.ok()) {
      status = png.status();
    } else {
      made.pngs.push_back(std::move(png).value());
    }
  };
  const std::vector<float> none(frame.picture.luma().size(), 0.f);
  const bool follows = frame.previous != nullptr && frame.previous_truth != nullptr;
  add(3, frame.truth.tone_mapped(), 1);
  add(3, frame.picture.tone_mapped(), 1);
  add(1, flip_map(extent, frame.picture.tone_mapped(), frame.truth.tone_mapped()), 1);
  add(1, follows ? flicker_map(frame.picture, *frame.previous, frame.truth, *frame.previous_truth) : none,
      kChangeGain);
  if (pictures.kinds.back().name == kGhosts) {
    const bool known = follows && !frame.motion.velocity.empty();
    add(1, known ? ghost_map(frame.picture, *frame.previous, frame.motion) : none, kChangeGain);
  }
  if (status.ok()) pictures.frames.push_back(std::move(made));
  return status;
}

}  // namespace quincunx::tools
