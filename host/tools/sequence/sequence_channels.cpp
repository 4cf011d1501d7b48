// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_channels.h"

#include <fmt/format.h>

namespace quincunx::tools {
namespace {

// Looks channels up one after another and keeps the first thing that is wrong.
class Search {
 public:
  Search(const std::string& path, const ImageHeader& header) : path_(path), header_(header) {}

  std::optional<ChannelPlace> find(const std::string& name) {
    if (!status_.ok()) return std::nullopt;
    const auto place = header_.find(name);
    if (!place) {
      complain(fmt::format("has no channel '{}'; it has {}", name, header_.channel_names()));
      return std::nullopt;
    }
    check(name, *place);
    return place;
  }

  const std::optional<ImageWindow>& display() const { return display_; }
  const Status& status() const { return status_; }

 private:
  void check(const std::string& name, ChannelPlace place) {
    const ImagePart& part = header_.parts[place.part];
    if (part.deep) {
      complain(fmt::format("holds deep pixels in channel '{}'; flat ones are needed", name));
    } else if (header_.at(place).integer) {
      complain(fmt::format("holds integers in channel '{}'; half or float is needed", name));
    } else if (display_ && part.display.extent != display_->extent) {
      complain(fmt::format("has channel '{}' at {}x{} pixels, but its colour at {}x{}", name,
                           part.display.extent.width, part.display.extent.height, display_->extent.width,
                           display_->extent.height));
    } else if (!display_) {
      display_ = part.display;
    }
  }

  void complain(const std::string& what) { status_ = Status::io(fmt::format("'{}' {}", path_, what)); }

  const std::string& path_;
  const ImageHeader& header_;
  std::optional<ImageWindow> display_;
  Status status_;
};

}  // namespace

std::array<std::string, 4> colour_channels_of(const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {prefix + "R", prefix + "G", prefix + "B", prefix + "A"};
}

bool leaves_pixels_open(const ImagePart& part) {
  const ImageWindow& data = part.data;
  const ImageWindow& display = part.display;
  return data.x > display.x || data.y > display.y ||
         data.x + data.extent.width < display.x + display.extent.width ||
         data.y + data.extent.height < display.y + display.extent.height;
}

Result<ChannelPlaces> find_channels(const std::string& path, const ImageHeader& header,
                                    const ChannelNames& names) {
  Search search(path, header);
  ChannelPlaces places;
  for (std::size_t i = 0; i < 3; ++i)
    places.colour[i] = search.find(names.colour[i]);
  if (header.find(names.colour[3])) places.colour[3] = search.find(names.colour[3]);
  if (names.has_velocity()) {
    for (std::size_t i = 0; i < 2; ++i)
      places.velocity[i] = search.find(names.velocity[i]);
  }
  if (names.has_depth()) places.depth = search.find(names.depth);
  if (names.has_reactive()) places.reactive = search.find(names.reactive);
  if (!search.status().ok()) return search.status();
  places.display = *search.display();
  places.background = !places.colour[3];
  for (const auto& place : places.colour)
    places.background &= !place || !leaves_pixels_open(header.parts[place->part]);
  for (const auto& place : places.colour)
    places.half_colour &= !place || header.at(*place).stored == ChannelType::kHalf;
  return places;
}

}  // namespace quincunx::tools
