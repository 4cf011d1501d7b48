// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tools/image/display_light.h"
#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

// Gives `channels` those of `names` that go with the picture. Where there are none they are `names`, for
// find_channels() to say so, or nothing where nobody has asked for them.
Status settle_channels(const std::string& path, const ImageHeader& first, const Picture& picture, bool asked,
                       const std::vector<std::string>& names, std::vector<std::string>& channels) {
  auto found = channels_beside(path, first, picture, names, asked);
  if (!found.ok()) return found.status();
  channels = std::move(found).value();
  for (std::size_t i = 0; asked && channels.size() < names.size(); ++i)
    channels.push_back(picture.view.empty() ? names[i] : picture.view + "." + names[i]);
  return {};
}

Status settle_motion(const SequenceInput& input, const std::string& path, const ImageHeader& first,
                     const FrameAttributes& attributes, const Picture& picture, SequenceFormat& format) {
  format.motion = input.motion;
  const bool automatic = input.motion == MotionSource::kAutomatic;
  if (automatic || input.motion == MotionSource::kChannels) {
    const std::vector<std::string>& names = automatic ? kBackwardChannels : input.velocity;
    auto& channels = format.channels[InputPlane::kVelocity];
    if (Status status = settle_channels(path, first, picture, !automatic, names, channels); !status.ok())
      return status;
    format.motion = channels.empty() ? MotionSource::kNone : MotionSource::kChannels;
    if (!input.units && names != kBackwardChannels) {
      return Status::invalid(
          fmt::format("--velocity {} needs --velocity-convention or --velocity-scale: what the values "
                      "mean cannot be seen from them",
                      fmt::join(names, ",")));
    }
    if (!channels.empty()) {
      format.units = input.units.value_or(VelocityUnits{});
      format.units.offset = input.velocity_offset;
      format.units.jittered = input.velocity_jittered;
    }
  }
  if (format.motion == MotionSource::kCamera && !attributes.world_to_ndc) {
    return Status::io(fmt::format("'{}' has no attribute 'worldToNDC', which --velocity camera needs", path));
  }
  return {};
}

// The names of an input in the exchange format.
std::vector<std::string> usual_names(const InputImage& input) {
  return {input.channels.begin(), std::find(input.channels.begin(), input.channels.end(), nullptr)};
}

// Returns how many samples a pixel has, as Cycles says ("cycles.ViewLayer.samples"); 0 where it does not.
float samples_in(const ImageHeader& header) {
  for (const Attribute& attribute : header.parts[0].attributes) {
    const std::string_view name = attribute.name;
    if (!name.starts_with("cycles.") || !name.ends_with(".samples")) continue;
    if (const auto* text = std::get_if<std::string>(&attribute.value))
      return static_cast<float>(number_in(*text).value_or(0));
  }
  return 0;
}

}  // namespace

Result<Mask> open_mask(const std::string& path, Extent render, const std::string& view) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  if (Status status = check_whole(path); !status.ok()) return Status::io("mask " + status.message());
  ChannelNames names;
  names[InputPlane::kColour].assign(3, first_of_view(reader->header(), view));
  const auto places = find_channels(path, reader->header(), names);
  if (!places.ok()) return Status::io("mask " + places.status().message());
  const Extent found = places->display.extent;
  if (found != render) {
    return Status::io(fmt::format("mask '{}' is {}x{} pixels; its frame is {}x{}", path, found.width,
                                  found.height, render.width, render.height));
  }
  return Mask{std::move(reader).value(), *(*places)[InputPlane::kColour][0]};
}

Result<SequenceFormat> settle(const SequenceInput& input, const std::string& first_path,
                              const ImageHeader& first, const FrameAttributes& attributes) {
  SequenceFormat format;
  const auto picture = choose_picture(first_path, first, input.picture);
  if (!picture.ok()) return picture.status();
  format.channels[InputPlane::kColour] = picture->channels;
  format.view = picture->view;
  format.colour_space = input.colour_space;
  const auto light = InputColour::of(first_path, first.parts[picture->part], input.colour_space);
  if (!light.ok()) return light.status();
  if (light->is_news()) format.converted_from = light->name();
  if (Status status = settle_motion(input, first_path, first, attributes, picture.value(), format);
      !status.ok())
    return status;
  const auto masks = FramePattern::parse(input.reactive.value_or(""), "pattern of masks");
  if (masks.ok() && masks->has_number()) format.reactive_files = masks.value();
  for (const InputImage& image : kInputs) {
    const InputPlane plane = plane_of(image);
    if (image.viewport != &FrameInputs::render_extent || plane <= InputPlane::kVelocity) continue;
    if (plane == InputPlane::kReactive && format.reactive_files) continue;
    const auto wanted = plane == InputPlane::kDepth      ? input.depth
                        : plane == InputPlane::kReactive ? input.reactive
                                                         : std::nullopt;
    if (wanted == "") continue;
    if (Status status =
            settle_channels(first_path, first, picture.value(), wanted.has_value(),
                            wanted ? std::vector{*wanted} : usual_names(image), format.channels[plane]);
        !status.ok())
      return status;
  }
  format.channels[InputPlane::kAlbedo] = albedo_beside(first, picture.value());
  if (Status status = settle_channels(first_path, first, picture.value(), input.next_velocity.has_value(),
                                      input.next_velocity.value_or(kForwardChannels), format.next_velocity);
      !status.ok())
    return status;
  format.depth_kind = input.depth_kind.value_or(attributes.depth_kind.value_or(DepthKind::kLinear));
  format.depth_range = input.depth_range;
  format.near_plane = input.near_plane.value_or(attributes.near_plane.value_or(kUnknownNear));
  const Extent size = first.parts[picture->part].display.extent;
  if (attributes.world_to_ndc)
    format.camera = input.camera.value_or(sense_of(*attributes.world_to_ndc, size));
  format.ignored = attributes.foreign;
  if (!input.jitter.text().empty()) std::erase(format.ignored, "jitter");
  format.jitter = input.jitter;
  format.jitter.settle(attributes);
  format.has_exposure = attributes.exposure.has_value();
  format.cuts = input.cuts;
  if (!input.output && !attributes.output) {
    return Status::invalid(fmt::format(
        "--output is missing, and '{}' has no attribute 'quincunx:outputSize' that could stand for it",
        first_path));
  }
  format.output = input.output ? *input.output : *attributes.output;
  format.samples = samples_in(first);
  return format;
}

float output_aspect(float aspect, Extent render, Extent output) {
  constexpr double kRounding = 1.5;  // pixels of a frame by which its sides may be off
  const double width = render.width, height = render.height;
  const double shape = static_cast<double>(output.width) / output.height;
  const auto fits = [&](double wider) {
    return std::abs(width - height * shape / wider) <= kRounding ||
           std::abs(height - width * wider / shape) <= kRounding;
  };
  if (output == Extent{} || fits(1)) return aspect;
  return fits(aspect) ? 1 : static_cast<float>(aspect * width / height / shape);
}

SceneNeeds needs_of(const SequenceFormat& format) {
  SceneNeeds needs;
  needs.moving_objects = format.motion == MotionSource::kChannels;
  needs.camera_motion = format.motion != MotionSource::kNone;
  needs.transparents = format.has_reactive();
  needs.background = format.background;
  return needs;
}

Status keep_what_is_read(SequenceFormat& format, const ResolvePlan& plan) {
  ChannelNames& channels = format.channels;
  if (plan.reads_depth && !channels.has(InputPlane::kDepth)) {
    const std::string reader =
        plan.blurs()                ? "motion blur"
        : plan.undilates_velocity() ? "--drawn-velocity dilated"
        : plan.moves_sky() ? fmt::format("--sky-motion {}", name_of(plan.settings.conventions.sky_motion))
                           : fmt::format("method {}", name_of(plan.settings.method));
    return Status::io(fmt::format("{} reads depth here, but the frames have no channel '{}'; say --depth",
                                  reader, kDepthChannel));
  }
  for (const InputImage& input : kInputs) {
    if (input.viewport != nullptr && planned_for(plan, input) == nullptr) channels[plane_of(input)].clear();
  }
  if (!plan.reads_reactive) format.reactive_files.reset();
  format.needs_camera = plan.reads_camera();
  return {};
}

Status settle_two_way(const SequenceInput& input, const ResolvePlan& plan, SequenceFormat& format) {
  format.next_units = format.units;
  if (plan.velocity == VelocitySource::kNone) {
    format.next_motion = NextMotion::kNothing;
  } else if (plan.velocity == VelocitySource::kCamera) {
    format.next_motion = NextMotion::kCamera;
  } else if (!format.next_velocity.empty()) {
    format.next_motion = NextMotion::kChannels;
    // The format's own channels say where a surface goes, others where it comes from, as those of velocity do.
    if (input.next_velocity.value_or(kForwardChannels) == kForwardChannels)
      format.next_units = {.jittered = format.units.jittered};
    else
      format.next_units.to_next = true;
  } else {
    format.next_motion = NextMotion::kTurned;
  }
  const bool possible = plan.accumulates() && plan.settings.temporal.view == TemporalView::kPicture;
  const bool known = format.next_motion == NextMotion::kChannels || format.next_motion == NextMotion::kCamera;
  format.two_way = input.two_way.value_or(possible && known ? kDefaultAhead : 0);
  const bool denoises = format.two_way > 0 && plan.settings.temporal.noise > 0;
  if (!denoises) format.channels[InputPlane::kAlbedo].clear();
  if (format.two_way > 0 && !possible) {
    return Status::invalid(
        fmt::format("--two-way merges the histories of method temporal, and this is {}; say --two-way 0",
                    plan.accumulates() ? "a view of one" : name_of(plan.settings.method)));
  }
  return {};
}

SequenceFormat backward_format(const SequenceFormat& format) {
  SequenceFormat backward = format;
  backward.units = format.next_units;
  if (format.next_motion == NextMotion::kChannels)
    backward.channels[InputPlane::kVelocity] = format.next_velocity;
  return backward;
}

namespace {

std::string two_way_text(const SequenceFormat& format) {
  const std::string ahead = fmt::format("; both ways, {} frames ahead", format.two_way);
  if (format.next_motion == NextMotion::kTurned) return ahead + " by their own motion, turned round";
  if (format.next_motion != NextMotion::kChannels) return ahead;
  return ahead + fmt::format(" by {}", fmt::join(format.next_velocity, ","));
}

}  // namespace

std::string summary_of(const SequenceFormat& format) {
  if (!format.recording.empty()) return "a recording, by its settings";
  const ChannelNames& channels = format.channels;
  std::string text = colour_text(channels);
  if (!format.view.empty()) text += fmt::format(" of view {}", format.view);
  if (!format.converted_from.empty()) text += fmt::format(" from {}", format.converted_from);
  if (channels.has(InputPlane::kVelocity)) {
    text += fmt::format("; velocity {} {}", fmt::join(channels[InputPlane::kVelocity], ","),
                        name_of(format.units.convention));
    if (format.units.convention == VelocityConvention::kScale)
      text += fmt::format(" {},{}", format.units.scale.x, format.units.scale.y);
    if (const Vec2 offset = format.units.offset; offset != Vec2{})
      text += fmt::format(" about {},{}", offset.x, offset.y);
    if (format.units.jittered) text += ", jittered";
  } else if (format.motion == MotionSource::kCamera && channels.has(InputPlane::kDepth)) {
    text += "; velocity from depth and worldToNDC";
  }
  if (format.camera != CameraSense{}) text += fmt::format("; worldToNDC {}", text_of(format.camera));
  if (channels.has(InputPlane::kDepth)) {
    text += fmt::format("; depth {} {}", channels[InputPlane::kDepth].front(), name_of(format.depth_kind));
    if (const Vec2 range = format.depth_range; range != kWholeRange)
      text += fmt::format(" from {} to {}", range.x, range.y);
    if (format.depth_kind == DepthKind::kLinear) text += fmt::format(", near {}", format.near_plane);
  }
  for (std::size_t p = static_cast<std::size_t>(InputPlane::kReactive); p < kPlaneCount; ++p) {
    const auto plane = static_cast<InputPlane>(p);
    const char* name = plane == InputPlane::kAlbedo ? "albedo" : kInputs[p].name;
    if (channels.has(plane)) text += fmt::format("; {} {}", name, fmt::join(channels[plane], ","));
  }
  if (format.reactive_files) text += fmt::format("; reactive {}", format.reactive_files->text());
  if (format.two_way > 0) text += two_way_text(format);
  if (format.has_exposure) text += "; exposure attribute";
  if (!format.cuts.empty()) text += fmt::format("; cuts before {}", fmt::join(format.cuts, ","));
  return text + fmt::format("; jitter {}", format.jitter.text());
}

}  // namespace quincunx::tools
