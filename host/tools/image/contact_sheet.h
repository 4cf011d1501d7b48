// SPDX-License-Identifier: MIT
// ContactSheet: one picture that shows a whole run: thumbnails with captions under a title.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"

namespace quincunx::tools {

struct ContactSheetSettings {
  std::string title;          // "Courtyard"
  std::string subtitle;       // "1280×720 · quincunx · llvmpipe + PoCL"; UTF-8
  int columns = 0;            // 0: chosen so that the sheet is about 3:2
  int thumbnail_width = 384;  // px; frames that are smaller keep their size
};

struct ContactSheetCaption {
  std::string left;   // "frame 0120", bright
  std::string right;  // "0.71 · 909×511", dim
  float bar = -1;  // 0 to 1: length of a thin bar under the thumbnail, a render scale for instance; < 0: none
};

// The frame numbers 0 <= n < total, `count` of them (or all), evenly spaced, the first and the last among
// them.
std::vector<int> evenly_spaced(int total, int count);

// Keeps the thumbnails only, so a long run costs little memory. Not thread-safe.
class ContactSheet {
 public:
  explicit ContactSheet(ContactSheetSettings settings);

  // Takes a thumbnail of a frame: RGBA8, sRGB encoded, box filtered in linear light; alpha is ignored.
  // `row_bytes` 0: tightly packed. Errors: kInvalidArgument for an empty extent or no texels.
  Status add(Extent extent, const std::uint8_t* rgba, const ContactSheetCaption& caption,
             std::size_t row_bytes = 0);

  int size() const { return static_cast<int>(thumbnails_.size()); }

  // Errors: kInvalidArgument without frames, kIoFailure. Where no font is found the text is left out, with
  // one line in the log.
  Status write(const std::string& path) const;

 private:
  struct Thumbnail {
    Extent extent;
    std::vector<std::uint8_t> rgb;
    ContactSheetCaption caption;
  };

  ContactSheetSettings settings_;
  std::vector<Thumbnail> thumbnails_;
};

}  // namespace quincunx::tools
