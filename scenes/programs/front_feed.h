// SPDX-License-Identifier: MIT
// Front feed: a run of frames of one jitter at one scale, each resolved by several methods. What the errors and the
// times of a scene's front are measured with.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "programs/frame_source.h"

namespace quincunx::scenes {

// A part of the picture, at the picture's own density of pixels.
struct PictureCrop {
  Extent extent;
  ViewWindow window;
  float aspect = 0;  // of the whole picture

  // Of at most `most` pixels each way.
  static PictureCrop middle_of(Extent output, Extent most);
};

struct FrontFeed {
  PictureCrop crop;
  float scale = 1;
  double fps = 60;
  double seconds = 0;  // of frame 0
  bool held = false;   // every frame is of that moment: nothing moves but the jitter
  int warm_up = 0;     // frames before frame 0
  int frames = 1;
};

// One frame of one method. `resolved`: linear RGBA of the crop's extent, valid until the callback is over.
struct FrontFrame {
  std::size_t method;  // of `methods`
  int index;           // negative ones warm up
  const FrameReport& report;
  const ImageView& resolved;
};

// Calls `each` once a frame and method, frame by frame. `methods`: names of tools::method_choices() that want the same
// jitter. Shares scene, context and device of `stage`, and nothing else; one thread, that of the GL context. Errors: of
// any part, as it words them, and that of `each`, after which nothing more is drawn.
Status run_feed(const FrameSource& stage, const FrontFeed& feed, std::span<const std::string> methods,
                const std::function<Status(const FrontFrame&)>& each);

}  // namespace quincunx::scenes
