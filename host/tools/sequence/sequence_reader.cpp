// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace quincunx::tools {
namespace {

constexpr std::uint16_t kHalfOne = 0x3c00;
constexpr const char* kKeptAttributes[] = {"worldToCamera", "worldToNDC", "FramesPerSecond", "chromaticities",
                                           "PixelAspectRatio"};

// Sets the alpha of every pixel that the file has.
template <typename Texel>
void fill_alpha(std::vector<std::byte>& colour, const ImagePart& part, Texel value) {
  auto* texels = reinterpret_cast<Texel*>(colour.data());
  const int left = part.data.x - part.display.x;
  const int top = part.data.y - part.display.y;
  const Extent extent = part.display.extent;
  for (int y = std::max(top, 0); y < std::min(top + part.data.extent.height, extent.height); ++y) {
    for (int x = std::max(left, 0); x < std::min(left + part.data.extent.width, extent.width); ++x)
      texels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.width) +
              static_cast<std::size_t>(x)) *
                 4 +
             3] = value;
  }
}

// The targets of one file's channels in the frame's memory.
class Targets {
 public:
  explicit Targets(Extent extent) : extent_(extent) {}

  void add(const std::optional<ChannelPlace>& place, ChannelType type, void* data, std::size_t pixel_stride) {
    if (place) targets_.push_back({*place, type, data, pixel_stride, pixel_stride * extent_.width});
  }

  const std::vector<ChannelTarget>& all() const { return targets_; }

 private:
  Extent extent_;
  std::vector<ChannelTarget> targets_;
};

// Whether pixels of the display window lie outside some channel's data window.
bool leave_pixels_open(const ImageHeader& header, const std::vector<ChannelTarget>& targets) {
  return std::any_of(targets.begin(), targets.end(), [&](const ChannelTarget& target) {
    return leaves_pixels_open(header.parts[target.from.part]);
  });
}

// NaN counts as 0, as everywhere.
std::uint8_t reactive_value(float mask) {
  return static_cast<std::uint8_t>(mask > 0 ? std::min(mask, 1.0f) * 255.0f + 0.5f : 0.0f);
}

void allocate(SequenceFrame& frame, const ChannelNames& names, std::size_t colour_texel) {
  const auto pixels = static_cast<std::size_t>(frame.render.area());
  frame.colour.resize(pixels * 4 * colour_texel);
  frame.velocity.resize(names.has_velocity() ? pixels : 0);
  frame.depth.resize(names.has_depth() ? pixels : 0);
  frame.reactive.resize(names.has_reactive() ? pixels : 0);
}

void clear(SequenceFrame& frame, DepthKind depth_kind, std::vector<float>& mask) {
  std::fill(frame.colour.begin(), frame.colour.end(), std::byte{0});
  std::fill(frame.velocity.begin(), frame.velocity.end(), Vec2{});
  std::fill(frame.depth.begin(), frame.depth.end(), nothing_seen(depth_kind));
  std::fill(mask.begin(), mask.end(), 0.0f);
}

Status read_pixels(ImageReader& reader, const ChannelPlaces& places, const SequenceFormat& format,
                   ChannelType colour_type, SequenceFrame& frame) {
  const std::size_t texel = colour_type == ChannelType::kHalf ? 2 : 4;
  std::vector<float> mask(frame.reactive.size());
  Targets targets(frame.render);
  for (std::size_t i = 0; i < 4; ++i)
    targets.add(places.colour[i], colour_type, frame.colour.data() + i * texel, 4 * texel);
  for (std::size_t i = 0; i < 2 && !frame.velocity.empty(); ++i)
    targets.add(places.velocity[i], ChannelType::kFloat, &frame.velocity.data()->x + i, sizeof(Vec2));
  targets.add(places.depth, ChannelType::kFloat, frame.depth.data(), sizeof(float));
  targets.add(places.reactive, ChannelType::kFloat, mask.data(), sizeof(float));
  if (leave_pixels_open(reader.header(), targets.all())) clear(frame, format.depth_kind, mask);
  if (Status status = reader.read(targets.all()); !status.ok()) return status;
  std::transform(mask.begin(), mask.end(), frame.reactive.begin(), reactive_value);
  return {};
}

Status read_unguarded(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                      PixelFormat colour, SequenceFrame& frame) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const auto places = find_channels(path, reader->header(), format.channels);
  if (!places.ok()) return places.status();
  if (places->display.extent != expected.render)
    return Status::io(fmt::format("'{}' has changed its size while the sequence was read", path));
  const auto attributes = frame_attributes(path, reader->header());
  if (!attributes.ok()) return attributes.status();

  const ChannelType type = colour == PixelFormat::kRGBA16F ? ChannelType::kHalf : ChannelType::kFloat;
  frame.number = expected.number;
  frame.render = expected.render;
  frame.world_to_ndc = attributes->world_to_ndc;
  frame.kept.clear();
  for (const char* name : kKeptAttributes) {
    if (const Attribute* attribute = reader->header().attribute(name)) frame.kept.push_back(*attribute);
  }
  allocate(frame, format.channels, type == ChannelType::kHalf ? sizeof(std::uint16_t) : sizeof(float));
  if (Status status = read_pixels(reader.value(), places.value(), format, type, frame); !status.ok())
    return status;
  if (!places->colour[3]) {
    const ImagePart& part = reader->header().parts[places->colour[0]->part];
    if (type == ChannelType::kHalf) {
      fill_alpha(frame.colour, part, kHalfOne);
    } else {
      fill_alpha(frame.colour, part, 1.0f);
    }
  }
  to_velocity(format.units, frame.render, frame.velocity);
  to_reversed_depth(format.depth_kind, format.near_plane, frame.depth);
  return {};
}

}  // namespace

Status read_frame(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                  PixelFormat colour, SequenceFrame& frame) {
  try {
    return read_unguarded(path, format, expected, colour, frame);
  } catch (const std::exception& problem) {  // no memory
    return Status::io(fmt::format("'{}' cannot be read: {}", path, problem.what()));
  }
}

}  // namespace quincunx::tools
