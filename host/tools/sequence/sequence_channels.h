// SPDX-License-Identifier: MIT
// Sequence channels: which channels of a file are colour, motion, depth and reactive values. Pure.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "tools/image/image_reader.h"

namespace quincunx::tools {

// By name. An empty name: this kind of value is not read.
struct ChannelNames {
  std::array<std::string, 4> colour = {"R", "G", "B", "A"};  // A may be missing in the file: 1
  std::array<std::string, 2> velocity;                       // both or none
  std::string depth;
  std::string reactive;

  bool has_velocity() const { return !velocity[0].empty(); }
  bool has_depth() const { return !depth.empty(); }
  bool has_reactive() const { return !reactive.empty(); }
};

// Those of the exchange format.
inline const std::array<std::string, 2> kBackwardChannels = {"backward.u", "backward.v"};
inline const std::string kDepthChannel = "Z";
inline const std::string kReactiveChannel = "reactive.mask";

// "ViewLayer.Combined" -> its R, G, B and A; "" -> R, G, B and A. A layer of one channel Y is grey: Y stands for the
// first three. Where the file has neither they are R, G and B.
std::array<std::string, 4> colour_channels_in(const ImageHeader& header, const std::string& layer);

// "colour R,G,B,A", "grey Y,A".
std::string colour_text(const ChannelNames& names);

// Where they are in one file.
struct ChannelPlaces {
  std::array<std::optional<ChannelPlace>, 4> colour;  // only A may be absent
  std::array<std::optional<ChannelPlace>, 2> velocity;
  std::optional<ChannelPlace> depth;
  std::optional<ChannelPlace> reactive;
  ImageWindow display;  // of the parts in use
  bool half_colour = true;
  bool background = true;  // colour covers the display window, and there is no alpha
  bool dwa = false;        // some of the channels are compressed with loss, by what their names end in
};

// Whether pixels of the display window lie outside the data window.
bool leaves_pixels_open(const ImagePart& part);

// Errors: kIoFailure, one sentence with `path` and the channel: one that is missing, deep, of integers, or
// in a part of another size. Where colour is missing the sentence says which layers would do; `option` is the one that
// names a layer of these files.
Result<ChannelPlaces> find_channels(const std::string& path, const ImageHeader& header,
                                    const ChannelNames& names, const std::string& option = "--colour");

}  // namespace quincunx::tools
