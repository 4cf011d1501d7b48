// SPDX-License-Identifier: MIT
// RecordedFrame: all that an engine gave with one frame, in host memory and in files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/advanced/focus.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx::tools {

// What images of one size belong to; each has files of its own.
enum class FramePart : std::uint8_t { kPicture, kParticles, kFadingFrom, kFocus, kFocusMask };
inline constexpr std::size_t kFrameParts = 5;

// Returns "folder/frame.0007.exr" of the picture.
std::string path_of(const std::string& folder, FramePart part, std::int64_t number);
// Whether a file of that name, without folder, is one of a recorded frame.
bool is_frame_file(const std::string& name);

struct RecordedImage {
  PixelFormat format = PixelFormat::kNone;
  std::vector<std::byte> texels;  // tightly packed, the picture's top row first
};

struct RecordedPart {
  Extent extent = {};
  std::vector<RecordedImage> images =
      {};  // those that the plan reads, as kInputs lists them; none: it is not there
};

// The inputs' images are empty: their texels are in the parts.
struct RecordedFrame {
  FrameInputs inputs = {};
  std::optional<FocusInputs> focus = {};
  std::optional<float> exposure_image = {};  // its texel
  std::array<RecordedPart, kFrameParts> parts = {};

  RecordedPart& operator[](FramePart part) { return parts[static_cast<std::size_t>(part)]; }
  const RecordedPart& operator[](FramePart part) const { return parts[static_cast<std::size_t>(part)]; }
};

// Returns what a frame tells but for its images.
FrameInputs without_images(FrameInputs inputs);

// Reads back what the plan reads of these inputs; waits for the queue. Errors: of the device.
Result<RecordedFrame> download(const Device& device, const ResolvePlan& plan, const FrameInputs& inputs,
                               const FocusInputs* focus);

// A frame on a device, as dispatch() takes it.
struct UploadedFrame {
  FrameInputs inputs = {};
  std::optional<FocusInputs> focus = {};
  std::vector<Image> images = {};  // the memory of both
};

// The way back, with the plan's storage and targets; all images are new. Errors: of the device.
Result<UploadedFrame> upload(const Device& device, const ResolvePlan& plan, const RecordedFrame& frame);

// Writes a frame's files, the picture's last; on an error none of them stays. Errors: kIoFailure.
Status write_frame(const std::string& folder, std::int64_t number, const ResolvePlan& plan,
                   const RecordedFrame& frame);

// Reads what those files have of the plan's formats. Errors: kIoFailure, naming the file.
Result<RecordedFrame> read_recorded_frame(const std::string& folder, std::int64_t number,
                                          const ResolvePlan& plan);

}  // namespace quincunx::tools
