// SPDX-License-Identifier: MIT
#include "programs/frame_detail.h"

namespace quincunx::scenes {
namespace {

constexpr float kLeastSizePerLevel = 0.008f;  // six lines of 720
constexpr double kRounding = 0.5;             // of a frame: times of frames are sums

}  // namespace

Result<FrameDetail> FrameDetail::create() {
  auto follower = DetailFollower::create();
  if (!follower.ok()) return follower.status();
  return FrameDetail(follower.value());
}

void FrameDetail::follow(double area_fraction, FrameView& view) {
  const int level = follower_.observe(area_fraction);
  if (level == 0) return;
  const double frame_seconds = view.seconds - view.previous_seconds;
  view.least_size = kLeastSizePerLevel * static_cast<float>(level);
  view.shadow_age = (level + kRounding) * frame_seconds;
}

}  // namespace quincunx::scenes
