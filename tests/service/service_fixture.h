// SPDX-License-Identifier: MIT
// A service over images of its own, fed from host memory: the common ground of the service tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "quincunx/resolve_service.h"

namespace quincunx::testing {

using Pixel = std::array<float, 4>;

// The pictures of one frame in the formats of the default plan, but with float colour and velocity.
struct HostFrame {
  Extent render = {};
  Vec2 jitter = {};
  std::function<Pixel(int x, int y)> colour = [](int, int) { return Pixel{0, 0, 0, 1}; };
  std::function<Vec2(int x, int y)> velocity = [](int, int) { return Vec2{}; };
  std::function<float(int x, int y)> depth = [](int, int) { return 0.5f; };
  std::function<std::uint8_t(int x, int y)> reactive = [](int, int) { return std::uint8_t{0}; };
  CameraMotion camera = {};
  bool reset = false;
};

class ServiceRig {
 public:
  ServiceRig(const SceneNeeds& needs, Method method, Extent output, Extent target)
      : ServiceRig(needs, {.method = method}, output, target) {}

  // Sets the extents and formats of `settings` itself.
  ServiceRig(const SceneNeeds& needs, ResolveSettings settings, Extent output, Extent target)
      : device_(Device::open().value()) {
    settings.output = output;
    settings.target = target;
    settings.colour = PixelFormat::kRGBA32F;
    settings.velocity = PixelFormat::kRG32F;
    settings.dither = false;
    plan_ = plan_for(needs, settings).value();
    auto service = ResolveService::create(device_, plan_);
    EXPECT_TRUE(service.ok()) << service.status().message();
    service_.emplace(std::move(service).value());
    for (Slot& slot : slots_) {
      slot.colour = device_.allocate(target, settings.colour).value();
      slot.velocity = device_.allocate(target, settings.velocity).value();
      slot.depth = device_.allocate(target, PixelFormat::kR32F).value();
      slot.reactive = device_.allocate(target, PixelFormat::kR8).value();
    }
    resolved_ = device_.allocate(output, settings.resolved).value();
    presented_ = device_.allocate(output, PixelFormat::kRGBA8).value();
  }

  // Puts a picture into the slot that the next upload() will use, and leaves that slot next.
  void flood(const HostFrame& frame) { fill_slot(slots_[count_ % slots_.size()], frame); }

  // Uploads a frame into the next slot; what lies outside the viewport keeps whatever was there.
  FrameInputs upload(const HostFrame& frame) {
    Slot& slot = slots_[count_++ % slots_.size()];
    fill_slot(slot, frame);
    FrameInputs inputs;
    inputs.colour = slot.colour.view();
    inputs.velocity = slot.velocity.view();
    inputs.depth = slot.depth.view();
    inputs.reactive = slot.reactive.view();
    inputs.render = frame.render;
    inputs.jitter = frame.jitter;
    inputs.camera = frame.camera;
    inputs.reset = frame.reset;
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

  std::vector<Pixel> resolved() {
    const Extent output = plan_.settings.output;
    std::vector<Pixel> pixels(static_cast<std::size_t>(output.area()));
    EXPECT_TRUE(device_.download(resolved_.view(), output, pixels.data()).ok());
    return pixels;
  }

  std::vector<std::uint8_t> presented() {
    const Extent output = plan_.settings.output;
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

  void fill_slot(Slot& slot, const HostFrame& frame) {
    fill<Pixel>(slot.colour, frame.render, frame.colour);
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
  Image resolved_;
  Image presented_;
  std::uint64_t count_ = 0;
};

}  // namespace quincunx::testing
