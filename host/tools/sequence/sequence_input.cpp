// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/image/display_light.h"
#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

bool has_all(const ImageHeader& header, const std::string& prefix, std::initializer_list<const char*> names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const char* name) { return header.find(prefix + name).has_value(); });
}

// One channel Y, without what would make it the luminance of a colour or a direction's second part.
bool is_grey(const ImageHeader& header, const std::string& prefix) {
  const auto others = {"R", "G", "B", "RY", "BY", "X"};
  return has_all(header, prefix, {"Y"}) && std::none_of(others.begin(), others.end(), [&](const char* name) {
           return header.find(prefix + name).has_value();
         });
}

std::string prefix_of(const std::string& layer) {
  return layer.empty() ? "" : layer + ".";
}

// Layers that hold a picture, in the file's order.
std::vector<std::string> colour_layers(const ImageHeader& header) {
  std::vector<std::string> layers;
  for (const ImagePart& part : header.parts) {
    for (const HeaderChannel& channel : part.channels) {
      const std::size_t dot = channel.name.rfind('.');
      const std::string layer = dot == std::string::npos ? part.name : channel.name.substr(0, dot);
      const std::string prefix = prefix_of(layer);
      const bool holds_picture = has_all(header, prefix, {"R", "G", "B"}) || is_grey(header, prefix);
      const bool known = layer.empty() || std::find(layers.begin(), layers.end(), layer) != layers.end();
      if (holds_picture && !known) layers.push_back(layer);
    }
  }
  return layers;
}

// How a sentence about missing colour ends.
std::string layers_text(const ImageHeader& header, const std::string& option) {
  std::string text;
  for (const std::string& layer : colour_layers(header))
    text += text.empty() ? fmt::format("; {} takes a layer of it: {}", option, layer) : ", " + layer;
  return text;
}

// Looks channels up one after another and keeps the first thing that is wrong.
class Search {
 public:
  Search(const std::string& path, const ImageHeader& header) : path_(path), header_(header) {}

  // `advice` ends the sentence where there is no such channel.
  std::optional<ChannelPlace> find(const std::string& name, const std::string& advice = "") {
    if (!status_.ok()) return std::nullopt;
    const auto place = header_.find(name);
    if (!place) {
      complain(fmt::format("has no channel '{}'; it has {}{}", name, header_.channel_names(), advice));
      return std::nullopt;
    }
    check(name, *place);
    return place;
  }

  const std::optional<ImageWindow>& display() const { return display_; }
  bool dwa() const { return dwa_; }
  const Status& status() const { return status_; }

 private:
  void check(const std::string& name, ChannelPlace place) {
    const ImagePart& part = header_.parts[place.part];
    dwa_ |= part.dwa;
    if (part.deep) {
      complain(fmt::format("holds deep pixels in channel '{}'; flat ones are needed", name));
    } else if (header_.at(place).integer) {
      complain(fmt::format("holds integers in channel '{}'; half or float is needed", name));
    } else if (const auto [x, y] = header_.at(place).sampling; x != 1 || y != 1) {
      complain(fmt::format("has channel '{}' subsampled {}x{}; render it at full size", name, x, y));
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
  bool dwa_ = false;
  Status status_;
};

Status settle_motion(const SequenceInput& input, const std::string& path, const ImageHeader& first,
                     const FrameAttributes& attributes, SequenceFormat& format) {
  const bool has_backward = first.find(kBackwardChannels[0]) && first.find(kBackwardChannels[1]);
  format.motion = input.motion;
  if (input.motion == MotionSource::kAutomatic)
    format.motion = has_backward ? MotionSource::kChannels : MotionSource::kNone;
  if (format.motion == MotionSource::kChannels) {
    const bool automatic = input.motion == MotionSource::kAutomatic;
    const auto& names = format.channels[InputPlane::kVelocity] =
        automatic ? kBackwardChannels : input.velocity;
    if (!input.units && names != kBackwardChannels) {
      return Status::invalid(
          fmt::format("--velocity {} needs --velocity-convention or --velocity-scale: what the values "
                      "mean cannot be seen from them",
                      fmt::join(names, ",")));
    }
    format.units = input.units.value_or(VelocityUnits{});
    format.units.jittered = input.velocity_jittered;
  }
  if (format.motion == MotionSource::kCamera && !attributes.world_to_ndc) {
    return Status::io(fmt::format("'{}' has no attribute 'worldToNDC', which --velocity camera needs", path));
  }
  return {};
}

// Channels of a layer that is called "albedo", or "Denoising Albedo" as Cycles has it; none where there is none.
std::vector<std::string> albedo_channels_in(const ImageHeader& header) {
  for (const std::string& layer : colour_layers(header)) {
    std::string name = layer.substr(layer.rfind('.') + 1);  // of all, where there is no dot
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool known = name == "albedo" || name == "denoising albedo";
    if (known && has_all(header, layer + ".", {"R", "G", "B"}))
      return {layer + ".R", layer + ".G", layer + ".B"};
  }
  return {};
}

// Channels of an input that are read if the command line names one, or if the file has those of the exchange format.
std::vector<std::string> optional_channels(const std::optional<std::string>& wanted, const InputImage& usual,
                                           const ImageHeader& first) {
  if (wanted) return wanted->empty() ? std::vector<std::string>() : std::vector{*wanted};
  std::vector<std::string> names;
  for (const char* name : usual.channels) {
    if (name == nullptr) break;
    if (!first.find(name)) return {};
    names.emplace_back(name);
  }
  return names;
}

}  // namespace

std::vector<std::string> colour_channels_in(const ImageHeader& header, const std::string& layer) {
  const std::string prefix = prefix_of(layer);
  if (is_grey(header, prefix)) return {prefix + "Y", prefix + "Y", prefix + "Y", prefix + "A"};
  return {prefix + "R", prefix + "G", prefix + "B", prefix + "A"};
}

std::string colour_text(const ChannelNames& names) {
  const auto& colour = names[InputPlane::kColour];
  if (colour[0] == colour[1]) return fmt::format("grey {},{}", colour[0], colour[3]);
  return fmt::format("colour {}", fmt::join(colour, ","));
}

bool leaves_pixels_open(const ImagePart& part) {
  const ImageWindow& data = part.data;
  const ImageWindow& display = part.display;
  return data.x > display.x || data.y > display.y ||
         data.x + data.extent.width < display.x + display.extent.width ||
         data.y + data.extent.height < display.y + display.extent.height;
}

Result<ChannelPlaces> find_channels(const std::string& path, const ImageHeader& header,
                                    const ChannelNames& names, const std::string& option) {
  Search search(path, header);
  ChannelPlaces places;
  const std::string advice = layers_text(header, option);
  for (std::size_t p = 0; p < kPlaneCount; ++p) {
    const auto plane = static_cast<InputPlane>(p);
    for (const std::string& name : names[plane]) {
      const bool is_alpha = plane == InputPlane::kColour && &name == &names[plane].back();
      if (is_alpha && !header.find(name)) {
        places[plane].push_back(std::nullopt);
      } else {
        places[plane].push_back(search.find(name, plane == InputPlane::kColour && !is_alpha ? advice : ""));
      }
    }
  }
  if (!search.status().ok()) return search.status();
  places.display = *search.display();
  places.dwa = search.dwa();
  places.background = !places[InputPlane::kColour].back();
  for (const auto& place : places[InputPlane::kColour])
    places.background &= !place || !leaves_pixels_open(header.parts[place->part]);
  for (const auto& place : places[InputPlane::kColour])
    places.half_colour &= !place || header.at(*place).stored == ChannelType::kHalf;
  return places;
}

namespace {

// Returns how many samples a pixel has, as Cycles says ("cycles.ViewLayer.samples"); 0 where it does not.
float samples_in(const ImageHeader& header) {
  for (const Attribute& attribute : header.attributes) {
    const std::string_view name = attribute.name;
    if (!name.starts_with("cycles.") || !name.ends_with(".samples")) continue;
    if (const auto* text = std::get_if<std::string>(&attribute.value))
      return static_cast<float>(number_in(*text).value_or(0));
  }
  return 0;
}

}  // namespace

Result<ImageReader> open_mask(const std::string& path, Extent render) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader;
  if (Status status = check_whole(path); !status.ok()) return Status::io("mask " + status.message());
  const ImagePart& part = reader->header().parts[0];
  const Extent found = part.display.extent;
  if (found != render) {
    return Status::io(fmt::format("mask '{}' is {}x{} pixels; its frame is {}x{}", path, found.width,
                                  found.height, render.width, render.height));
  }
  if (part.deep || part.channels[0].integer)
    return Status::io(fmt::format("mask '{}' is deep or holds integers; flat pixels are needed", path));
  return reader;
}

Result<SequenceFormat> settle(const SequenceInput& input, const std::string& first_path,
                              const ImageHeader& first, const FrameAttributes& attributes) {
  SequenceFormat format;
  format.channels[InputPlane::kColour] = colour_channels_in(first, input.colour_layer);
  format.colour_space = input.colour_space;
  if (const auto place = first.find(format.channels[InputPlane::kColour][0])) {
    const auto colour = InputColour::of(first_path, first.parts[place->part], input.colour_space);
    if (!colour.ok()) return colour.status();
    if (!colour->is_light()) format.converted_from = colour->name();
  }
  if (Status status = settle_motion(input, first_path, first, attributes, format); !status.ok())
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
    format.channels[plane] = optional_channels(wanted, image, first);
  }
  format.channels[InputPlane::kAlbedo] = albedo_channels_in(first);
  const bool goes_on = first.find(kForwardChannels[0]) && first.find(kForwardChannels[1]);
  format.next_velocity = input.next_velocity.value_or(goes_on ? kForwardChannels : format.next_velocity);
  format.depth_kind = input.depth_kind.value_or(attributes.depth_kind.value_or(DepthKind::kLinear));
  format.near_plane = input.near_plane.value_or(attributes.near_plane.value_or(kUnknownNear));
  format.jitter = input.jitter;
  format.jitter.settle(attributes);
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
    if (format.next_velocity == kForwardChannels)
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
  if (!format.converted_from.empty()) text += fmt::format(" from {}", format.converted_from);
  if (channels.has(InputPlane::kVelocity)) {
    text += fmt::format("; velocity {} {}", fmt::join(channels[InputPlane::kVelocity], ","),
                        name_of(format.units.convention));
    if (format.units.convention == VelocityConvention::kScale)
      text += fmt::format(" {},{}", format.units.scale.x, format.units.scale.y);
    if (format.units.jittered) text += ", jittered";
  } else if (format.motion == MotionSource::kCamera && channels.has(InputPlane::kDepth)) {
    text += "; velocity from depth and worldToNDC";
  }
  if (channels.has(InputPlane::kDepth)) {
    text += fmt::format("; depth {} {}", channels[InputPlane::kDepth].front(), name_of(format.depth_kind));
    if (format.depth_kind == DepthKind::kLinear) text += fmt::format(", near {}", format.near_plane);
  }
  for (std::size_t p = static_cast<std::size_t>(InputPlane::kReactive); p < kPlaneCount; ++p) {
    const auto plane = static_cast<InputPlane>(p);
    const char* name = plane == InputPlane::kAlbedo ? "albedo" : kInputs[p].name;
    if (channels.has(plane)) text += fmt::format("; {} {}", name, fmt::join(channels[plane], ","));
  }
  if (format.reactive_files) text += fmt::format("; reactive {}", format.reactive_files->text());
  if (format.two_way > 0) text += two_way_text(format);
  if (!format.cuts.empty()) text += fmt::format("; cuts before {}", fmt::join(format.cuts, ","));
  return text + fmt::format("; jitter {}", format.jitter.text());
}

}  // namespace quincunx::tools
