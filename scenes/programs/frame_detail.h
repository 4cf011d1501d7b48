// SPDX-License-Identifier: MIT
// FrameDetail: lets a scene's detail follow the resolution.
#pragma once

#include "quincunx/detail_follower.h"
#include "render/renderer.h"

namespace quincunx::scenes {

// There are four levels. At each, surfaces that span another .8 % of the picture's height are left out, and
// the shadows of what moves are drawn less often: in every frame, every second, third or fourth one. Called
// once a frame, in order; one thread.
class FrameDetail {
 public:
  static Result<FrameDetail> create();

  // Takes the area fraction that `view` is drawn at into account, and takes detail from it.
  void follow(double area_fraction, FrameView& view);

  int level() const { return follower_.level(); }  // 0: full detail

 private:
  explicit FrameDetail(const DetailFollower& follower) : follower_(follower) {}

  DetailFollower follower_;
};

}  // namespace quincunx::scenes
