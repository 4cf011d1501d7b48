// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_quality.h"

#include <algorithm>
#include <cmath>

namespace quincunx::bench {
namespace {

double squared_error_of(double decibels) {
  return std::pow(10, -decibels / 10);  // 0 for an infinite ratio
}

double pixel_error(const tools::MeasuredPicture& picture, const tools::MeasuredPicture& truth,
                   std::size_t i) {
  double sum = 0;
  for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
    const double difference = double{picture.tone_mapped()[c]} - double{truth.tone_mapped()[c]};
    sum += difference * difference;
  }
  return sum / 3;
}

}  // namespace

void QualityTally::add(tools::MeasuredPicture picture, const tools::MeasuredPicture& truth,
                       const tools::MeasuredPicture* previous_truth, const FrameMasks& masks) {
  const tools::PictureScores scores = tools::measure(picture, truth);
  error_ += squared_error_of(scores.psnr_tone_mapped);
  error_linear_ += squared_error_of(scores.psnr_linear);
  ssim_ += scores.ssim;
  flip_ += scores.flip;
  p99_ += scores.error_p99;
  relative_ += scores.relative_error;
  non_finite_ += scores.non_finite;
  if (frames_ == 0 || scores.worst_window.error > worst_.worst_window) {
    worst_.worst_window = scores.worst_window.error;
    worst_.worst_frame = frames_;
    worst_.worst_x = scores.worst_window.x;
    worst_.worst_y = scores.worst_window.y;
  }
  if (latest_ && previous_truth != nullptr) {
    flicker_ += tools::flicker(picture, *latest_, truth, *previous_truth);
  }
  for (std::size_t i = 0; i < masks.regions.size(); ++i) {
    const double error = pixel_error(picture, truth, i);
    regions_[static_cast<std::size_t>(masks.regions[i])].add(error);
    if (masks.disoccluded[i] != 0) disoccluded_.add(error);
    if (!masks.focus.empty()) (masks.focus[i] != 0 ? focus_ : outside_).add(error);
  }
  latest_ = std::move(picture);
  ++frames_;
}

void QualityTally::PartError::add(double squared_error) {
  squares += squared_error;
  ++count;
}

std::optional<double> QualityTally::PartError::psnr() const {
  if (count == 0) return std::nullopt;
  return std::min(-10 * std::log10(mean_square()), kHighestRegionPsnr);
}

Quality QualityTally::quality() const {
  const double count = frames_;
  Quality quality = worst_;
  quality.psnr = -10 * std::log10(error_ / count);
  quality.psnr_linear = -10 * std::log10(error_linear_ / count);
  quality.ssim = ssim_ / count;
  quality.flip = flip_ / count;
  quality.error_p99 = p99_ / count;
  quality.relative_error = relative_ / count;
  if (frames_ > 1) quality.flicker = flicker_ / (count - 1);
  if (disoccluded_.count > 0) quality.ghosting = std::sqrt(disoccluded_.mean_square());
  for (std::size_t i = 0; i < kRegions; ++i)
    quality.region_psnr[i] = regions_[i].psnr();
  quality.psnr_focus = focus_.psnr();
  quality.psnr_outside = outside_.psnr();
  quality.non_finite = non_finite_;
  return quality;
}

}  // namespace quincunx::bench
