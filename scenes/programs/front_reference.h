// SPDX-License-Identifier: MIT
// Front reference: what a scene's pictures are held against.
#pragma once

#include <string>
#include <vector>

#include "programs/front_feed.h"
#include "tools/image/image_metrics.h"

namespace quincunx::scenes {

// Which samples truth has, along each side of a pixel: as many as fit, 0 where not even the fewest do. `draw_seconds`:
// of one sample of all pictures. Pure.
int truth_samples(double draw_seconds, double most_seconds);

struct FrontReference {
  std::string what;  // "64 samples a pixel of 320x180 in the middle"
  // Of the held moment once, else of each of the frames.
  std::vector<tools::MeasuredPicture> held, moving;
};

// Of `feed`'s frames from its first, exposed as the scene asks. The scale does not count.
Result<FrontReference> reference_of(FrameSource& stage, const FrontFeed& feed, double most_seconds);

}  // namespace quincunx::scenes
