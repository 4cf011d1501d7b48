// SPDX-License-Identifier: MIT
#include "frames/target_file.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <vector>

#include "render/view_math.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/record/exchange_attributes.h"

namespace quincunx::scenes {
namespace {

using tools::Attribute;
using tools::Channel;
using tools::ChannelType;

tools::Matrix to_attribute(const glm::mat4& matrix) {
  tools::Matrix values;
  std::copy_n(glm::value_ptr(matrix), values.size(), values.begin());
  return values;
}

std::vector<Attribute> attributes_of(const TargetFile& file) {
  const ViewMatrices matrices = view_of(file.camera, file.frame.view.aspect);
  std::vector<Attribute> attributes = tools::to_attributes(
      {.jitter = file.frame.view.jitter,
       .render = file.frame.view.render,
       .output = file.output,
       .index = file.frame.index,
       .reset = file.frame.reset,
       .near_plane = file.camera.near_plane,
       .depth_kind = file.linear_depth ? tools::DepthKind::kLinear : tools::DepthKind::kDeviceReversed,
       .world_to_ndc = to_attribute(matrices.clip_from_world()),
       // Colour of 8 bits went through it.
       .exposure = file.frame.targets.codes.empty() ? file.frame.view.display.exposure : 1});
  attributes.push_back({"quincunx:dt", static_cast<float>(1 / file.fps)});
  attributes.push_back({"worldToCamera", to_attribute(glm::mat4(matrices.camera_from_world))});
  attributes.push_back(
      {"framesPerSecond", tools::Rational{static_cast<int>(std::lround(file.fps * 1000)), 1000}});
  return attributes;
}

}  // namespace

std::vector<float> colour_of(const gl::TargetPixels& pixels) {
  std::vector<float> rgba;
  rgba.reserve(pixels.colour.size() + pixels.codes.size());
  for (std::size_t i = 0; i < pixels.codes.size(); ++i) {
    const float value = static_cast<float>(pixels.codes[i]) / 255;
    rgba.push_back(i % 4 == 3 ? value : tools::linear_of_srgb(value));
  }
  for (const std::uint16_t value : pixels.colour)
    rgba.push_back(glm::unpackHalf1x16(value));
  return rgba;
}

std::vector<float> depth_of(const TargetFile& file) {
  std::vector<float> z = file.frame.targets.depth;
  for (float& depth : z) {
    if (file.linear_depth) depth = tools::linear_z(depth, file.camera.near_plane);
  }
  return z;
}

std::vector<Vec2> velocity_of(const gl::TargetPixels& pixels) {
  std::vector<Vec2> velocity;
  velocity.reserve(pixels.velocity.size() / 2);
  for (std::size_t i = 0; i + 1 < pixels.velocity.size(); i += 2)
    velocity.push_back(
        {glm::unpackHalf1x16(pixels.velocity[i]), glm::unpackHalf1x16(pixels.velocity[i + 1])});
  return velocity;
}

std::vector<Vec2> backward_motion(const gl::TargetPixels& pixels) {
  std::vector<Vec2> motion = velocity_of(pixels);
  for (Vec2& vector : motion)
    vector = tools::backward_from_velocity(vector, pixels.render_extent);
  return motion;
}

std::vector<float> reactive_mask(const TargetFile& file) {
  std::vector<float> mask;
  mask.reserve(file.frame.targets.reactive.size());
  for (const std::uint8_t value : file.frame.targets.reactive)
    mask.push_back(static_cast<float>(value) / 255.0f);
  return mask;
}

void dilate_velocity(gl::TargetPixels& pixels) {
  const std::vector<std::uint16_t> own = pixels.velocity;
  const int width = pixels.render_extent.width, height = pixels.render_extent.height;
  const auto index = [width](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  for (int y = 0; y < height && !own.empty(); ++y) {
    for (int x = 0; x < width; ++x) {
      std::size_t nearest = index(x, y);
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
          if (pixels.depth[index(i, j)] > pixels.depth[nearest]) nearest = index(i, j);
      }
      std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(2 * nearest), 2,
                  pixels.velocity.begin() + static_cast<std::ptrdiff_t>(2 * index(x, y)));
    }
  }
}

Status write_targets(const std::string& path, const TargetFile& file) {
  std::vector<Channel> channels;
  const std::vector<float> colour = colour_of(file.frame.targets);
  for (std::size_t i = 0; i < 4; ++i) {
    channels.push_back({.name = tools::kColourChannels[i],
                        .type = ChannelType::kFloat,
                        .data = colour.data() + i,
                        .pixel_stride = 4 * sizeof(float)});
  }
  const std::vector<float> z = depth_of(file);
  channels.push_back({.name = tools::kDepthChannel,
                      .type = ChannelType::kFloat,
                      .data = z.data(),
                      .stored = ChannelType::kFloat});
  const auto add_motion = [&channels](const std::vector<std::string>& names,
                                      const std::vector<Vec2>& motion) {
    for (std::size_t i = 0; i < 2 && !motion.empty(); ++i) {
      channels.push_back({.name = names[i],
                          .type = ChannelType::kFloat,
                          .data = &motion.data()->x + i,
                          .pixel_stride = sizeof(Vec2),
                          .stored = ChannelType::kFloat});
    }
  };
  const std::vector<Vec2> backward = backward_motion(file.frame.targets);
  const std::vector<Vec2> forward = backward_motion(file.relative_to_next);
  add_motion(tools::kBackwardChannels, backward);
  add_motion(tools::kForwardChannels, forward);
  const std::vector<float> mask = reactive_mask(file);
  if (!mask.empty()) {
    channels.push_back({.name = tools::kReactiveChannel, .type = ChannelType::kFloat, .data = mask.data()});
  }
  return tools::write_exr(path, file.frame.targets.render_extent, channels, attributes_of(file));
}

Result<std::vector<float>> download_rgba(Device device, const ImageView& image, Extent extent) {
  std::vector<float> rgba(static_cast<std::size_t>(extent.area()) * 4);
  if (Status status = device.download(image, extent, rgba.data()); !status.ok()) return status;
  return rgba;
}

Result<PicturePresenter> PicturePresenter::create(const Device& device, Extent extent, ToneMap tone_map,
                                                  bool dither, float exposure) {
  ResolveSettings settings;
  settings.method = Method::kPoint;  // at scale 1 the identity
  settings.output_extent = settings.target_extent = extent;
  settings.colour = PixelFormat::kRGBA32F;
  settings.output.tone_map = tone_map;
  settings.output.dither = dither;
  auto plan = plan_for({}, settings);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(device, plan.value());
  if (!service.ok()) return service.status();
  auto linear = device.allocate(extent, PixelFormat::kRGBA32F);
  if (!linear.ok()) return linear.status();
  auto encoded = device.allocate(extent, PixelFormat::kRGBA8);
  if (!encoded.ok()) return encoded.status();
  return PicturePresenter(device, std::move(service).value(), std::move(linear).value(),
                          std::move(encoded).value(), exposure);
}

Result<std::vector<std::uint8_t>> PicturePresenter::present(const std::vector<float>& rgba) {
  const Extent extent = linear_.view().extent;
  if (Status status = device_.upload(linear_.view(), extent, rgba.data()); !status.ok()) return status;
  FrameInputs inputs;
  inputs.colour = linear_.view();
  inputs.render_extent = extent;
  inputs.exposure = exposure_;
  const FrameReport report = service_.dispatch(inputs, {.presented = encoded_.view()});
  if (!report.ok()) return report.status;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(extent.area()) * 4);
  if (Status status = device_.download(encoded_.view(), extent, pixels.data()); !status.ok()) return status;
  return pixels;
}

}  // namespace quincunx::scenes
