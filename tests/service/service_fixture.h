// SPDX-License-Identifier: MIT
// A service over images of its own, fed from host memory: the common ground of the service tests. Where the settings
// place targets, two halves of one allocation hold images of just each frame's size in turn.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "quincunx/resolve_service.h"

namespace quincunx::testing {

using Pixel = std::array<float, 4>;

// The pictures of one frame in the formats of the default plan, but with float velocity and with float colour or, where
// the settings ask for it, RGBA8.
struct HostFrame {
  Extent render = {};
  Extent output = {};
  Vec2 jitter = {};
  std::function<Pixel(int x, int y)> colour = [](int, int) { return Pixel{0, 0, 0, 1}; };
  std::function<Vec2(int x, int y)> velocity = [](int, int) { return Vec2{}; };
  std::function<float(int x, int y)> depth = [](int, int) { return 0.5f; };
  std::function<std::uint8_t(int x, int y)> reactive = [](int, int) { return std::uint8_t{0}; };
  CameraMotion camera = {};
  bool reset = false;
  int parity = 0;
  float exposure = 0;
};

using Codes = std::array<std::uint8_t, 4>;

// RGBA8 colour of linear light; what is not in [0, 1], as poison is not, becomes the largest code.
inline Codes codes_of(const Pixel& light) {
  Codes codes = {};
  for (std::size_t c = 0; c < 4; ++c) {
    const double x = light[c] >= 0 && light[c] <= 1 ? static_cast<double>(light[c]) : 1;
    const double encoded = c == 3 ? x : x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    codes[c] = static_cast<std::uint8_t>(std::lround(255 * encoded));
  }
  return codes;
}

// Shared, because a device keeps the programs that were built on it: PoCL takes longer to look one up than such a
// small frame does. Never destroyed, as some OpenCL layers are gone before static objects are.
inline const Device& shared_device() {
  static const Device* const opened = new Device(Device::open().value());
  return *opened;
}

class ServiceRig {
 public:
  ServiceRig(const SceneNeeds& needs, Method method, Extent output, Extent target)
      : ServiceRig(needs, {.method = method}, output, target) {}

  // Sets the extents and formats of `settings` itself.
  ServiceRig(const SceneNeeds& needs, ResolveSettings settings, Extent output, Extent target)
      : ServiceRig(shared_device(), needs, settings, output, target) {}

  // On a device of the test's own.
  ServiceRig(const Device& device, const SceneNeeds& needs, ResolveSettings settings, Extent output,
             Extent target)
      : device_(device) {
    settings.output_extent = output;
    settings.target_extent = target;
    if (settings.colour != PixelFormat::kRGBA8) settings.colour = PixelFormat::kRGBA32F;
    settings.velocity = PixelFormat::kRG32F;
    settings.output.dither = false;
    plan_ = plan_for(needs, settings).value();
    auto service = ResolveService::create(device_, plan_);
    EXPECT_TRUE(service.ok()) << service.status().message();
    service_.emplace(std::move(service).value());
    for (Slot& slot : slots_) {
      if (places()) break;
      for (const auto& [image, format] : planes_of(slot))
        *image = device_.allocate(target, format, settings.targets.storage).value();
    }
    if (places())
      memory_ = device_.allocate({static_cast<int>(2 * half_bytes()), 1}, PixelFormat::kR8).value();
    resolved_ = device_.allocate(output, settings.output.linear).value();
    presented_ = device_.allocate(output, PixelFormat::kRGBA8, plan_.presented_storage()).value();
  }

  // Puts a picture into the slot that the next upload() will use, and leaves that slot next.
  void flood(const HostFrame& frame) { fill_slot(slots_[count_ % slots_.size()], frame); }

  // Placed targets: sets every byte of the half that the next upload() will use.
  void flood_half(std::uint8_t byte) {
    ImageView half = memory_.view();
    half.extent.width = static_cast<int>(half_bytes());
    half.offset = count_ % 2 * half_bytes();
    const std::vector<std::uint8_t> bytes(half_bytes(), byte);
    EXPECT_TRUE(device_.upload(half, half.extent, bytes.data()).ok());
  }

  // Uploads a frame into the next slot; what lies outside the viewport keeps whatever was there.
  FrameInputs upload(const HostFrame& frame) {
    Slot& slot = slots_[count_ % slots_.size()];
    if (places()) place(slot, frame.render);
    ++count_;
    fill_slot(slot, frame);
    FrameInputs inputs;
    inputs.colour = slot.colour.view();
    inputs.velocity = slot.velocity.view();
    inputs.depth = slot.depth.view();
    inputs.reactive = slot.reactive.view();
    inputs.render_extent = frame.render;
    inputs.output_extent = frame.output;
    inputs.jitter = frame.jitter;
    inputs.camera = frame.camera;
    inputs.reset = frame.reset;
    inputs.exposure = frame.exposure;
    inputs.parity = frame.parity;
    inputs.frame_index = count_ - 1;
    return inputs;
  }

  FrameReport dispatch(const FrameInputs& inputs) {
    return service_->dispatch(inputs, {resolved_.view(), presented_.view()});
  }

  std::vector<Pixel> resolve(const HostFrame& frame) {
    const FrameReport report = dispatch(upload(frame));
    EXPECT_TRUE(report.ok()) << report.status.message();
    return resolved();
  }

  // The displayed picture where the output is dynamic.
  std::vector<Pixel> resolved() {
    const Extent output = plan_.settings.output_extent;
    std::vector<Pixel> pixels(static_cast<std::size_t>(output.area()));
    EXPECT_TRUE(device_.download(resolved_.view(), output, pixels.data()).ok());
    return pixels;
  }

  std::vector<std::uint8_t> presented() {
    const Extent output = plan_.settings.output_extent;
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(output.area()) * 4);
    EXPECT_TRUE(device_.download(presented_.view(), output, pixels.data()).ok());
    return pixels;
  }

  Device& device() { return device_; }
  ResolveService& service() { return *service_; }
  ImageView resolved_view() const { return resolved_.view(); }
  ImageView presented_view() const { return presented_.view(); }

 private:
  struct Slot {
    Image colour, velocity, depth, reactive;
  };

  bool places() const { return plan_.settings.targets.placement == Targets::kPlaced; }

  std::array<std::pair<Image*, PixelFormat>, 4> planes_of(Slot& slot) const {
    return {{{&slot.colour, plan_.settings.colour},
             {&slot.velocity, plan_.settings.velocity},
             {&slot.depth, PixelFormat::kR32F},
             {&slot.reactive, PixelFormat::kR8}}};
  }

  // Planes of the largest size, each from a multiple of 16.
  std::size_t half_bytes() const {
    return static_cast<std::size_t>(plan_.settings.target_extent.area()) * 29 + 64;
  }

  void place(Slot& slot, Extent render) {
    std::size_t offset = count_ % 2 * half_bytes();
    for (const auto& [image, format] : planes_of(slot)) {
      offset = (offset + 15) / 16 * 16;
      if (plan_.settings.targets.storage == Storage::kImage) {
        *image = device_.allocate(render, format, Storage::kImage).value();
      } else {
        *image = Image::borrow(
            {.memory = memory_.view().memory, .format = format, .extent = render, .offset = offset});
      }
      offset += static_cast<std::size_t>(plan_.settings.target_extent.area()) * bytes_per_pixel(format);
    }
  }

  void fill_slot(Slot& slot, const HostFrame& frame) {
    if (plan_.settings.colour == PixelFormat::kRGBA8) {
      fill<Codes>(slot.colour, frame.render, [&](int x, int y) { return codes_of(frame.colour(x, y)); });
    } else {
      fill<Pixel>(slot.colour, frame.render, frame.colour);
    }
    fill<Vec2>(slot.velocity, frame.render, frame.velocity);
    fill<float>(slot.depth, frame.render, frame.depth);
    fill<std::uint8_t>(slot.reactive, frame.render, frame.reactive);
  }

  template <typename T>
  void fill(const Image& image, Extent render, const std::function<T(int, int)>& value) {
    std::vector<T> texels;
    texels.reserve(static_cast<std::size_t>(render.area()));
    for (int y = 0; y < render.height; ++y) {
      for (int x = 0; x < render.width; ++x)
        texels.push_back(value(x, y));
    }
    EXPECT_TRUE(device_.upload(image.view(), render, texels.data()).ok());
  }

  Device device_;
  ResolvePlan plan_;
  std::optional<ResolveService> service_;
  std::array<Slot, 3> slots_;
  Image memory_;  // memory of placed targets
  Image resolved_;
  Image presented_;
  std::uint64_t count_ = 0;
};

// Makes a frame of any size from 1x1 to `target`, of noise with a bright spot, moving anywhere: in a row of them
// nothing stays the same.
inline HostFrame random_frame(std::mt19937& random, Extent target) {
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const auto unit = [&] { return static_cast<float>(random() % 4096) / 4096; };
  const auto salt = static_cast<unsigned>(random());
  const auto noise = [salt](int x, int y, int c) {
    const unsigned mixed = (static_cast<unsigned>(x) * 73856093u) ^ (static_cast<unsigned>(y) * 19349663u) ^
                           (static_cast<unsigned>(c) * 83492791u) ^ salt;
    return static_cast<float>((mixed * 2654435761u) >> 16) / 65536;
  };
  HostFrame frame;
  frame.render = {1 + below(target.width), 1 + below(target.height)};
  frame.jitter = {unit() - .5f, unit() - .5f};
  frame.colour = [=](int x, int y) {
    const float bright = noise(x, y, 3) > .995f ? 65504.f : 1.f;
    return Pixel{bright * noise(x, y, 0), noise(x, y, 1), -noise(x, y, 2), 1};
  };
  const float speed = std::ldexp(1.f, -below(20));
  frame.velocity = [=](int x, int y) { return Vec2{speed * (noise(x, y, 4) - .5f), speed * noise(x, y, 5)}; };
  frame.depth = [=](int x, int y) { return noise(x / 4, y / 4, 6); };
  frame.reactive = [=](int x, int y) { return static_cast<std::uint8_t>(noise(x, y, 7) > .8f ? 200 : 0); };
  frame.reset = below(50) == 0;
  return frame;
}

}  // namespace quincunx::testing
