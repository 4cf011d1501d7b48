// SPDX-License-Identifier: MIT
// FrameSequence: what each frame of a run is: its time, viewport, jitter and texture bias. Pure but for the
// viewport it holds; one thread.
#pragma once

#include <cstdint>
#include <optional>

#include "programs/output_path.h"
#include "programs/scale_path.h"
#include "quincunx/dynamic_viewport.h"
#include "quincunx/status.h"
#include "render/renderer.h"
#include "tools/program/jitter.h"

namespace quincunx::scenes {

using tools::Jitter;
using tools::jitter_of;

// How much sharper textures are sampled than a pixel of one frame alone would bear.
struct TextureDetail {
  float lod_bias = 0;       // levels
  float follows_scale = 0;  // this times log2 of the frame's scale is added; from 0 to 1 while a method fades

  friend auto operator<=>(const TextureDetail&, const TextureDetail&) = default;
};

struct SequenceSettings {
  Extent output;
  ScalePath scale_path;
  std::optional<OutputPath> outputs;  // absent: always `output`
  Jitter jitter = Jitter::kNone;
  Shading shading = Shading::kFull;
  std::int64_t frames = 1;
  double fps = 60;
  double start_seconds = 0;  // scene time of frame 0
  TextureDetail detail = {};
};

class FrameSequence {
 public:
  // Errors: kInvalidArgument for an empty output, no frames, or a rate that is not a positive number.
  static Result<FrameSequence> create(const SequenceSettings& settings);

  std::int64_t size() const { return settings_.frames; }
  Extent target() const { return viewport_.target(); }  // holds the largest viewport
  Extent output() const { return settings_.output; }

  // From the next frame on.
  void set_sampling(Jitter jitter, TextureDetail detail) {
    settings_.jitter = jitter;
    settings_.detail = detail;
  }

  // Frame `index` in [0, size()). Its previous_seconds is one frame earlier, also for frame 0.
  FrameView at(std::int64_t index);

  // The same at another viewport than the path's, within the target, and for any index that is not negative.
  FrameView at(std::int64_t index, Extent render);

 private:
  FrameSequence(const SequenceSettings& settings, const DynamicViewport& viewport)
      : settings_(settings), viewport_(viewport) {}

  SequenceSettings settings_;
  DynamicViewport viewport_;
};

}  // namespace quincunx::scenes
