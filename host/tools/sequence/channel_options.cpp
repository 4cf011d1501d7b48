// SPDX-License-Identifier: MIT
#include "tools/sequence/channel_options.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

// "A,B" into two words that are not empty.
std::array<std::string, 2> split_pair(const std::string& option, const std::string& text,
                                      const std::string& example) {
  const std::size_t comma = text.find(',');
  const bool good = comma != std::string::npos && comma > 0 && comma + 1 < text.size() &&
                    text.find(',', comma + 1) == std::string::npos;
  if (!good) throw UsageError{option, fmt::format("'{}' is not two with a comma between; {}", text, example)};
  return {text.substr(0, comma), text.substr(comma + 1)};
}

float parse_float(const std::string& option, const std::string& text) {
  const float value = static_cast<float>(number_in(text).value_or(NAN));
  if (!std::isfinite(value)) throw UsageError{option, fmt::format("'{}' is no number", text)};
  return value;
}

void set_velocity(SequenceInput& input, const std::string& text) {
  if (text == "none" || text == "camera") {
    input.motion = text == "none" ? MotionSource::kNone : MotionSource::kCamera;
    return;
  }
  input.motion = MotionSource::kChannels;
  input.velocity = split_pair("--velocity", text, "write U,V, or none, or camera");
}

void add_motion_options(CommandLine& app, ResolveOptions& options) {
  SequenceInput& input = options.sequence;
  static const std::map<std::string, DrawnVelocity> kDrawnVelocities = {{"own", DrawnVelocity::kOwn},
                                                                        {"dilated", DrawnVelocity::kDilated}};
  static const std::map<std::string, VelocityConvention> kConventions = {
      {"nuke", VelocityConvention::kNuke},
      {"blender", VelocityConvention::kBlender},
      {"fsr2", VelocityConvention::kFsr2},
      {"ndc", VelocityConvention::kNdc}};
  app.add_option_function<std::string>(
         "--velocity", [&input](const std::string& text) { set_velocity(input, text); },
         "Motion's channels; camera: from depth and worldToNDC; none (default: backward.u,backward.v, if "
         "any)")
      .type_name("U,V");
  add_choice(
      app, "--velocity-convention", kConventions,
      "What motion means: nuke and blender (previous - current, pixels, up), fsr2 (the same, down), ndc "
      "(current - previous, -1 to 1, up)",
      [&input](VelocityConvention convention) {
        input.units = VelocityUnits{convention, {1, 1}};
      });
  app.add_option_function<std::string>(
         "--velocity-scale",
         [&input](const std::string& text) {
           const auto parts = split_pair("--velocity-scale", text, "write for example -0.5,0.5");
           input.units = VelocityUnits{
               VelocityConvention::kScale,
               {parse_float("--velocity-scale", parts[0]), parse_float("--velocity-scale", parts[1])}};
         },
         "Or: what makes motion current - previous in parts of the image, y down")
      .type_name("X,Y")
      .excludes("--velocity-convention");
  add_choice(app, "--drawn-velocity", options.resolve.drawn_velocity, kDrawnVelocities,
             "Whose motion a pixel has: its own surface's, or dilated, that of the nearest of its 3x3 "
             "(default: own)");
}

}  // namespace

void add_channel_options(CommandLine& app, ResolveOptions& options) {
  SequenceInput& input = options.sequence;
  static const std::map<std::string, DepthKind> kDepthKinds = {
      {"linear", DepthKind::kLinear},
      {"device", DepthKind::kDevice},
      {"device-reversed", DepthKind::kDeviceReversed}};
  const auto channel = [](std::optional<std::string>& target) {
    return [&target](const std::string& name) { target = name == "none" ? "" : name; };
  };
  app.add_option("--colour,--color", input.colour_layer,
                 "Layer of colour: R, G, B, A of LAYER (default: without layer)")
      .type_name("LAYER");
  add_motion_options(app, options);
  app.add_option_function<std::string>("--depth", channel(input.depth),
                                       "Depth's channel, or none (default: Z, if any)")
      .type_name("CHANNEL");
  add_choice(app, "--depth-kind", input.depth_kind, kDepthKinds,
             "linear (distance along the view axis), device (far is 1) or device-reversed (far is 0)");
  app.add_option_function<float>(
         "--near", [&input](float distance) { input.near_plane = distance; },
         "Near plane's distance, of linear depth (default: attribute quincunx:near)")
      .positive()
      .type_name("D");
  app.add_option_function<std::string>(
         "--reactive", channel(input.reactive),
         "Channel that is 1 where history lies, or none (default: reactive.mask)")
      .type_name("CHANNEL");
  app.add_option("--jitter", options.jitter,
                 "attribute, none, quincunx, quincunx-half, halton or a file of FRAME X Y (default: the "
                 "attribute, if any)")
      .type_name("NAME|FILE");
}

}  // namespace quincunx::tools
