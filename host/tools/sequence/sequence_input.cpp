// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_input.h"

#include <fmt/format.h>

namespace quincunx::tools {
namespace {

Status settle_motion(const SequenceInput& input, const std::string& path, const ImageHeader& first,
                     const FrameAttributes& attributes, SequenceFormat& format) {
  const bool has_backward = first.find(kBackwardChannels[0]) && first.find(kBackwardChannels[1]);
  format.motion = input.motion;
  if (input.motion == MotionSource::kAutomatic)
    format.motion = has_backward ? MotionSource::kChannels : MotionSource::kNone;
  if (format.motion == MotionSource::kChannels) {
    const bool automatic = input.motion == MotionSource::kAutomatic;
    format.channels.velocity = automatic ? kBackwardChannels : input.velocity;
    if (!input.units && format.channels.velocity != kBackwardChannels) {
      return Status::invalid(
          fmt::format("--velocity {},{} needs --velocity-convention or --velocity-scale: what the values "
                      "mean cannot be seen from them",
                      format.channels.velocity[0], format.channels.velocity[1]));
    }
    format.units = input.units.value_or(VelocityUnits{});
  }
  if (format.motion == MotionSource::kCamera && !attributes.world_to_ndc) {
    return Status::io(fmt::format("'{}' has no attribute 'worldToNDC', which --velocity camera needs", path));
  }
  return {};
}

// A channel that is read if the command line names it, or if it has its usual name.
std::string optional_channel(const std::optional<std::string>& wanted, const std::string& usual,
                             const ImageHeader& first) {
  if (wanted) return *wanted;
  return first.find(usual) ? usual : "";
}

}  // namespace

Result<SequenceFormat> settle(const SequenceInput& input, const std::string& first_path,
                              const ImageHeader& first, const FrameAttributes& attributes) {
  SequenceFormat format;
  format.channels.colour = colour_channels_in(first, input.colour_layer);
  if (Status status = settle_motion(input, first_path, first, attributes, format); !status.ok())
    return status;
  format.channels.depth = optional_channel(input.depth, kDepthChannel, first);
  format.channels.reactive = optional_channel(input.reactive, kReactiveChannel, first);
  format.depth_kind = input.depth_kind.value_or(attributes.depth_kind.value_or(DepthKind::kLinear));
  format.near_plane = input.near_plane.value_or(attributes.near_plane.value_or(kUnknownNear));
  format.jitter = input.jitter;
  format.jitter.settle(attributes);
  if (!input.output && !attributes.output) {
    return Status::invalid(fmt::format(
        "--output is missing, and '{}' has no attribute 'quincunx:outputSize' that could stand for it",
        first_path));
  }
  format.output = input.output ? *input.output : *attributes.output;
  return format;
}

Vec2 SequenceFormat::ratio_of(Extent render) const {
  return {static_cast<float>(render.width) / static_cast<float>(output.width),
          static_cast<float>(render.height) / static_cast<float>(output.height)};
}

SceneNeeds needs_of(const SequenceFormat& format) {
  SceneNeeds needs;
  needs.moving_objects = format.motion == MotionSource::kChannels;
  needs.camera_motion = format.motion != MotionSource::kNone;
  needs.transparents = format.channels.has_reactive();
  needs.background = format.background;
  return needs;
}

Status keep_what_is_read(SequenceFormat& format, const ResolvePlan& plan) {
  ChannelNames& channels = format.channels;
  if (plan.reads_depth && !channels.has_depth()) {
    const std::string reader = plan.blurs()                ? "motion blur"
                               : plan.undilates_velocity() ? "--drawn-velocity dilated"
                               : plan.moves_far() ? fmt::format("--far {}", name_of(plan.settings.far))
                                                  : fmt::format("method {}", name_of(plan.settings.method));
    return Status::io(fmt::format("{} reads depth here, but the frames have no channel '{}'; say --depth",
                                  reader, kDepthChannel));
  }
  if (plan.velocity != VelocitySource::kTarget) channels.velocity = {};
  if (!plan.reads_depth) channels.depth.clear();
  if (!plan.reads_reactive) channels.reactive.clear();
  format.needs_camera = plan.reads_camera();
  return {};
}

std::string summary_of(const SequenceFormat& format) {
  const ChannelNames& channels = format.channels;
  std::string text = colour_text(channels);
  if (channels.has_velocity()) {
    text += fmt::format("; velocity {},{} {}", channels.velocity[0], channels.velocity[1],
                        name_of(format.units.convention));
    if (format.units.convention == VelocityConvention::kScale)
      text += fmt::format(" {},{}", format.units.scale.x, format.units.scale.y);
  } else if (format.motion == MotionSource::kCamera && channels.has_depth()) {
    text += "; velocity from depth and worldToNDC";
  }
  if (channels.has_depth()) {
    text += fmt::format("; depth {} {}", channels.depth, name_of(format.depth_kind));
    if (format.depth_kind == DepthKind::kLinear) text += fmt::format(", near {}", format.near_plane);
  }
  if (channels.has_reactive()) text += fmt::format("; reactive {}", channels.reactive);
  return text + fmt::format("; jitter {}", format.jitter.text());
}

}  // namespace quincunx::tools
