// SPDX-License-Identifier: MIT
// Sequence reader: one file of a sequence as the library wants a frame, in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/sequence/sequence_input.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx::tools {

// Texels are tightly packed, rows top-down, render extent. Reading another frame into the same object reuses
// its memory.
struct SequenceFrame {
  std::int64_t number = 0;
  Extent render;
  std::vector<std::byte> colour;       // RGBA16F or RGBA32F as asked for
  std::vector<Vec2> velocity;          // uv, this - previous position, +v down; empty where not read
  std::vector<float> depth;            // reversed infinite; empty where not read
  std::vector<std::uint8_t> reactive;  // empty where not read
  std::optional<Matrix> world_to_ndc;
  std::vector<Attribute> kept;  // of the file: camera, rate and the like: the resolved frame's too
};

// Reads the channels of `format` of the file that `expected` was scanned from. Where the data window leaves
// pixels of the display window open they are transparent black, at rest, infinitely far and not reactive.
// `colour`: RGBA16F or RGBA32F; halves stay what they were either way. Errors: kIoFailure, naming `path`.
Status read_frame(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                  PixelFormat colour, SequenceFrame& frame);

}  // namespace quincunx::tools
