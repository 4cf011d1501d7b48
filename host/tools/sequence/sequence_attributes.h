// SPDX-License-Identifier: MIT
// Sequence attributes: what a frame's file says beside its pixels. Pure; thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/image/image_reader.h"
#include "tools/sequence/sequence_conventions.h"

namespace quincunx::tools {

// Each under its name of the exchange format ("quincunx:jitter"); jitter and reset also without the prefix,
// and pairs and numbers also as text ("0.25 -0.25"), as some programs can only write that.
struct FrameAttributes {
  std::optional<Vec2> jitter;  // render pixels
  std::optional<Extent> render;
  std::optional<Extent> output;
  std::optional<std::int64_t> index;
  bool reset = false;
  std::optional<float> near_plane;
  std::optional<DepthKind> depth_kind;
  std::optional<Matrix> world_to_ndc;
};

// Errors: kIoFailure, naming `path` and the attribute, where one holds what it cannot mean.
Result<FrameAttributes> frame_attributes(const std::string& path, const ImageHeader& header);

}  // namespace quincunx::tools
