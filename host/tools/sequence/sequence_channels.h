// SPDX-License-Identifier: MIT
// Sequence channels: which of a file's parts, views and layers is the picture, and which channels go with it. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/plan/resources.h"
#include "tools/image/image_reader.h"
#include "tools/record/exchange_format.h"

namespace quincunx::tools {

// The images that frames of a sequence bring: the inputs of plan/resources.h, numbered as there, and albedo, which is
// the colour of a service of its own.
enum class InputPlane : std::uint8_t {
  kColour,
  kVelocity,
  kDepth,
  kReactive,
  kAlbedo = static_cast<std::uint8_t>(Resource::kInputCount),
};
inline constexpr std::size_t kPlaneCount = static_cast<std::size_t>(InputPlane::kAlbedo) + 1;

constexpr InputPlane plane_of(const InputImage& input) {
  return static_cast<InputPlane>(&input - kInputs);
}

template <typename Value>
struct PerPlane {
  std::array<Value, kPlaneCount> values = {};

  Value& operator[](InputPlane plane) { return values[static_cast<std::size_t>(plane)]; }
  const Value& operator[](InputPlane plane) const { return values[static_cast<std::size_t>(plane)]; }
};

// By name: "Z", in a file of several parts "depth.Z"; none: this plane is not read. The fourth of colour, A, may be
// missing in the file: 1.
struct ChannelNames : PerPlane<std::vector<std::string>> {
  ChannelNames() { (*this)[InputPlane::kColour] = kColourChannels; }
  bool has(InputPlane plane) const { return !(*this)[plane].empty(); }
};

// What says which picture of a file is meant. All may be empty.
struct PictureWish {
  std::string layer = {};           // "ViewLayer.Combined", "PART" or "PART.LAYER"
  std::string part = {};            // name, or number from 0
  std::string view = {};            // "left"; empty: the file's default
  std::string option = "--colour";  // what names a layer of these files
};

struct Picture {
  std::vector<std::string> channels =
      kColourChannels;  // as ChannelNames has them; Y stands for three of a grey one
  int part = 0;
  std::string view = {};  // empty: it belongs to none
};

// The file's views, its default first: by its attributes, or where parts or layers are called left and right.
std::vector<std::string> views_of(const ImageHeader& header);

// Chooses the picture: R, G, B and A, or a lonely Y, of one layer of one part. Without a wish that is a part's picture
// without layer, or what has a beauty's usual name. Where there is none find_channels() will say so. Errors:
// kInvalidArgument where several could be meant, and for a part or a view that is not there.
Result<Picture> choose_picture(const std::string& path, const ImageHeader& header, const PictureWish& wish);

// Returns the channels called `names` that go with the picture: of its view or none, in its part before others. Those
// of none go with another view than the default only where they are `asked` for. None where one is missing. Errors:
// kInvalidArgument where several parts have them.
Result<std::vector<std::string>> channels_beside(const std::string& path, const ImageHeader& header,
                                                 const Picture& picture,
                                                 const std::vector<std::string>& names, bool asked = false);

// Returns the file's first channel of this view, or its first of all where it has none.
std::string first_of_view(const ImageHeader& header, const std::string& view);

// Returns the channels of a layer called "albedo", or "Denoising Albedo" as Cycles has it; none if there is none.
std::vector<std::string> albedo_beside(const ImageHeader& header, const Picture& picture);

// "colour R,G,B,A", "grey Y,A".
std::string colour_text(const ChannelNames& names);

// Where they are in one file.
struct ChannelPlaces : PerPlane<std::vector<std::optional<ChannelPlace>>> {  // only A may be absent
  ImageWindow display;  // display window of the parts in use
  bool half_colour = true;
  bool background = true;  // colour covers the display window, and there is no alpha
  bool dwa = false;        // some of the channels are compressed with loss, by what their names end in
  int picture_part() const { return (*this)[InputPlane::kColour][0]->part; }
};

// Whether pixels of the display window lie outside the data window.
bool leaves_pixels_open(const ImagePart& part);

// Errors: kIoFailure, one sentence with `path` and the channel: one that is missing, in several parts, deep, of
// integers, subsampled, or in a part of another size; colour of several parts; a display window with hardly any data.
// Where colour is missing the sentence says which layers would do; `option` is the one that names a layer of these
// files.
Result<ChannelPlaces> find_channels(const std::string& path, const ImageHeader& header,
                                    const ChannelNames& names, const std::string& option = "--colour");

}  // namespace quincunx::tools
