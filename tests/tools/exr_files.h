// SPDX-License-Identifier: MIT
// EXR files of every shape that other programs write: parts, tiles, windows, types, deep pixels.
#pragma once

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/image/image_reader.h"

namespace quincunx::testing {

struct ExrPart {
  std::string name;
  tools::ImageWindow data;
  tools::ImageWindow display;
  std::vector<std::string> channels;
  std::vector<OIIO::TypeDesc> types;  // one for each channel
  std::vector<float> pixels;          // pixels of the data window, channels interleaved
  int tile = 0;                       // side of the tiles; 0: scanlines
  std::string compression = "zip";
};

// A part whose data window is its display window, all channels half.
inline ExrPart simple_part(Extent extent, std::vector<std::string> channels, std::vector<float> pixels) {
  ExrPart part;
  part.data = part.display = {0, 0, extent};
  part.types.assign(channels.size(), OIIO::TypeHalf);
  part.channels = std::move(channels);
  part.pixels = std::move(pixels);
  return part;
}

inline OIIO::ImageSpec spec_of(const ExrPart& part) {
  OIIO::ImageSpec spec(part.data.extent.width, part.data.extent.height,
                       static_cast<int>(part.channels.size()), OIIO::TypeHalf);
  spec.x = part.data.x;
  spec.y = part.data.y;
  spec.full_x = part.display.x;
  spec.full_y = part.display.y;
  spec.full_width = part.display.extent.width;
  spec.full_height = part.display.extent.height;
  spec.tile_width = spec.tile_height = part.tile;
  spec.channelnames = part.channels;
  spec.channelformats = part.types;
  spec.attribute("compression", part.compression);
  if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
  return spec;
}

inline void write_exr_parts(const std::string& path, const std::vector<ExrPart>& parts) {
  const auto output = OIIO::ImageOutput::create("openexr");
  std::vector<OIIO::ImageSpec> specs;
  for (const ExrPart& part : parts)
    specs.push_back(spec_of(part));
  ASSERT_TRUE(output->open(path, static_cast<int>(specs.size()), specs.data())) << output->geterror();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) {
      ASSERT_TRUE(output->open(path, specs[i], OIIO::ImageOutput::AppendSubimage));
    }
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, parts[i].pixels.data())) << output->geterror();
  }
  ASSERT_TRUE(output->close());
}

inline void write_deep_exr(const std::string& path, Extent extent) {
  OIIO::ImageSpec spec(extent.width, extent.height, 4, OIIO::TypeHalf);
  spec.channelnames = {"R", "G", "B", "A"};
  spec.deep = true;
  OIIO::DeepData data;
  data.init(spec);
  for (std::int64_t pixel = 0; pixel < extent.area(); ++pixel)
    data.set_samples(pixel, 1);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(path, spec)) << output->geterror();
  ASSERT_TRUE(output->write_deep_image(data)) << output->geterror();
  ASSERT_TRUE(output->close());
}

}  // namespace quincunx::testing
