// SPDX-License-Identifier: MIT
// QualityTally: the errors of one method, gathered frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/regions.h"
#include "tools/image/image_metrics.h"

namespace quincunx::bench {

// One thread at a time.
class QualityTally {
 public:
  // The measured frames in order.
  void add(tools::MeasuredPicture picture, const tools::MeasuredPicture& truth,
           const tools::MeasuredPicture* previous_truth, const FrameMasks& masks);

  // At least one frame.
  Quality quality() const;

  const tools::MeasuredPicture& latest() const { return *latest_; }

 private:
  // Of some pixels of all frames.
  struct PartError {
    double squares = 0;
    std::int64_t count = 0;

    void add(double squared_error);
    std::optional<double> psnr() const;  // dB; nothing where there is no pixel
    double mean_square() const { return squares / static_cast<double>(count); }
  };

  int frames_ = 0;
  Quality worst_;  // of its fields only those of the worst window
  double error_ = 0, error_linear_ = 0, ssim_ = 0, flip_ = 0, p99_ = 0, relative_ = 0, flicker_ = 0;
  PartError disoccluded_;
  PartError focus_, outside_;
  std::array<PartError, kRegions> regions_;
  std::int64_t non_finite_ = 0;
  std::optional<tools::MeasuredPicture> latest_;
};

}  // namespace quincunx::bench
