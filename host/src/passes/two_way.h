// SPDX-License-Identifier: MIT
// TwoWay: services whose histories are merged with those of other services, for frames that are all there already
// (quincunx-resolve): one resolves them forwards, one backwards, as if time ran that way. Each frame is added to both,
// without a picture; what both know of it is merged, and shown by the first.
//
// Plans accumulate, have one output size, and no focus. Not thread-safe; blocks.
#pragma once

#include <cstddef>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/resolve_service.h"

namespace quincunx {

// A frame's history in host memory, at the pixels' centres: colour and confidence of each pixel in the history's
// format, and alpha where the plan accumulates it; the frame's velocity and depth where the plan blurs. Used again, it
// keeps its memory.
struct KeptHistory {
  float exposure = 0;  // what multiplied light to be that of `texels`
  std::vector<std::byte> texels, alpha, velocity, depth;
};

class QUINCUNX_API TwoWay {
 public:
  // As ResolveService::create(). No dispatch() on it afterwards.
  static Result<ResolveService> create(const Device& device, const ResolvePlan& plan);

  // Returns the plan with the passes and buffers of such a service, to be explained: create() takes `plan` itself. Of
  // the passes add() runs those as far as merge_histories, and show() the rest. Pure.
  static ResolvePlan planned(const ResolvePlan& plan);

  // Adds a frame to the service's history, as dispatch() does. `kept`, if not null, receives that history; with
  // `merges`, the combination of that history and the one already in `kept`, of the same frame.
  static FrameReport add(ResolveService& service, const FrameInputs& inputs, bool merges, KeptHistory* kept);

  // Turns round: gives `backward` the history of `forward` in place of its own. Both have added the same frame last,
  // `backward` with `reset`, and have plans that differ in nothing but what follows history.
  static Status turn(ResolveService& backward, const ResolveService& forward);

  // Makes the picture of a history. `inputs`: the frame's, without images. `albedo`: as FrameOutputs::linear, what part
  // of light the surfaces in the picture throw back, for plans that denoise; null: it is not known.
  static FrameReport show(ResolveService& service, const FrameInputs& inputs, const KeptHistory& kept,
                          const FrameOutputs& outputs, const ImageView& albedo = {});
};

}  // namespace quincunx
