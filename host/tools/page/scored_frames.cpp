// SPDX-License-Identifier: MIT
#include "tools/page/scored_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/image/image_io.h"
#include "tools/image/image_metrics.h"

namespace quincunx::tools {
namespace {

constexpr Extent kLargestCrop{640, 360};
constexpr const char* kGhosts = "ghosts";
constexpr float kChangeGain = 4;  // factor for maps of change, whose values are small

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

constexpr int kSmallestSide = 11;  // size of SSIM's window

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

ScoredFrames::ScoredFrames(std::span<const std::int64_t> frames, bool keep_pictures) {
  const std::size_t count = keep_pictures ? std::min(frames.size(), kMostPictures) : 0;
  for (std::size_t i = 1; i <= count; ++i)
    kept_.push_back(frames[i * frames.size() / count - 1]);
}

Status ScoredFrames::check(Extent output, const std::string& option) {
  if (output.width >= kSmallestSide && output.height >= kSmallestSide) return {};
  return Status::invalid(fmt::format("{0} needs an output of at least {1}x{1} pixels; this is {2}x{3}",
                                     option, kSmallestSide, output.width, output.height));
}

bool ScoredFrames::keeps(std::int64_t frame) const {
  return std::binary_search(kept_.begin(), kept_.end(), frame);
}

Status ScoredFrames::add(std::int64_t frame, MeasuredPicture picture, MeasuredPicture truth,
                         const MotionField& motion) {
  Measured now = {frame, std::move(picture), std::move(truth)};
  const PictureScores scores = measure(now.picture, now.truth);
  ScoreRow row = {.index = frame,
                  .psnr_linear = scores.psnr_linear,
                  .psnr_tone_mapped = scores.psnr_tone_mapped,
                  .ssim = scores.ssim,
                  .flip = scores.flip,
                  .error_p99 = scores.error_p99};
  const bool follows = before_ && before_->frame + 1 == frame;
  if (follows) row.flicker = flicker(now.picture, before_->picture, now.truth, before_->truth);
  rows_.push_back(row);
  if (keeps(frame)) {
    const JudgedFrame judged = {.picture = now.picture,
                                .truth = now.truth,
                                .previous = follows ? &before_->picture : nullptr,
                                .previous_truth = follows ? &before_->truth : nullptr,
                                .motion = motion};
    if (Status status = add_frame(pictures_, frame, judged); !status.ok()) return status;
  }
  before_ = std::move(now);
  return {};
}

void ScoredFrames::repeat(const MeasuredPicture& truth) {
  if (!before_) return;
  const std::vector<float> map =
      flip_map(truth.extent(), before_->picture.tone_mapped(), truth.tone_mapped());
  rows_.back().repeated_flip.push_back(flip_mean(map));
}

}  // namespace quincunx::tools
