// SPDX-License-Identifier: MIT
#include "tools/record/recorded_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "src/plan/resources.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/image/image_reader.h"
#include "tools/record/exchange_attributes.h"

namespace quincunx::tools {
namespace {

constexpr FramePart kParts[] = {FramePart::kPicture, FramePart::kParticles, FramePart::kFadingFrom,
                                FramePart::kFocus, FramePart::kFocusMask};

const char* name_of(FramePart part) {
  constexpr const char* kNames[] = {"frame", "particles", "fading_from", "focus", "focus_mask"};
  return kNames[static_cast<std::size_t>(part)];
}

// An image of a part: where the inputs have it, and what it is.
struct PartImage {
  ImageView* view = nullptr;
  PixelFormat format = PixelFormat::kNone;
  Storage storage = Storage::kBuffer;
  std::array<const char*, 4> channels = {};

  std::size_t channel_count() const {
    return static_cast<std::size_t>(
        std::count_if(channels.begin(), channels.end(), [](auto name) { return name; }));
  }
};

// The viewport of a part's images; null: they have a fixed size.
Extent FrameInputs::*viewport_of(FramePart part) {
  if (part == FramePart::kPicture) return &FrameInputs::render_extent;
  return part == FramePart::kParticles ? &FrameInputs::particle_render_extent : nullptr;
}

// The images that the plan reads of a frame with a focus. `inputs` and `focus` are where their views are.
std::vector<PartImage> images_of(const ResolvePlan& plan, FramePart part, FrameInputs& inputs,
                                 FocusInputs& focus) {
  const ResolveSettings& settings = plan.settings;
  std::vector<PartImage> images;
  if (part == FramePart::kFocus) {
    if (const auto region = plan.focus_plan())
      return images_of(*region, FramePart::kPicture, focus.frame, focus);
  } else if (part == FramePart::kFocusMask && settings.focus.mask) {
    images.push_back({&focus.mask, PixelFormat::kR8, Storage::kBuffer, {kReactiveChannel.c_str()}});
  }
  for (const InputImage& input : kInputs) {
    if (part == FramePart::kFadingFrom && settings.control.fades && input.image == &FrameInputs::fading_from)
      images.push_back({&(inputs.*input.image), settings.output.linear, Storage::kBuffer, input.channels});
    const PlannedBuffer* planned = planned_for(plan, input);
    if (planned != nullptr && input.viewport == viewport_of(part))
      images.push_back({&(inputs.*input.image), planned->format, settings.targets.storage, input.channels});
  }
  return images;
}

// Whether the frame can have it at all; of others nothing is read or written.
bool is_of_focus(FramePart part) {
  return part == FramePart::kFocus || part == FramePart::kFocusMask;
}

// The extent in use of a part's images.
Extent extent_of(const ResolvePlan& plan, FramePart part, const FrameInputs& inputs,
                 const FocusInputs& focus) {
  if (part == FramePart::kFocus) return focus.frame.render_extent;
  if (part == FramePart::kFocusMask) return plan.settings.focus.extent;
  return part == FramePart::kFadingFrom ? plan.settings.output_extent : inputs.*viewport_of(part);
}

std::size_t row_bytes(PixelFormat format, Extent extent) {
  return static_cast<std::size_t>(extent.width) * bytes_per_pixel(format);
}

// Where the caller's first row is the lowest one.
void turn_rows(std::vector<std::byte>& texels, std::size_t row) {
  if (row == 0) return;
  for (std::size_t low = 0, high = texels.size(); low + row < high; low += row) {
    high -= row;
    std::swap_ranges(texels.begin() + static_cast<std::ptrdiff_t>(low),
                     texels.begin() + static_cast<std::ptrdiff_t>(low + row),
                     texels.begin() + static_cast<std::ptrdiff_t>(high));
  }
}

// ---- Files.

ChannelType stored_type(PixelFormat format) {
  const bool is_float =
      format == PixelFormat::kRGBA32F || format == PixelFormat::kRG32F || format == PixelFormat::kR32F;
  return is_float ? ChannelType::kFloat : ChannelType::kHalf;
}

bool is_codes(PixelFormat format) {
  return format == PixelFormat::kRGBA8 || format == PixelFormat::kR8;
}

// Codes become what the exchange format has: linear light, and values from 0 to 1. All of them lie so far apart that
// halves tell them from each other.
float value_of(std::uint8_t code, bool encoded) {
  const float value = static_cast<float>(code) / 255;
  return encoded ? linear_of_srgb(value) : value;
}

std::uint8_t code_of(float value, bool encoded) {
  static const auto light = [] {
    std::array<float, 256> all = {};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = value_of(static_cast<std::uint8_t>(i), true);
    return all;
  }();
  if (!encoded) return static_cast<std::uint8_t>(value > 0 ? std::min(value, 1.0f) * 255 + .5f : 0.0f);
  const auto above = std::lower_bound(light.begin(), light.end(), value);
  if (above == light.begin()) return 0;
  if (above == light.end()) return 255;
  const auto nearest = *above - value < value - *(above - 1) ? above : above - 1;
  return static_cast<std::uint8_t>(nearest - light.begin());
}

// Alpha is not encoded.
bool is_encoded(PixelFormat format, std::size_t index) {
  return format == PixelFormat::kRGBA8 && index % 4 != 3;
}

std::vector<float> values_of(const RecordedImage& image) {
  std::vector<float> values;
  if (!is_codes(image.format)) return values;
  for (std::size_t i = 0; i < image.texels.size(); ++i)
    values.push_back(value_of(static_cast<std::uint8_t>(image.texels[i]), is_encoded(image.format, i)));
  return values;
}

DepthKind depth_kind_of(DepthConvention depth) {
  switch (depth) {
    case DepthConvention::kLinear:
      return DepthKind::kLinear;
    case DepthConvention::kInfinite:
    case DepthConvention::kForward:
      return DepthKind::kDevice;
    case DepthConvention::kReversedInfinite:
    case DepthConvention::kReversed:
      break;
  }
  return DepthKind::kDeviceReversed;
}

// Nothing for the value that a field has by itself.
template <typename Value>
std::optional<Value> unless_default(const Value& value, const Value& by_itself = {}) {
  return value == by_itself ? std::nullopt : std::optional(value);
}

// Nothing for what is no number either: only fields that are not read may hold such.
std::optional<float> number(float value, float by_itself = 0) {
  return std::isfinite(value) ? unless_default(value, by_itself) : std::nullopt;
}

FrameAttributes attributes_of(const ResolvePlan& plan, const FrameInputs& inputs) {
  FrameAttributes all = {.jitter = inputs.jitter,
                         .render = inputs.render_extent,
                         .output = plan.settings.output_extent,
                         .index = static_cast<std::int64_t>(inputs.frame_index),
                         .reset = inputs.reset,
                         .near_plane = inputs.near_plane > 0 ? number(inputs.near_plane) : std::nullopt,
                         .far_plane = number(inputs.far_plane),
                         .picture = unless_default(inputs.output_extent),
                         .camera = inputs.camera.clip_to_previous_clip,
                         .exposure = number(inputs.exposure),
                         .parity = unless_default(inputs.parity),
                         .fade_weight = number(inputs.fade_weight, 1)};
  if (plan.velocity == VelocitySource::kTarget) all.velocity_scale = unless_default(inputs.velocity_scale);
  if (plan.reads_depth) all.depth_kind = depth_kind_of(plan.settings.conventions.depth);
  return all;
}

void apply(const FrameAttributes& all, FrameInputs& inputs) {
  inputs.jitter = all.jitter.value_or(inputs.jitter);
  inputs.output_extent = all.picture.value_or(inputs.output_extent);
  inputs.velocity_scale = all.velocity_scale.value_or(inputs.velocity_scale);
  inputs.near_plane = all.near_plane.value_or(inputs.near_plane);
  inputs.far_plane = all.far_plane.value_or(inputs.far_plane);
  inputs.camera.clip_to_previous_clip = all.camera.value_or(inputs.camera.clip_to_previous_clip);
  inputs.exposure = all.exposure.value_or(inputs.exposure);
  inputs.reset = all.reset.value_or(inputs.reset);
  inputs.parity = all.parity.value_or(inputs.parity);
  inputs.frame_index = static_cast<std::uint64_t>(all.index.value_or(0));
  inputs.fade_weight = all.fade_weight.value_or(inputs.fade_weight);
}

// "x y width height" of each, with semicolons between.
std::string rectangles_text(const FocusInputs& focus) {
  std::string text;
  for (int i = 0; i < focus.rectangle_count; ++i) {
    const Rectangle& r = focus.rectangles[static_cast<std::size_t>(i)];
    text += fmt::format("{}{} {} {} {}", i > 0 ? ";" : "", r.x, r.y, r.width, r.height);
  }
  return text;
}

bool read_rectangles(const std::string& text, FocusInputs& focus) {
  const char* at = text.c_str();
  for (Rectangle& r : focus.rectangles) {
    int length = 0;
    if (std::sscanf(at, "%d %d %d %d%n", &r.x, &r.y, &r.width, &r.height, &length) != 4) return false;
    ++focus.rectangle_count;
    at += length;
    if (*at == 0) return true;
    if (*at++ != ';') return false;
  }
  return false;
}

FrameAttributes attributes_of(const ResolvePlan& plan, FramePart part, const RecordedFrame& frame) {
  if (part == FramePart::kPicture) {
    FrameAttributes all = attributes_of(plan, frame.inputs);
    // One that is no number counts as 1, as 0 does.
    if (frame.exposure_image) all.exposure_image = number(*frame.exposure_image).value_or(0);
    return all;
  }
  if (part != FramePart::kFocus) return {};
  const FocusInputs& focus = *frame.focus;
  FrameAttributes all = attributes_of(plan, focus.frame);
  all.output = plan.settings.focus.extent;
  all.place = Vec2{static_cast<float>(focus.x), static_cast<float>(focus.y)};
  all.feather = unless_default(focus.feather);
  all.rectangles = unless_default(rectangles_text(focus));
  return all;
}

Status write_part(const std::string& path, const ResolvePlan& plan, FramePart part,
                  const RecordedFrame& frame) {
  const RecordedPart& recorded = frame[part];
  FrameInputs inputs;
  FocusInputs focus;
  const std::vector<PartImage> parts = images_of(plan, part, inputs, focus);
  std::vector<std::vector<float>> values;
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < recorded.images.size(); ++i) {
    const RecordedImage& image = recorded.images[i];
    values.push_back(values_of(image));
    const bool codes = is_codes(image.format);
    const ChannelType stored = stored_type(image.format);
    const ChannelType type = codes ? ChannelType::kFloat : stored;
    const std::size_t size = type == ChannelType::kFloat ? 4 : 2, count = parts[i].channel_count();
    const auto* first =
        codes ? reinterpret_cast<const std::byte*>(values.back().data()) : image.texels.data();
    for (std::size_t c = 0; c < count; ++c) {
      channels.push_back({.name = parts[i].channels[c],
                          .type = type,
                          .data = first + c * size,
                          .pixel_stride = count * size,
                          .stored = stored});
    }
  }
  return write_exr(path, recorded.extent, channels, to_attributes(attributes_of(plan, part, frame)));
}

// Nothing where the file has no such channels.
Result<std::optional<RecordedImage>> read_image(ImageReader& reader, const PartImage& wanted, Extent extent) {
  const bool codes = is_codes(wanted.format);
  const ChannelType type = codes ? ChannelType::kFloat : stored_type(wanted.format);
  const std::size_t size = type == ChannelType::kHalf ? 2 : 4;
  const std::size_t pixel = wanted.channel_count() * size;
  std::vector<std::byte> read(static_cast<std::size_t>(extent.area()) * pixel);
  std::vector<ChannelTarget> targets;
  for (std::size_t c = 0; c < wanted.channel_count(); ++c) {
    const auto place = reader.header().find(wanted.channels[c]);
    if (!place) return std::optional<RecordedImage>();
    targets.push_back(
        {*place, type, read.data() + c * size, pixel, pixel * static_cast<std::size_t>(extent.width)});
  }
  if (Status status = reader.read(targets); !status.ok()) return status;
  RecordedImage image = {.format = wanted.format, .texels = {}};
  if (!codes) {
    image.texels = std::move(read);
    return std::optional(std::move(image));
  }
  image.texels.resize(read.size() / size);
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    float value = 0;
    std::memcpy(&value, read.data() + i * sizeof value, sizeof value);
    image.texels[i] = static_cast<std::byte>(code_of(value, is_encoded(wanted.format, i)));
  }
  return std::optional(std::move(image));
}

Status read_part(const std::string& path, const ResolvePlan& plan, FramePart part, RecordedFrame& frame) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const auto attributes = frame_attributes(path, reader->header());
  if (!attributes.ok()) return attributes.status();
  const Extent extent = frame[part].extent = reader->header().parts.front().display.extent;
  if (part == FramePart::kPicture) {
    apply(*attributes, frame.inputs);
    frame.inputs.render_extent = extent;
    frame.exposure_image = attributes->exposure_image;
  } else if (part == FramePart::kParticles) {
    frame.inputs.particle_render_extent = extent;
  } else if (part == FramePart::kFocus) {
    FocusInputs& focus = frame.focus.emplace();
    apply(*attributes, focus.frame);
    focus.frame.render_extent = extent;
    const Vec2 place = attributes->place.value_or(Vec2{});
    focus.x = static_cast<int>(place.x);
    focus.y = static_cast<int>(place.y);
    focus.feather = attributes->feather.value_or(0);
    if (attributes->rectangles && !read_rectangles(*attributes->rectangles, focus)) {
      return Status::io(fmt::format(
          "'{}' has an attribute 'quincunx:rectangles' that is not X Y WIDTH HEIGHT of at most {}", path,
          FocusInputs::kMaxRectangles));
    }
  }
  FocusInputs of_focus;
  for (const PartImage& wanted : images_of(plan, part, frame.inputs, of_focus)) {
    auto image = read_image(*reader, wanted, extent);
    if (!image.ok()) return image.status();
    if (!image->has_value()) {
      return Status::io(fmt::format("'{}' has no channel '{}', which these settings read; it has {}", path,
                                    wanted.channels.front(), reader->header().channel_names()));
    }
    frame[part].images.push_back(std::move(**image));
  }
  return {};
}

}  // namespace

std::string path_of(const std::string& folder, FramePart part, std::int64_t number) {
  return (std::filesystem::path(folder) / fmt::format("{}.{:04}.exr", name_of(part), number)).string();
}

bool is_frame_file(const std::string& name) {
  return std::any_of(std::begin(kParts), std::end(kParts), [&](FramePart part) {
    const std::string before = fmt::format("{}.", name_of(part)), after = ".exr";
    if (!name.starts_with(before) || !name.ends_with(after) || name.size() <= before.size() + after.size())
      return false;
    const std::string number = name.substr(before.size(), name.size() - before.size() - after.size());
    return number.find_first_not_of("0123456789") == std::string::npos;
  });
}

FrameInputs without_images(FrameInputs inputs) {
  for (const InputImage& input : kInputs)
    inputs.*input.image = {};
  return inputs;
}

Result<RecordedFrame> download(const Device& device, const ResolvePlan& plan, const FrameInputs& inputs,
                               const FocusInputs* focus) {
  RecordedFrame frame;
  FrameInputs given = inputs;
  FocusInputs given_focus = focus != nullptr ? *focus : FocusInputs();
  for (const FramePart part : kParts) {
    if (is_of_focus(part) && focus == nullptr) continue;
    const Extent extent = frame[part].extent = extent_of(plan, part, given, given_focus);
    for (const PartImage& image : images_of(plan, part, given, given_focus)) {
      if (!*image.view) continue;  // a picture to fade from need not be there
      const std::size_t row = row_bytes(image.format, extent);
      RecordedImage read = {image.format,
                            std::vector<std::byte>(row * static_cast<std::size_t>(extent.height))};
      if (Status status = device.download(*image.view, extent, read.texels.data()); !status.ok())
        return status;
      if (plan.settings.conventions.origin == Origin::kBottom) turn_rows(read.texels, row);
      frame[part].images.push_back(std::move(read));
    }
  }
  if (inputs.exposure_image) {
    float factor = 0;
    if (Status status = device.download(inputs.exposure_image, {1, 1}, &factor); !status.ok()) return status;
    frame.exposure_image = factor;
  }
  frame.inputs = without_images(inputs);
  if (focus == nullptr) return frame;
  frame.focus = *focus;
  frame.focus->frame = without_images(focus->frame);
  frame.focus->mask = {};
  return frame;
}

Result<UploadedFrame> upload(const Device& device, const ResolvePlan& plan, const RecordedFrame& frame) {
  UploadedFrame uploaded = {.inputs = frame.inputs, .focus = frame.focus};
  const auto put = [&](Extent extent, const RecordedImage& image, Storage storage,
                       ImageView& view) -> Status {
    const std::size_t row = row_bytes(image.format, extent);
    std::vector<std::byte> texels = image.texels;
    if (plan.settings.conventions.origin == Origin::kBottom) turn_rows(texels, row);
    auto made = device.allocate(extent, image.format, storage);
    if (!made.ok()) return made.status();
    view = made->view();
    uploaded.images.push_back(std::move(made).value());
    return device.upload(view, extent, texels.data());
  };
  FocusInputs none;
  FocusInputs& focus = uploaded.focus ? *uploaded.focus : none;
  for (const FramePart part : kParts) {
    const RecordedPart& recorded = frame[part];
    const std::vector<PartImage> images = images_of(plan, part, uploaded.inputs, focus);
    for (std::size_t i = 0; i < recorded.images.size(); ++i) {
      if (Status status = put(recorded.extent, recorded.images[i], images[i].storage, *images[i].view);
          !status.ok())
        return status;
    }
  }
  if (frame.exposure_image) {
    RecordedImage texel = {PixelFormat::kR32F, std::vector<std::byte>(sizeof(float))};
    std::memcpy(texel.texels.data(), &*frame.exposure_image, sizeof(float));
    if (Status status = put({1, 1}, texel, Storage::kBuffer, uploaded.inputs.exposure_image); !status.ok())
      return status;
  }
  return uploaded;
}

Status write_frame(const std::string& folder, std::int64_t number, const ResolvePlan& plan,
                   const RecordedFrame& frame) {
  std::vector<std::string> written;
  // Whoever sees the picture's file finds the others.
  for (std::size_t i = kFrameParts; i-- > 0;) {
    const FramePart part = kParts[i];
    if (frame[part].images.empty()) continue;
    const std::string path = path_of(folder, part, number);
    Status status = write_part(path, plan, part, frame);
    if (!status.ok()) {
      std::error_code ignored;
      for (const std::string& other : written)
        std::filesystem::remove(other, ignored);
      return status;
    }
    written.push_back(path);
  }
  return {};
}

Result<RecordedFrame> read_recorded_frame(const std::string& folder, std::int64_t number,
                                          const ResolvePlan& plan) {
  RecordedFrame frame;
  FocusInputs none;
  for (const FramePart part : kParts) {
    if (images_of(plan, part, frame.inputs, none).empty()) continue;
    const std::string path = path_of(folder, part, number);
    const bool need_not_be = is_of_focus(part) || part == FramePart::kFadingFrom;
    std::error_code error;
    if (need_not_be && !std::filesystem::exists(path, error)) continue;
    if (Status status = read_part(path, plan, part, frame); !status.ok()) return status;
  }
  return frame;
}

}  // namespace quincunx::tools
