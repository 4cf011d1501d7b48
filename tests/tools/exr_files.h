// SPDX-License-Identifier: MIT
// EXR files of every shape that other programs write: parts, tiles, windows, types, deep pixels.
#pragma once

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "tools/image/image_reader.h"

namespace quincunx::testing {

struct ExrPart {
  std::string name;
  tools::ImageWindow data;
  tools::ImageWindow display;
  std::vector<std::string> channels;
  std::vector<Imf::PixelType> types;  // one for each channel
  std::vector<float> pixels;          // pixels of the data window, channels interleaved
  int tile = 0;                       // side of the tiles; 0: scanlines
  std::string compression = "zip";
  std::string view = "";
  std::vector<std::string> views = {};  // the attribute multiView
  bool mipmaps = false;                 // with tiles
  bool deep = false;                    // one sample of 1 a pixel; only among several parts
  int sampling = 1;                     // of the last channel, both ways

  int sampling_of(std::size_t channel) const { return channel + 1 == channels.size() ? sampling : 1; }
};

// A part whose data window is its display window, all channels half.
inline ExrPart simple_part(Extent extent, std::vector<std::string> channels, std::vector<float> pixels) {
  ExrPart part;
  part.data = part.display = {0, 0, extent};
  part.types.assign(channels.size(), Imf::HALF);
  part.channels = std::move(channels);
  part.pixels = std::move(pixels);
  return part;
}

inline Imath::Box2i box_of(const tools::ImageWindow& window) {
  return {{window.x, window.y}, {window.x + window.extent.width - 1, window.y + window.extent.height - 1}};
}

inline Imf::Header header_of(const ExrPart& part, bool of_several) {
  constexpr const char* kCompressions[] = {"none",  "rle", "zips", "zip",  "piz",
                                           "pxr24", "b44", "b44a", "dwaa", "dwab"};  // in OpenEXR's order
  Imf::Header header(box_of(part.display), box_of(part.data));
  header.compression() = static_cast<Imf::Compression>(
      std::find(std::begin(kCompressions), std::end(kCompressions), part.compression) - kCompressions);
  for (std::size_t c = 0; c < part.channels.size(); ++c)
    header.channels().insert(part.channels[c],
                             Imf::Channel(part.types[c], part.sampling_of(c), part.sampling_of(c)));
  const auto mode = part.mipmaps ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL;
  if (part.tile > 0) header.setTileDescription(Imf::TileDescription(part.tile, part.tile, mode));
  if (of_several) header.setType(part.tile > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  if (part.deep) header.setType(Imf::DEEPSCANLINE);
  if (part.deep) header.compression() = Imf::ZIPS_COMPRESSION;
  if (!part.name.empty()) header.setName(part.name);
  if (!part.view.empty()) header.setView(part.view);
  if (!part.views.empty()) Imf::addMultiView(header, part.views);
  return header;
}

// `write` gets what OpenEXR is to write from.
template <typename Write>
void with_frame_buffer(const ExrPart& part, Write write) {
  const std::size_t count = part.channels.size(), width = static_cast<std::size_t>(part.data.extent.width);
  std::vector<char> texels(part.pixels.size() * 4);  // the channels' types, each in 4 bytes
  for (std::size_t i = 0; i < part.pixels.size(); ++i) {
    const float value = part.pixels[i];
    const half as_half(value);
    const auto as_integer = static_cast<unsigned>(std::max(value, 0.0f));
    char* texel = texels.data() + i * 4;
    if (part.types[i % count] == Imf::HALF) std::memcpy(texel, &as_half, sizeof as_half);
    if (part.types[i % count] == Imf::UINT) std::memcpy(texel, &as_integer, sizeof as_integer);
    if (part.types[i % count] == Imf::FLOAT) std::memcpy(texel, &value, sizeof value);
  }
  const auto stride = static_cast<std::ptrdiff_t>(count * 4),
             row = stride * static_cast<std::ptrdiff_t>(width);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < count; ++c) {
    char* first = texels.data() + c * 4 - part.data.x * stride - part.data.y * row;
    buffer.insert(part.channels[c],
                  Imf::Slice(part.types[c], first, static_cast<std::size_t>(stride),
                             static_cast<std::size_t>(row), part.sampling_of(c), part.sampling_of(c)));
  }
  write(buffer);
}

template <typename Scanlines>
void write_scanlines(Scanlines& file, const ExrPart& part) {
  with_frame_buffer(part, [&](const Imf::FrameBuffer& buffer) {
    file.setFrameBuffer(buffer);
    file.writePixels(part.data.extent.height);
  });
}

template <typename Tiles>
void write_tiles(Tiles& file, const ExrPart& part) {
  with_frame_buffer(part, [&](const Imf::FrameBuffer& buffer) {
    file.setFrameBuffer(buffer);
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  });
}

// One sample a pixel.
template <typename Scanlines>
void write_deep(Scanlines& file, Extent extent, const std::vector<std::string>& channels) {
  const auto pixels = static_cast<std::size_t>(extent.area()), width = static_cast<std::size_t>(extent.width);
  std::vector<unsigned> counts(pixels, 1);
  half one(1);
  std::vector<half*> samples(pixels, &one);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()),
                                           sizeof counts[0], sizeof counts[0] * width));
  for (const std::string& name : channels)
    buffer.insert(name, Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(samples.data()), sizeof samples[0],
                                       sizeof samples[0] * width, sizeof one));
  file.setFrameBuffer(buffer);
  file.writePixels(extent.height);
}

inline void write_exr_parts(const std::string& path, const std::vector<ExrPart>& parts) {
  std::vector<Imf::Header> headers;
  for (const ExrPart& part : parts)
    headers.push_back(header_of(part, parts.size() > 1));
  if (parts.size() == 1 && parts[0].tile > 0) {
    Imf::TiledOutputFile file(path.c_str(), headers[0]);
    write_tiles(file, parts[0]);
  } else if (parts.size() == 1) {
    Imf::OutputFile file(path.c_str(), headers[0]);
    write_scanlines(file, parts[0]);
  } else {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].tile > 0) {
        Imf::TiledOutputPart tiles(file, static_cast<int>(i));
        write_tiles(tiles, parts[i]);
      } else if (parts[i].deep) {
        Imf::DeepScanLineOutputPart deep(file, static_cast<int>(i));
        write_deep(deep, parts[i].data.extent, parts[i].channels);
      } else {
        Imf::OutputPart scanlines(file, static_cast<int>(i));
        write_scanlines(scanlines, parts[i]);
      }
    }
  }
}

inline void write_deep_exr(const std::string& path, Extent extent) {
  ExrPart part = simple_part(extent, {"R", "G", "B", "A"}, {});
  part.deep = true;
  Imf::DeepScanLineOutputFile file(path.c_str(), header_of(part, false));
  write_deep(file, extent, part.channels);
}

}  // namespace quincunx::testing
