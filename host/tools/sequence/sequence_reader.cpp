// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_reader.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <utility>

#include "tools/image/display_light.h"
#include "tools/record/exchange_format.h"

namespace quincunx::tools {
namespace {

constexpr std::uint16_t kHalfOne = 0x3c00;
constexpr const char* kKeptAttributes[] = {"worldToCamera",  "worldToNDC",       "framesPerSecond",
                                           "chromaticities", "pixelAspectRatio", "owner",
                                           "timeCode",       "comments"};

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
std::uint8_t code_of(float value) {
  return static_cast<std::uint8_t>(value > 0 ? std::min(value, 1.0f) * 255.0f + 0.5f : 0.0f);
}

// Returns the format of a plane's texels.
PixelFormat format_of(InputPlane plane, PixelFormat colour) {
  if (plane == InputPlane::kVelocity) return PixelFormat::kRG32F;
  if (plane == InputPlane::kAlbedo) return colour;
  const InputImage& input = kInputs[static_cast<std::size_t>(plane)];
  return input.format != PixelFormat::kNone ? input.format : colour;
}

// As InputConventions::velocity_jittered has it: a motion of exactly 0 is none that was drawn.
void take_jitter(std::span<Vec2> velocity, Vec2 step) {
  for (Vec2& v : velocity) {
    if (v != Vec2{}) v = {v.x + step.x, v.y + step.y};
  }
}

Status read_pixels(ImageReader& reader, const ChannelPlaces& places, const SequenceFormat& format,
                   PixelFormat colour, SequenceFrame& frame) {
  const auto pixels = static_cast<std::size_t>(frame.render.area());
  PerPlane<std::vector<float>> values;  // of planes that have codes
  Targets targets(frame.render);
  for (std::size_t p = 0; p < kPlaneCount; ++p) {
    const auto plane = static_cast<InputPlane>(p);
    const PixelFormat texels = format_of(plane, colour);
    const bool is_codes = texels == PixelFormat::kR8;
    const bool is_half = texels == PixelFormat::kRGBA16F;
    const bool is_read = plane == InputPlane::kReactive ? format.has_reactive() : format.channels.has(plane);
    frame.texels[plane].resize(is_read ? pixels * bytes_per_pixel(texels) : 0);
    values[plane].resize(is_read && is_codes ? pixels : 0);
    auto* first = is_codes ? reinterpret_cast<std::byte*>(values[plane].data()) : frame.texels[plane].data();
    for (std::size_t i = 0; i < places[plane].size(); ++i) {
      targets.add(places[plane][i], is_half ? ChannelType::kHalf : ChannelType::kFloat,
                  first + i * (is_half ? 2 : 4), is_codes ? sizeof(float) : bytes_per_pixel(texels));
    }
  }
  if (leave_pixels_open(reader.header(), targets.all())) {
    for (std::vector<std::byte>& texels : frame.texels.values)
      std::fill(texels.begin(), texels.end(), std::byte{0});
    std::fill(frame.velocity().begin(), frame.velocity().end(), format.units.offset);
    std::fill(frame.depth().begin(), frame.depth().end(),
              format.depth_range == kWholeRange ? nothing_seen(format.depth_kind)
                                                : std::numeric_limits<float>::quiet_NaN());
  }
  if (Status status = reader.read(targets.all()); !status.ok()) return status;
  if (format.reactive_files) {
    auto file = open_mask(format.reactive_files->expand(frame.number), frame.render, format.view);
    if (!file.ok()) return file.status();
    const std::size_t row = sizeof(float) * static_cast<std::size_t>(frame.render.width);
    const ChannelTarget target = {file->place, ChannelType::kFloat, values[InputPlane::kReactive].data(),
                                  sizeof(float), row};
    if (Status status = file->reader.read({&target, 1}); !status.ok()) return status;
  }
  for (std::size_t p = 0; p < kPlaneCount; ++p) {
    std::transform(values.values[p].begin(), values.values[p].end(), frame.texels.values[p].begin(),
                   [](float value) { return std::byte{code_of(value)}; });
  }
  return {};
}

// Converts colour and albedo to linear Rec. 709, which the frame's attributes then tell.
void make_light(const InputColour& light, PixelFormat colour, SequenceFrame& frame) {
  for (std::vector<std::byte>* image :
       {&frame.texels[InputPlane::kColour], &frame.texels[InputPlane::kAlbedo]}) {
    if (colour == PixelFormat::kRGBA32F) {
      light.apply({reinterpret_cast<float*>(image->data()), image->size() / sizeof(float)});
      continue;
    }
    auto* halves = reinterpret_cast<half*>(image->data());
    std::vector<float> rgba(halves, halves + image->size() / sizeof(half));
    light.apply(rgba);
    std::copy(rgba.begin(), rgba.end(), halves);
  }
  for (Attribute& attribute : frame.kept)
    if (attribute.name == "chromaticities") attribute.value = kRec709;
}

Status read_unguarded(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                      PixelFormat colour, SequenceFrame& frame) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const auto places = find_channels(path, reader->header(), format.channels);
  if (!places.ok()) return places.status();
  if (places->display.extent != expected.render)
    return Status::io(fmt::format("'{}' has changed its size while the sequence was read", path));
  const int picture_part = places->picture_part();
  const ImagePart& part = reader->header().parts[picture_part];
  const auto attributes = frame_attributes(path, reader->header(), picture_part);
  if (!attributes.ok()) return attributes.status();

  frame.number = expected.number;
  frame.render = expected.render;
  frame.exposure = attributes->exposure.value_or(0);
  frame.world_to_ndc = attributes->world_to_ndc;
  if (frame.world_to_ndc) frame.world_to_ndc = to_screen(*frame.world_to_ndc, format.camera);
  frame.kept.clear();
  for (const char* name : kKeptAttributes) {
    if (const Attribute* attribute = reader->header().attribute(name, picture_part))
      frame.kept.push_back(*attribute);
  }
  if (expected.output != format.output) {  // else the frames ask for its shape
    const float aspect = output_aspect(expected.pixel_aspect, frame.render, format.output);
    if (std::erase_if(frame.kept, [](const Attribute& kept) { return kept.name == "pixelAspectRatio"; }) >
            0 ||
        aspect != 1)
      frame.kept.push_back({"pixelAspectRatio", aspect});
  }
  if (Status status = read_pixels(reader.value(), places.value(), format, colour, frame); !status.ok())
    return status;
  if (!(*places)[InputPlane::kColour].back()) {
    if (colour == PixelFormat::kRGBA16F) {
      fill_alpha(frame.texels[InputPlane::kColour], part, kHalfOne);
    } else {
      fill_alpha(frame.texels[InputPlane::kColour], part, 1.0f);
    }
  }
  const auto light = InputColour::of(path, part, format.colour_space);
  if (!light.ok()) return light.status();
  if (!light->is_light()) make_light(light.value(), colour, frame);
  to_velocity(format.units, frame.render, frame.velocity());
  if (format.units.jittered)
    take_jitter(frame.velocity(), format.units.to_next ? expected.jitter_until : expected.jitter_since);
  scale_depth(format.depth_range, format.depth_kind, frame.depth());
  const auto negative =
      std::count_if(frame.depth().begin(), frame.depth().end(), [](float d) { return d < 0; });
  frame.negative_depth = 2 * negative > std::ssize(frame.depth());
  to_reversed_depth(format.depth_kind, format.near_plane, frame.depth());
  return {};
}

constexpr int kCell = 16;  // pixels

// The jitter shifts a picture by a pixel at most in x and in y. That changes the mean of a cell of values in [0, 1] by
// no more than 2 kCell / kCell^2: what changes more has moved, or other light falls on it.
constexpr float kMostByJitter = 2.0f / kCell;

// As far_velocity.cl has it: depths up to this are infinitely far away.
constexpr float kFarDepth = 1e-9f;

float tone_mapped(float value) {
  return value > 0 ? 1 - 1 / (1 + value) : 0;  // NaN is 0
}

bool is_at_rest(Vec2 motion) {
  return motion.x == 0 && motion.y == 0;
}

// Where the previous frame had a point of this one that is infinitely far away; both in normalised coordinates.
Vec2 previous_place(const CameraMotion& motion, Vec2 at) {
  const auto& m = motion.clip_to_previous_clip;
  const float w = m[3] * at.x + m[7] * at.y + m[15];
  return {(m[0] * at.x + m[4] * at.y + m[12]) / w, (m[1] * at.x + m[5] * at.y + m[13]) / w};
}

// How far the camera's turning moves the sky, in pixels, at the most of five places of the picture.
float sky_motion(const CameraMotion& motion, Extent render) {
  float most = 0;
  for (const Vec2 at : {Vec2{0, 0}, Vec2{.7f, .7f}, Vec2{-.7f, .7f}, Vec2{.7f, -.7f}, Vec2{-.7f, -.7f}}) {
    const Vec2 was = previous_place(motion, at);
    const float x = (at.x - was.x) * static_cast<float>(render.width) / 2;
    const float y = (at.y - was.y) * static_cast<float>(render.height) / 2;
    most = std::max(most, std::hypot(x, y));
  }
  return most;
}

}  // namespace

Status read_recorded(const std::string& folder, const ScannedFrame& expected, const ResolvePlan& plan,
                     SequenceFrame& frame) {
  try {
    auto recorded = read_recorded_frame(folder, expected.number, plan);
    if (!recorded.ok()) return recorded.status();
    frame.number = expected.number;
    frame.render = recorded->inputs.render_extent;
    frame.recorded = std::move(recorded).value();
    return {};
  } catch (const std::exception& problem) {  // no memory
    return Status::io(
        fmt::format("frame {} of '{}' cannot be read: {}", expected.number, folder, problem.what()));
  }
}

Status read_frame(const std::string& path, const SequenceFormat& format, const ScannedFrame& expected,
                  PixelFormat colour, SequenceFrame& frame) {
  try {
    return read_unguarded(path, format, expected, colour, frame);
  } catch (const std::exception& problem) {  // no memory
    return Status::io(fmt::format("'{}' cannot be read: {}", path, problem.what()));
  }
}

std::vector<Vec2> turned_motion(const MotionSamples& now, const MotionSamples& next) {
  constexpr float kDepthsApart = .2f;    // of the larger: other surfaces
  constexpr float kSamplesApart = 20.f;  // as bad as depths that differ by all
  constexpr float kReach = .75f;         // samples: more than half, as surfaces may come nearer
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const Extent to = now.render, from = next.render;
  std::vector<Vec2> turned(static_cast<std::size_t>(to.area()), {kUnknown, kUnknown});
  std::vector<float> worst(turned.size(), std::numeric_limits<float>::max());  // of what was found so far
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const auto source = static_cast<std::size_t>(y) * from.width + static_cast<std::size_t>(x);
      const Vec2 velocity = next.velocity[source];
      const float u =
          (static_cast<float>(x) + .5f + next.jitter.x) / static_cast<float>(from.width) - velocity.x;
      const float v =
          (static_cast<float>(y) + .5f + next.jitter.y) / static_cast<float>(from.height) - velocity.y;
      const float at_x = u * static_cast<float>(to.width) - .5f - now.jitter.x;
      const float at_y = v * static_cast<float>(to.height) - .5f - now.jitter.y;
      if (!(at_x > -1 && at_x < static_cast<float>(to.width) && at_y > -1 &&
            at_y < static_cast<float>(to.height)))
        continue;
      for (int i = 0; i < 4; ++i) {
        const int column = static_cast<int>(std::floor(at_x)) + i % 2,
                  row = static_cast<int>(std::floor(at_y)) + i / 2;
        if (column < 0 || row < 0 || column >= to.width || row >= to.height) continue;
        const auto target = static_cast<std::size_t>(row) * to.width + static_cast<std::size_t>(column);
        const float here = now.depth[target], there = next.depth[source];
        const float larger = std::max(here, there);
        const float apart = larger > 0 ? std::abs(here - there) / larger : 0;
        const float dx = at_x - static_cast<float>(column), dy = at_y - static_cast<float>(row);
        const float bad = dx * dx + dy * dy + kSamplesApart * kSamplesApart * apart * apart;
        const bool reaches = std::abs(dx) <= kReach && std::abs(dy) <= kReach;
        if (!(reaches && apart <= kDepthsApart && bad < worst[target])) continue;
        worst[target] = bad;
        turned[target] = {-velocity.x, -velocity.y};
      }
    }
  }
  return turned;
}

std::vector<std::string> SequenceWatch::see(const SequenceFrame& frame, bool reset) {
  std::vector<std::string> sentences = {see_motion(frame, reset), see_sky(frame, reset), see_depth(frame)};
  std::erase(sentences, "");
  last_world_to_ndc_ = frame.world_to_ndc;
  return sentences;
}

std::string SequenceWatch::see_motion(const SequenceFrame& frame, bool reset) {
  if (motion_is_known_ || frame.velocity().empty()) return {};
  motion_is_known_ = !std::all_of(frame.velocity().begin(), frame.velocity().end(), is_at_rest);
  if (motion_is_known_) return {};
  Cells now = cells_of(frame);
  if (reset || !first_ || first_->render != frame.render) {
    first_ = std::move(now);
    return {};
  }
  for (std::size_t i = 0; i < now.means.size(); ++i)
    motion_is_known_ |= std::abs(now.means[i] - first_->means[i]) > kMostByJitter;
  if (!motion_is_known_) return {};
  return fmt::format(
      "motion is 0 in every pixel of frames {} to {}, although their pictures differ: if the renderer "
      "blurs motion itself, as Blender can, it writes none; turn that off",
      first_->number, now.number);
}

std::string SequenceWatch::see_sky(const SequenceFrame& frame, bool reset) {
  constexpr float kLeastMotion = .25f;  // pixels
  constexpr int kLeastPart = 100;       // one pixel of so many
  const bool asked = plan_.settings.conventions.sky_motion == SkyMotion::kAsDrawn && !sky_is_known_ && !reset;
  if (!asked || !frame.world_to_ndc || !last_world_to_ndc_ || frame.velocity().empty() ||
      frame.depth().empty())
    return {};
  const auto camera = camera_motion(*frame.world_to_ndc, *last_world_to_ndc_, near_plane_);
  if (!camera || !(sky_motion(*camera, frame.render) >= kLeastMotion)) return {};
  std::size_t resting = 0;
  for (std::size_t i = 0; i < frame.depth().size(); ++i)
    resting += frame.depth()[i] <= kFarDepth && is_at_rest(frame.velocity()[i]) ? 1 : 0;
  if (resting * kLeastPart < frame.depth().size()) return {};
  sky_is_known_ = true;
  return fmt::format(
      "the sky of frame {} has a motion of 0, although the camera turns: --sky-motion camera moves it",
      frame.number);
}

std::string SequenceWatch::see_depth(const SequenceFrame& frame) {
  if (depth_is_known_ || frame.depth().empty()) return {};
  depth_is_known_ = true;
  if (!frame.negative_depth) return {};
  return fmt::format(
      "depth is negative in most pixels of frame {}, so they count as infinitely far, or as near as can be: "
      "--depth-range 0,-1 turns its sign, 0.5,1 is for device depth from -1 to 1",
      frame.number);
}

SequenceWatch::Cells SequenceWatch::cells_of(const SequenceFrame& frame) const {
  const bool half = plan_.settings.colour == PixelFormat::kRGBA16F;
  const auto value = [&](std::size_t index) {
    std::uint16_t bits = 0;
    float number = 0;
    if (half) {
      std::memcpy(&bits, frame.texels[InputPlane::kColour].data() + index * sizeof bits, sizeof bits);
      return tone_mapped(imath_half_to_float(bits));
    }
    std::memcpy(&number, frame.texels[InputPlane::kColour].data() + index * sizeof number, sizeof number);
    return tone_mapped(number);
  };
  const int across = frame.render.width / kCell, down = frame.render.height / kCell;
  Cells cells = {frame.number, frame.render, std::vector<float>(static_cast<std::size_t>(across) * down)};
  for (int y = 0; y < down * kCell; ++y) {
    for (int x = 0; x < across * kCell; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * frame.render.width + static_cast<std::size_t>(x);
      float& mean =
          cells.means[static_cast<std::size_t>(y / kCell) * across + static_cast<std::size_t>(x / kCell)];
      for (std::size_t c = 0; c < 3; ++c)
        mean += value(pixel * 4 + c) / (3.0f * kCell * kCell);
    }
  }
  return cells;
}

}  // namespace quincunx::tools
