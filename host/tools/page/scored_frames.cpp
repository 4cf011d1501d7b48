// SPDX-License-Identifier: MIT
#include "tools/page/scored_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/image/flip.h"

namespace quincunx::tools {
namespace {

constexpr int kSmallestSide = 11;  // of SSIM's window

}  // namespace

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
