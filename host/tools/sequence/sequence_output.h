// SPDX-License-Identifier: MIT
// Sequence output: the files that resolved frames go to, whole or not at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/image/image_io.h"
#include "tools/sequence/frame_pattern.h"

namespace quincunx::tools {

enum class Made : std::uint8_t { kNot, kOtherwise, kAsWanted };

// A value; its functions are thread-safe for different frames.
struct SequenceOutput {
  FramePattern pattern;
  Extent extent;
  ChannelType stored = ChannelType::kHalf;  // of EXR
  std::string settings = {};  // what the pixels depend on: the attribute quincunx:resolve of an EXR

  std::string path(std::int64_t frame) const { return pattern.expand(frame); }

  // Whether the frame's file is there as this run would make it: an EXR of this extent, made with these
  // settings. Of a PNG, that it is there at all. (Files are only ever whole.)
  Made made(std::int64_t frame) const;

  // Linear RGBA floats, and the attributes that the frame keeps. The same pixels make the same file, byte for
  // byte. Errors: kIoFailure.
  Status write_linear(std::int64_t frame, std::span<const float> rgba, std::span<const Attribute> kept) const;

  // RGBA8, sRGB encoded.
  Status write_presented(std::int64_t frame, std::span<const std::uint8_t> rgba) const;

  // That these frames can be written without harm. Errors: kInvalidArgument where they would overwrite one
  // another or one of `inputs` (by whatever name), kIoFailure where one is a folder.
  Status check_names(std::span<const std::int64_t> frames, std::span<const std::string> inputs) const;

  // Makes the folder. Errors: kIoFailure where that is not possible or nothing can be written there.
  Status check_folder() const;

  // Removes the temporary files of these frames that a killed run left behind.
  void remove_leftovers(std::span<const std::int64_t> frames) const;
};

}  // namespace quincunx::tools
