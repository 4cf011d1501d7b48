// SPDX-License-Identifier: MIT
// Exchange attributes: what a file of the exchange format says beside its pixels (docs/inputs.md). One table serves
// whoever writes frames and whoever reads them. Thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/status.h"
#include "tools/image/image_reader.h"
#include "tools/record/exchange_format.h"

namespace quincunx::tools {

// Each under its name of the exchange format ("quincunx:jitter"); jitter and reset are also read without the prefix,
// and pairs, numbers and flags also as text ("0.25 -0.25", "true"), as some programs can only write that.
struct FrameAttributes {
  std::optional<Vec2> jitter = {};  // render pixels
  std::optional<Extent> render = {};
  std::optional<Extent> output = {};
  std::optional<std::int64_t> index = {};
  std::optional<bool> reset = {};
  std::optional<float> near_plane = {};
  std::optional<DepthKind> depth_kind = {};
  std::optional<Matrix> world_to_ndc = {};
  // Those of recorded frames alone, as FrameInputs and FocusInputs have them.
  std::optional<float> far_plane = {};
  std::optional<Vec2> velocity_scale = {};
  std::optional<Extent> picture = {};  // FrameInputs::output_extent
  std::optional<Matrix> camera = {};
  std::optional<float> exposure = {};
  std::optional<float> exposure_image = {};  // its texel
  std::optional<int> parity = {};
  std::optional<float> fade_weight = {};
  std::optional<Vec2> place = {};  // of a focus
  std::optional<std::string> rectangles = {};
  std::optional<float> feather = {};
  // Names without prefix whose values cannot be meant, as another program wrote them: jitter, reset.
  std::vector<std::string> foreign = {};

  friend bool operator==(const FrameAttributes&, const FrameAttributes&) = default;
};

// `part`: as ImageHeader::attribute() has it. Errors: kIoFailure, naming `path` and the attribute, where one holds what
// it cannot mean.
Result<FrameAttributes> frame_attributes(const std::string& path, const ImageHeader& header, int part = 0);

// Returns those that are set, and the format's version.
std::vector<Attribute> to_attributes(const FrameAttributes& attributes);

}  // namespace quincunx::tools
